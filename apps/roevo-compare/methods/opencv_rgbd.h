#pragma once
#include <memory>
#include <string>
#include <vector>

#include "method.h"

namespace roevo {

/// OpenCV contrib's dense odometries, each frame to the one before: opencv-rgbd (photometric) and
/// opencv-rgbd-icp (photometric and point to plane).
std::vector<MethodInfo> opencvRgbdMethods();

/// @throws std::invalid_argument for a name that is not among opencvRgbdMethods(), one that this build lacks,
///         or an unusable camera
std::unique_ptr<Method> makeOpencvRgbd(const std::string& name, const PinholeCamera& camera,
                                       const OdometryOptions& options);

}  // namespace roevo
