#pragma once
#include <string>
#include <vector>

#include "roevo/camera/pinhole_camera.h"

namespace roevo {

/// Gives the camera a lens by the name of its model, as ROS, OpenCV, RealSense and MRPT call it, and its
/// terms: four, five or eight (k1 k2 p1 p2 k3 k4 k5 k6), of a fish-eye four (k1 k2 k3 k4); zeros may follow.
/// No terms, or only zeros of anything but a fish-eye, are an ideal lens whatever the name.
/// @throws std::runtime_error for another model or other terms
void setLens(const std::string& model, const std::vector<double>& terms, PinholeCamera& camera);

/// In words, with the number of terms: "no lens distortion", "lens of 5 terms", "fish-eye lens" ….
std::string lensText(const PinholeCamera& camera);

}  // namespace roevo
