#pragma once
#include <opencv2/core/mat.hpp>

namespace roevo {

/// One RGB-D image pair, depth registered to the colour camera, both as the lens saw them (not yet
/// undistorted).
struct RgbdFrame {
    double timestamp = 0;  ///< seconds, of the colour image
    cv::Mat grey{};        ///< CV_8UC1, height x width: what is tracked; cv::cvtColor() makes it of colour
    cv::Mat depth{};       ///< CV_32FC1, height x width, metres along the optical axis; 0 where unknown
    cv::Mat colour{};      ///< optional CV_8UC3 (BGR), only used to colour the map; may be empty
    /// Optional CV_8UC1, height x width: 0 where something is seen that does not stand still in the scene,
    /// such as a robot's own arm or a person; it is left out, with a margin of 1 % of the width. Empty: all
    /// is scene.
    cv::Mat mask{};
};

}  // namespace roevo
