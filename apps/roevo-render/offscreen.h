#pragma once
#include <mrpt/opengl/COpenGLScene.h>

#include <opencv2/core/mat.hpp>

#include "view.h"

namespace roevo {

constexpr int kSuperSampling = 2;  ///< the scene is drawn this many times larger and shrunk

/// Draws a scene with no display. Call once per process: MRPT wants one renderer for a thread's whole life,
/// and a scene that one renderer has drawn cannot be drawn by another.
/// @return CV_8UC3 (BGR). @throws std::runtime_error when the machine has no OpenGL for offscreen drawing
cv::Mat renderOffscreen(mrpt::opengl::COpenGLScene& scene, const View& view, Background background, int width,
                        int height);

}  // namespace roevo
