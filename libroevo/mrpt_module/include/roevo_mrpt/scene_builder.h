#pragma once
#include <string>
#include <vector>

#include "roevo/camera/pinhole_camera.h"
#include "roevo/edge_map.h"
#include "roevo/odometry.h"
#include "roevo/types.h"
#include "roevo_mrpt/mrpt_compat.h"
#include "roevo_mrpt/pose_conversions.h"

namespace roevo {

/// What a scene shows; all in the same world.
struct SceneContent {
    EdgeMap map;
    std::vector<StampedPose> trajectory;
    std::vector<KeyframeInfo> keyframes;
    PinholeCamera camera;                ///< shape of the keyframe frusta
    std::vector<StampedPose> reference;  ///< ground truth, already aligned with the trajectory; may be empty
    Pose T_scene_world =
        sensorFromOptical();  ///< the scene's z points up; the default suits a first camera that is level
    float point_size = 2;     ///< pixels
};

/// Names of the objects in a scene, for programs that look for them.
struct SceneNames {
    static constexpr const char* kEdges = "edges";
    static constexpr const char* kTrajectory = "trajectory";
    static constexpr const char* kReference = "reference";
    static constexpr const char* kKeyframes = "keyframes";
    static constexpr const char* kKeyframeLines = "keyframe_lines";
    static constexpr const char* kGround = "ground";
};

/// Coloured edge points (CPointCloudColoured), trajectory and reference as tubes, keyframe frusta as lines
/// and as thin tubes (offscreen rendering ignores line widths), a ground grid, and a camera that sees it all.
compat::Scene::Ptr buildScene(const SceneContent& content);

/// Writes a .3Dscene, which appears when whole. @throws std::runtime_error
void saveScene(const std::string& file, const compat::Scene& scene);

/// Writes the edge points, in the map's own frame, as binary PLY (x y z float, red green blue uchar); appears
/// when whole.
/// @throws std::runtime_error
void savePly(const std::string& file, const EdgeMap& map);

}  // namespace roevo
