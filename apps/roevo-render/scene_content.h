#pragma once

#include <string>
#include <vector>

#include "background.h"
#include "roevo_mrpt/mrpt_compat.h"
#include "view.h"

namespace roevo {

inline constexpr char kAllLayers[] = "all";

/// Loads a .3Dscene file. @throws std::runtime_error
compat::Scene::Ptr loadScene(const std::string& path);

/// Layers of a map that can be shown, as users name them.
std::vector<std::string> layerNames();

/// Shows one layer of the map (kAllLayers: every one) and hides the others; what is no layer stays as it is.
/// @throws std::runtime_error when the scene does not hold it
void showLayer(compat::Scene& scene, const std::string& layer);

/// Points of the scene's point clouds, and the corners of its other objects (ground grids and axes do not
/// count).
ViewContent sceneContent(const compat::Scene& scene);

/// Makes the points of the scene's clouds `factor` times larger and of one size at any distance, and colours
/// that could not be told from the background brighter or darker. Where all layers are shown, those that are
/// not the map's edges are faint.
/// @return the objects that the edges are to be drawn over
std::vector<compat::SceneObject::Ptr> preparePoints(compat::Scene& scene, float factor,
                                                    const Background& background, bool all_layers);

/// Makes ground grids such as can be seen on the background, faintly.
void prepareGrid(compat::Scene& scene, const Background& background);

/// Cuts the map's ground grid down to those whole cells that lie within the box.
void cropGrid(compat::Scene& scene, const Eigen::AlignedBox3f& box);

/// Colour in which a point of a layer is shown.
/// @param layer  name of the object. @param all_layers  whether the others are shown, too
Colour shownColour(const Colour& colour, const std::string& layer, const Background& background,
                   bool all_layers);

}  // namespace roevo
