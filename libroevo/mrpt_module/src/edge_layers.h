#pragma once
#include "roevo_mrpt/scene_builder.h"

namespace roevo {

/// Inserts the layers of the map into a scene, see buildScene().
void insertEdgeLayers(compat::Scene& scene, const SceneContent& content);

}  // namespace roevo
