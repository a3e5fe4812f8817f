#pragma once
#include <Eigen/Core>
#include <optional>
#include <string>

#include "background.h"

namespace roevo {

/// What a picture or a movie shows, and how.
struct PictureSettings {
    std::string output;      ///< .png or .mp4
    std::string scene;       ///< .3Dscene
    std::string trajectory;  ///< whose last camera the view `follow` follows
    int width = 0, height = 0;
    std::string view, layer;
    Background background{"dark"};
    bool layer_wanted = false;  ///< whether the scene must have it
    bool legend = true;
    std::optional<Eigen::Vector3d> from, look_at;  ///< instead of the view's; from only together with look_at
    double zoom = 1, seconds = 12;                 ///< of a whole turn
};

/// Draws it, and says on stdout what was drawn. @throws std::runtime_error
void drawPicture(const PictureSettings& settings);

}  // namespace roevo
