#pragma once
#include <string>

#include "recordings/bags/bag_file.h"
#include "roevo/camera/pinhole_camera.h"

namespace roevo {

/// The camera of a CameraInfo message.
/// @param rectified  the images are undistorted: P counts, and there is no distortion; else K and D
/// @param of_depth  RealSense's "Inverse Brown Conrady" means what it says, as with SR300's depth; the same
/// name stands beside the terms of colour cameras, which its software and realsense-ros use as those of
/// plumb_bob
/// @throws std::runtime_error in one line: not calibrated, or a lens model that setLens() does not know.
PinholeCamera cameraOf(const CameraInfoMessage& message, bool rectified, bool of_depth);

struct BagCamera {
    PinholeCamera camera;
    std::string source;   ///< in words: topic, and what was taken from it
    std::string warning;  ///< when later messages say otherwise; else empty
};

/// The camera that took `images`, by the first message of `info_topic`. @param of_depth  see cameraOf()
/// @throws std::runtime_error naming the topic.
BagCamera readCamera(const BagFile& bag, const std::string& info_topic, const BagTopic& images,
                     bool of_depth);

}  // namespace roevo
