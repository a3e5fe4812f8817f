#pragma once
#include <cstdint>
#include <vector>

#include "mapping/edge_fusion.h"
#include "roevo/camera/pinhole_camera.h"
#include "roevo/options.h"

namespace roevo {

/// Points that make the Hessian of a window; there are more than it needs. All make the gradient, so that
/// nothing but the step to the optimum is approximate.
inline constexpr std::size_t kHessianPoints = 1500;

/// The least-squares problem of a window: what its keyframes observe of the fused points, as residuals and as
/// normal equations of the poses with the points eliminated.
///
/// A keyframe sees the line of an edge, not a point on it: a fused point that lies further along the edge
/// than the observation is compared with the tangent there, in the image (Eq. (7)) and in depth. Neither
/// residual changes when the point moves along the edge, so its step is damped in that direction.
class WindowEquations {
  public:
    WindowEquations(const MappingOptions& mapping, const SensorOptions& sensor, const PinholeCamera& camera,
                    std::size_t hessian_points = kHessianPoints)
        : options_(mapping), sensor_(sensor), camera_(camera), hessian_points_(hessian_points) {}

    /// Takes the observations of all points of true edges that have at least two.
    void gather(const std::vector<WindowKeyframe>& window, const FusedEdges& edges);

    /// Residuals at these poses and points, and their robust spread in each keyframe.
    /// @param least_scale  px; no spread is taken for smaller
    void evaluate(const std::vector<WindowKeyframe>& window, const std::vector<Eigen::Vector3d>& points,
                  double least_scale);

    /// Moves the points to where they fit best (edge fitting, the inner problem of Eq. (18)) and builds the
    /// normal equations of the poses that are not fixed. Perturbations are (t, phi) of the camera in the
    /// world's axes, turned about origin(): x <- exp(phi) (x - origin) + origin + t.
    void build(const std::vector<WindowKeyframe>& window, std::vector<Eigen::Vector3d>& points);

    /// A place of the window: far from the world's origin, turns about that would drown translations.
    const Eigen::Vector3d& origin() const { return origin_; }
    /// First row of a keyframe in the normal equations, -1: fixed.
    template <class Index>
    int row(Index slot) const {
        return at(rows_, slot);
    }
    int numRows() const { return num_rows_; }
    /// The newest of the fixed keyframes before the first that is not; -1: none is fixed. Where it is not the
    /// only one, what follows is known.
    int anchor() const { return anchor_; }
    /// What the residuals relate the anchor's pose to a keyframe's by: that block of the Hessian.
    const Matrix6d& anchorBlock(int slot) const { return blocks_[blockOf(anchor_, slot)]; }

    /// Adds to the Hessian, where neither keyframe is fixed. @param slot  not after `other_slot`
    void add(int slot, int other_slot, const Matrix6d& block);
    /// Adds to all of its diagonal.
    void addDamping(double damping);
    /// Dense. Upper triangle, the rest is not set.
    Eigen::MatrixXd hessian() const;
    /// -H^-1 g, of numRows(); not finite where there is none.
    Eigen::VectorXd step() const;

    /// The part of the gradient that one edge makes of one keyframe.
    struct EdgePull {
        std::int32_t edge, slot;
        Vector6d gradient;
    };
    const std::vector<EdgePull>& pulls() const { return pulls_; }

    Eigen::VectorXd gradient;
    std::vector<int> inliers;  ///< of each keyframe, as build() found them
    double scale = 0;          ///< robust spread of the point-to-tangent residuals of all keyframes, px

  private:
    /// An observation: residual = (a X + b Y) / Z - c across the edge, and the same along it.
    struct LineObservation {
        double across_a, across_b, across_c, along_a, along_b, along_c;
        double depth, slope;               ///< m; m per px along the edge
        double weight, depth_information;  ///< 1/m^2
        std::int32_t slot;
    };
    struct Residual {
        double x, y, inverse_z;  ///< of the fused point, camera frame
        double across, depth;    ///< px, m
    };
    /// What a keyframe's observations of one point add up to, in the world's axes. The pose's part follows,
    /// because moving the camera is moving the point the other way: with G = [I; [P]x], P the point,
    /// H_pose = G A G^T, H_pose,point = -G A, g_pose = -G b.
    struct InformationBlock {
        Eigen::Matrix3d information;  ///< A
        Eigen::Vector3d gradient;     ///< b
        bool used = false;
    };
    using Coupling = Eigen::Matrix<double, 6, 3>;  ///< of a pose and a point

    double spread(std::int32_t slot, double least_scale);
    bool addObservation(const LineObservation& seen, const Residual& residual, const Eigen::Matrix3d& R);
    void addPoint(Eigen::Vector3d& point, double hessian_weight);
    void addToHessian(const Eigen::Vector3d& point, const Eigen::Matrix3d& inverse, double weight);
    void addPulls(std::int32_t edge);
    template <class Take>
    void eachBlock(const Take& take) const;
    bool isInHessian(std::int32_t slot) const {
        return at(rows_, slot) >= 0 || (slot == anchor_ && slot > 0);
    }
    /// Blocks are of the anchor, which comes first, and of the keyframes that are not fixed.
    template <class Index>
    int blockRow(Index slot) const {
        return at(rows_, slot) < 0 ? 0 : 1 + at(rows_, slot) / 6;
    }
    int numBlockRows() const { return 1 + num_rows_ / 6; }
    template <class Index>
    std::size_t blockOf(Index slot, Index column_slot) const {
        return static_cast<std::size_t>(blockRow(slot) * numBlockRows() + blockRow(column_slot));
    }

    MappingOptions options_;
    SensorOptions sensor_;
    PinholeCamera camera_;
    std::size_t hessian_points_;                ///< about so many
    std::vector<std::int32_t> points_, begin_;  ///< points that take part; first observation of each
    std::vector<std::int32_t> edge_of_;         ///< of each of these points
    std::vector<LineObservation> observations_;
    Eigen::Vector3d origin_ = Eigen::Vector3d::Zero();
    std::vector<Residual> residuals_;
    std::vector<double> scales_;  ///< of each keyframe, px
    std::vector<float> scratch_;
    std::vector<int> rows_;
    int num_rows_ = 0, anchor_ = -1;
    std::vector<EdgePull> pulls_;
    std::vector<Matrix6d> blocks_;  ///< of the Hessian: upper triangle, keyframe by keyframe
    std::vector<Vector6d> gradients_, edge_gradients_;
    // Of the point that is being added
    std::vector<InformationBlock> point_blocks_;  ///< of each keyframe
    std::vector<std::int32_t> touched_;           ///< slots of keyframes that observe it
    std::vector<Coupling> couplings_, throughs_;
    std::vector<std::int32_t>
        hessian_rows_;  ///< block rows of those whose poses are looked for, and the anchor
    Eigen::Vector3d direction_ = Eigen::Vector3d::Zero();  ///< of the edge, not normalised
};

}  // namespace roevo
