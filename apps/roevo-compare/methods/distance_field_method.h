#pragma once
#include <memory>
#include <string>
#include <vector>

#include "method.h"

namespace roevo {

/// Registration by the distance field of the edge mask in ROEVO's own front end: alone, and joined with the
/// photometric residual.
std::vector<MethodInfo> distanceFieldMethods();

/// @param options  of ROEVO; its mode does not matter
/// @throws std::invalid_argument for a name that is not among distanceFieldMethods(), or an unusable camera
std::unique_ptr<Method> makeDistanceField(const std::string& name, const PinholeCamera& camera,
                                          const OdometryOptions& options);

}  // namespace roevo
