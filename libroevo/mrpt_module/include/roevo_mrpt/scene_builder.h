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
    EdgeMap
        keyframe_edges;  ///< each keyframe's own, numbered by cluster, for the co-visibility; may be empty
    std::vector<ColouredPoint> semi_dense;  ///< may be empty
    std::vector<StampedPose> trajectory;
    std::vector<KeyframeInfo> keyframes;
    PinholeCamera camera;                ///< shape of the keyframe frusta
    std::vector<StampedPose> reference;  ///< ground truth, already aligned with the trajectory; may be empty
    Pose T_scene_world =
        sensorFromOptical();  ///< the scene's z points up; the default suits a first camera that is level
    float point_size = 2;     ///< pixels
};

/// Points of an edge that follow one another are drawn as joined when they are nearer than this, m: they are
/// neighbours in an image, but where depth jumps nothing is known between them.
float largestDrawnGap(const std::vector<Eigen::Vector3f>& edge);

/// A colour per kind of pseudo-edge, which has no use for the image's.
Rgb pseudoEdgeColour(EdgeVerdict verdict);

/// Names of the objects in a scene, for programs that look for them.
struct SceneNames {
    static constexpr const char* kEdges = "edges";
    static constexpr const char* kPseudoEdges = "pseudo_edges";
    static constexpr const char* kCovisibility = "covisibility";
    static constexpr const char* kSemiDense = "semi_dense";
    static constexpr const char* kTrajectory = "trajectory";
    static constexpr const char* kReference = "reference";
    static constexpr const char* kKeyframes = "keyframes";
    static constexpr const char* kKeyframeLines = "keyframe_lines";
    static constexpr const char* kGround = "ground";
};

/// Colours of a scene's objects.
struct SceneColours {
    static constexpr Rgb kTrajectory{230, 60, 30}, kReference{40, 170, 60}, kKeyframes{40, 110, 240};
};

/// The map's layers (each a CPointCloudColoured, only there when it has points, except for the edges):
/// - edges: those that are no pseudo-edges, with points put in between so that they look like lines, and
///   fainter where the map trusts them less;
/// - pseudo_edges (hidden): orange where observations are spread, magenta where edges vanish;
/// - covisibility (hidden): the keyframes' edges, one colour for those that show the same edge, light grey
///   where no other keyframe shows it;
/// - semi_dense (hidden): the surface next to the edges.
/// Besides, trajectory and reference as tubes, keyframe frusta as lines and as thin tubes (offscreen
/// rendering ignores line widths), a ground grid, and a camera that sees it all.
compat::Scene::Ptr buildScene(const SceneContent& content);

/// Writes a .3Dscene, which appears when whole. @throws std::runtime_error
void saveScene(const std::string& file, const compat::Scene& scene);

/// Writes all edge points, in the map's own frame, as binary PLY; appears when whole. Of each point: x y z
/// (float), red green blue (uchar), and of its edge: confidence (float, 0..1), views (int, keyframes that see
/// it), verdict (uchar, as in EdgeVerdict), edge (int, its number in the map).
/// @throws std::runtime_error
void savePly(const std::string& file, const EdgeMap& map);

/// Writes coloured points in the same way: x y z (float), red green blue (uchar). @throws std::runtime_error
void savePointsPly(const std::string& file, const std::vector<ColouredPoint>& points);

}  // namespace roevo
