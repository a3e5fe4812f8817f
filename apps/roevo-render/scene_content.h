#pragma once
#include <mrpt/opengl/COpenGLScene.h>

#include <string>

#include "view.h"

namespace roevo {

/// Loads a .3Dscene file. @throws std::runtime_error
mrpt::opengl::COpenGLScene::Ptr loadScene(const std::string& path);

/// Points of the scene's point clouds, and the corners of its other objects (ground grids and axes do not
/// count).
ViewContent sceneContent(const mrpt::opengl::COpenGLScene& scene);

/// Makes the points of the scene's clouds `factor` times larger and of one size at any distance, and colours
/// that are too dark to be seen on a dark background brighter.
void preparePoints(mrpt::opengl::COpenGLScene& scene, float factor);

}  // namespace roevo
