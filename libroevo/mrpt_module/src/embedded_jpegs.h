#pragma once
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace mrpt::img {
class CImage;
}

namespace roevo {

/// Finds the JPEG images among what MRPT reads of a rawlog, and puts a single pixel in place of a damaged
/// one: MRPT would give it to libjpeg, whose default is to end the program.
class EmbeddedJpegs {
  public:
    /// @param data    what one read of MRPT's gave, changed where it is a damaged image
    /// @param wanted  bytes that it asked for; it takes less for enough
    /// @throws std::runtime_error where the image is damaged and has less bytes than a single pixel needs
    void examine(std::uint8_t* data, std::size_t count, std::size_t wanted);

    /// What is wrong with the damaged images since the last call (of the first one), or "".
    std::string takeDamage();

    /// Whether this image is what stands in place of a damaged one.
    static bool isReplacement(const mrpt::img::CImage& image);

  private:
    bool isImage(std::size_t count) const;

    struct Number {
        std::size_t bytes;
        std::uint32_t value;
    };
    std::vector<Number> header_;  ///< reads since the name of the class CImage
    bool in_header_ = false;
    std::string damage_;
};

}  // namespace roevo
