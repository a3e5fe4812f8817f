#pragma once
/// What is named differently in MRPT 2 and 3, in one place.

#include <mrpt/opengl/COpenGLScene.h>

namespace roevo::compat {

using Scene = mrpt::opengl::COpenGLScene;  // mrpt::viz::Scene in MRPT 3

}  // namespace roevo::compat
