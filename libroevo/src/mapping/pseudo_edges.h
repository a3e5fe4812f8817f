#pragma once
#include <cstdint>
#include <vector>

#include "edges/edge_grid.h"
#include "mapping/edge_fusion.h"
#include "roevo/camera/pinhole_camera.h"
#include "roevo/options.h"

namespace roevo {

/// Recognises pseudo-edges: cast shadows that move, reflections, occlusion borders.
class PseudoEdgeJudge {
  public:
    PseudoEdgeJudge(const MappingOptions& mapping, const SensorOptions& sensor, const PinholeCamera& camera)
        : options_(mapping), sensor_(sensor), camera_(camera) {}

    /// Gives every edge its verdict: by the spread of its observations (instead of Eq. (16)'s largest
    /// eigenvalue, which the depth noise of the sensor dominates, across the edge in the images), and by
    /// keyframes and frames that look at its place and do not see it.
    /// @param scale  robust spread of point-to-tangent residuals, px
    void judge(const std::vector<WindowKeyframe>& window, FusedEdges& edges, double scale);

  private:
    double spreadOf(const std::vector<WindowKeyframe>& window, const FusedEdges& edges, std::size_t p) const;
    /// Keyframes that look at the place of an edge, but for the first that observes it.
    struct Looks {
        double looked = 0, seen = 0;  ///< their weights, and those of them that observe it
    };
    struct Suspect {
        std::size_t edge = 0;
        Looks looks;
        double found = 0;
        double open = 0;  ///< weight of those that did not observe it, whose images were not asked
    };
    /// Whether an image that its keyframe looks with has a suspect.
    struct Question {
        std::size_t slot = 0, suspect = 0;
        double weight = 0;  ///< of the look
    };

    /// Where a window keyframe is, and what bounds its image.
    struct View {
        Pose T_camera_world;
        Eigen::Matrix<double, 5, 3> normals;
        Eigen::Matrix<double, 5, 1> offsets;
        /// How far inside a point is, m; outside, negative.
        double inside(const Eigen::Vector3d& point) const { return (normals * point + offsets).minCoeff(); }
    };
    View viewOf(const Pose& T_world_camera) const;
    /// Which of an edge's points each keyframe looks at, and which it observes.
    void findPoints(const FusedEdges& edges, std::size_t edge);
    /// Those that do not observe the edge are `missing_`; here they count in full.
    Looks looksAt(const std::vector<WindowKeyframe>& window, const FusedEdges& edges, std::size_t edge);
    /// Of a keyframe's look at the edge: by the angle to the nearest other view that it was observed from.
    double weightOf(std::size_t slot) const;
    void askImages(const std::vector<WindowKeyframe>& window, const FusedEdges& edges);
    /// Whether a keyframe's image has an edge in the place of a fused one, associated or not.
    bool isInImage(const View& view, const OrganizedEdges& image, const FusedEdges& edges,
                   std::size_t edge) const;
    bool isVanishing(const Looks& looks, double found) const;
    /// Where a point is in a keyframe's image; behind the camera it is nowhere, and `pixel` stays.
    void project(const View& view, const Eigen::Vector3d& point, Eigen::Vector2f& pixel) const;
    /// Share of the frames after a keyframe that found an edge, mean over its keyframes; < 0: not known.
    double foundShare(const std::vector<WindowKeyframe>& window, const FusedEdges& edges,
                      std::size_t edge) const;

    MappingOptions options_;
    SensorOptions sensor_;
    PinholeCamera camera_;
    std::vector<View> views_;  ///< of the window
    std::vector<Suspect> suspects_;
    std::vector<Question> questions_;
    std::vector<std::size_t> missing_;  ///< slots of the keyframes that look at an edge and do not observe it
    std::vector<std::uint32_t> inside_, observed_;  ///< of each slot: points of the edge, a bit of each
    std::vector<Eigen::Vector3d> rays_;             ///< of each slot: from the edge to the camera
    EdgeGrid grid_;                                 ///< of the image that is asked
};

}  // namespace roevo
