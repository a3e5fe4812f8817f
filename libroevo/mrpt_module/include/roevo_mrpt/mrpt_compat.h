#pragma once
/// What differs between MRPT's versions, in one place: 2.5 (Debian 12), 2.14 (Debian 13) and 3.

#include <mrpt/img/TColor.h>
#include <mrpt/opengl/COpenGLScene.h>

namespace roevo::compat {

using Scene = mrpt::opengl::COpenGLScene;  // mrpt::viz::Scene in MRPT 3

/// Sets one of a viewport's lights, which is a colour up to MRPT 2.5 and a brightness in 2.14.
inline void setWhiteLight(mrpt::img::TColorf& light, float brightness) {
    light = {brightness, brightness, brightness};
}
inline void setWhiteLight(float& light, float brightness) {
    light = brightness;
}

}  // namespace roevo::compat
