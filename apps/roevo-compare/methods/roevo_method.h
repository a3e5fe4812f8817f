#pragma once
#include <memory>
#include <string>
#include <vector>

#include "method.h"

namespace roevo {

/// Our own odometry in its three modes: roevo-ct, roevo-tr and roevo-ba.
std::vector<MethodInfo> roevoMethods();

/// @param options  its mode is replaced by the method's
/// @throws std::invalid_argument for a name that is not among roevoMethods(), or an unusable camera
std::unique_ptr<Method> makeRoevo(const std::string& name, const PinholeCamera& camera,
                                  const OdometryOptions& options);

}  // namespace roevo
