#pragma once
#include <memory>
#include <vector>

#include "method.h"

namespace roevo {

/// Our own odometry in its three modes: roevo-ct, roevo-tr and roevo-ba.
std::vector<MethodInfo> roevoMethods();
/// Registration by the distance field of the edge mask in ROEVO's own front end: alone, and joined with the
/// photometric residual.
std::vector<MethodInfo> distanceFieldMethods();
/// DIFODO, MRPT's range-flow odometry (Jaimez and Gonzalez-Jimenez, T-RO 2015), at two resolutions:
/// difodo-240 and difodo-480.
std::vector<MethodInfo> difodoMethods();
/// MRPT's point-to-point ICP (mrpt::slam::CICP) on clouds from the depth image: icp-frame registers to the
/// frame before, icp-keyframe to a keyframe.
std::vector<MethodInfo> icpMethods();
/// OpenCV contrib's dense odometries, each frame to the one before: opencv-rgbd (photometric) and
/// opencv-rgbd-icp (photometric and point to plane).
std::vector<MethodInfo> opencvRgbdMethods();

/// Makes a `Kind` of camera, options and these.
template <class Kind, class... More>
auto makerOf(More... more) {
    return [=](const PinholeCamera& camera, const OdometryOptions& options) -> std::unique_ptr<Method> {
        return std::make_unique<Kind>(camera, options, more...);
    };
}

}  // namespace roevo
