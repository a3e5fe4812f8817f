#pragma once
#include <string>

#include "recordings/bags/bag_file.h"
#include "roevo/camera/pinhole_camera.h"

namespace roevo {

/// The camera of a CameraInfo message.
/// @param rectified  the images are undistorted: P counts, and there is no distortion; else K and D
/// @throws std::runtime_error in one line: not calibrated, or a lens model that setLens() does not know and
/// that is not the inverse of plumb_bob.
PinholeCamera cameraOf(const CameraInfoMessage& message, bool rectified);

struct BagCamera {
    PinholeCamera camera;
    std::string source;   ///< in words: topic, and what was taken from it
    std::string warning;  ///< when later messages say otherwise; else empty
};

/// The camera that took `images`, by the first message of `info_topic`.
/// @throws std::runtime_error naming the topic.
BagCamera readCamera(const BagFile& bag, const std::string& info_topic, const BagTopic& images);

}  // namespace roevo
