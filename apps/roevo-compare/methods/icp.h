#pragma once
#include <memory>
#include <string>
#include <vector>

#include "method.h"

namespace roevo {

/// MRPT's point-to-point ICP (mrpt::slam::CICP) on clouds from the depth image: icp-frame registers to the
/// frame before, icp-keyframe to a keyframe.
std::vector<MethodInfo> icpMethods();

/// @throws std::invalid_argument for a name that is not among icpMethods(), or an unusable camera
std::unique_ptr<Method> makeIcp(const std::string& name, const PinholeCamera& camera,
                                const OdometryOptions& options);

}  // namespace roevo
