#pragma once
#include <vector>

#include "roevo/camera/pinhole_camera.h"
#include "roevo/mapping/edge_fusion.h"
#include "roevo/options.h"

namespace roevo {

/// What is known of a keyframe's pose relative to another's besides the edges: it decides in directions that
/// the edges hardly see.
struct RelativePrior {
    int from = 0, to = 0;  ///< window slots
    Pose T_from_to = Pose::Identity();
    Matrix6d information = Matrix6d::Zero();  ///< of the perturbation (t, phi) of T_world_to, world axes
};

struct RefinementResult {
    int iterations = 0;
    double last_step = 0;      ///< largest change of a pose in the last iteration, px of image motion
    double scale = 0;          ///< robust spread of the point-to-tangent residuals, px
    std::vector<int> inliers;  ///< of each window keyframe
};

/// Bundle adjustment over a window (Eqs. (17)-(19)). Both ways alternate edge fitting and pose optimisation:
/// - alternating: each pose is registered to the fused edges as they are (the paper's Eq. (19));
/// - joint: the poses move together, with the fused points eliminated (Schur complement), which converges in
///   fewer rounds.
class BundleAdjuster {
  public:
    BundleAdjuster(const MappingOptions& mapping, const SensorOptions& sensor, const PinholeCamera& camera)
        : options_(mapping), sensor_(sensor), camera_(camera) {}

    /// Moves the poses of the window (those not fixed) and the points of `edges`, for at most `iterations`.
    /// @param first_scale  least spread (px) that the first iteration allows; halved in each that follows
    RefinementResult refine(std::vector<WindowKeyframe>& window, FusedEdges& edges,
                            const std::vector<RelativePrior>& priors, int iterations, double first_scale = 0);

    /// Recognises pseudo-edges and marks them: by the spread of their observations (instead of Eq. (16)'s
    /// largest eigenvalue, which the depth noise of the sensor dominates, across the edge in the images), and
    /// by keyframes that look at their place and do not see them.
    void judge(const std::vector<WindowKeyframe>& window, FusedEdges& edges) const;

  private:
    struct Term;
    Term linearise(const WindowKeyframe& view, std::size_t point, const Eigen::Vector3d& world) const;
    double tangentResidual(const MapKeyframe& keyframe, std::size_t i,
                           const Eigen::Vector3d& in_camera) const;
    double spreadOf(const std::vector<WindowKeyframe>& window, const FusedEdges& edges, std::size_t p) const;
    /// Keyframes that look at the place of an edge, and those of them that see it.
    std::pair<int, int> countLooks(const std::vector<WindowKeyframe>& window, const FusedEdges& edges,
                                   std::size_t edge) const;
    double foundShare(const std::vector<WindowKeyframe>& window, const FusedEdges& edges,
                      std::size_t edge) const;
    double estimateScale(const std::vector<WindowKeyframe>& window, const FusedEdges& edges);

    MappingOptions options_;
    SensorOptions sensor_;
    PinholeCamera camera_;
    double scale_ = 0.3;  ///< px
    std::vector<float> scratch_;
};

}  // namespace roevo
