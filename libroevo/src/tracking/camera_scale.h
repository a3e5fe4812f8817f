#pragma once
#include "roevo/camera/pinhole_camera.h"
#include "roevo/options.h"

namespace roevo {

/// What is given in pixels of a 640x480 camera with f = 525 px, in those of another. Search radii follow the
/// focal length, which is what turns motion into pixels; lengths along edges, patches, the filter's width and
/// the levels of the image pyramid follow the image's width, which is how finely the scene is sampled.
OdometryOptions scaledTo(const PinholeCamera& camera, OdometryOptions options);

}  // namespace roevo
