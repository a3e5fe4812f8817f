#pragma once
#include <mrpt/opengl/COpenGLScene.h>

#include <string>
#include <vector>

#include "view.h"

namespace roevo {

/// Loads a .3Dscene file. @throws std::runtime_error
mrpt::opengl::COpenGLScene::Ptr loadScene(const std::string& path);

/// Layers of a map that can be shown, as users name them.
std::vector<std::string> layerNames();

/// Shows one layer of the map ("all": every one) and hides the others; what is no layer stays as it is.
/// @throws std::runtime_error when the scene does not hold it
void showLayer(mrpt::opengl::COpenGLScene& scene, const std::string& layer);

/// Points of the scene's point clouds, and the corners of its other objects (ground grids and axes do not
/// count).
ViewContent sceneContent(const mrpt::opengl::COpenGLScene& scene);

/// Makes the points of the scene's clouds `factor` times larger and of one size at any distance, and colours
/// that could not be told from the background brighter or darker.
void preparePoints(mrpt::opengl::COpenGLScene& scene, float factor, Background background);

}  // namespace roevo
