#pragma once
#include <array>
#include <cstdint>
#include <string>

namespace roevo {

using Colour = std::array<float, 3>;  ///< red, green, blue, 0 to 1

/// What a picture is drawn on, and which colours stand out from it.
class Background {
  public:
    /// @param text  dark, white, black or #rrggbb. @throws std::invalid_argument
    explicit Background(const std::string& text);

    const Colour& colour() const { return colour_; }
    /// Of text, and of the ground grid where it is faint.
    Colour ink() const;
    /// `colour`, brighter or darker where it could not be told from the background, with its hue.
    /// @param distance  least difference of brightness from the background
    Colour standingOut(const Colour& colour, float distance) const;
    /// `share` of the way from `colour` to the background.
    Colour faded(const Colour& colour, float share) const;

  private:
    Colour colour_;
    float brightness_;
};

}  // namespace roevo
