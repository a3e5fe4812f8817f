#pragma once
#include <memory>
#include <string>
#include <vector>

#include "method.h"

namespace roevo {

/// DIFODO, MRPT's range-flow odometry (Jaimez and Gonzalez-Jimenez, T-RO 2015), at two resolutions:
/// difodo-240 and difodo-480.
std::vector<MethodInfo> difodoMethods();

/// @throws std::invalid_argument for a name that is not among difodoMethods(), or an unusable camera
std::unique_ptr<Method> makeDifodo(const std::string& name, const PinholeCamera& camera,
                                   const OdometryOptions& options);

}  // namespace roevo
