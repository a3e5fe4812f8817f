#pragma once
#include <vector>

#include "roevo/edges/canny.h"
#include "roevo/tracking/coarse_tracker.h"
#include "roevo/tracking/edge_association.h"
#include "roevo/tracking/keyframe.h"

namespace roevo {

/// Neighbouring points of an edge err together: their information counts about one independent point in so
/// many.
inline constexpr double kCorrelatedPoints = 5;

/// What fine tracking needs of the current frame.
struct FineFrame {
    double timestamp = 0;  ///< s
    const OrganizedEdges* edges = nullptr;
    const EdgeGrid* grid = nullptr;
    const EdgeMask* mask = nullptr;  ///< pixels that `edges` were made of; may be absent
    const ImagePyramid* pyramid = nullptr;
    const cv::Mat* depth = nullptr;             ///< raw depth of `raw_camera`; may be empty
    const PinholeCamera* raw_camera = nullptr;  ///< with distortion
    const PinholeCamera* camera = nullptr;      ///< ideal
};

struct FineResult {
    bool converged = false;
    Pose T_current_keyframe = Pose::Identity();
    int inliers = 0;           ///< associated points that passed the chi-square test
    double scale = 0;          ///< robust spread of the point-to-tangent residual, px, of edges at rest
    double matched_ratio = 0;  ///< see EdgeMatches
    Matrix6d covariance = Matrix6d::Zero();  ///< of the left perturbation (t, phi) of T_current_keyframe
};

/// Edge-wise registration, Eqs. (4)-(13): associations renewed as the pose moves, point-to-tangent residuals
/// joined by photometric ones and by the depth of associated points, robust scales re-estimated in every
/// step.
class FineTracker {
  public:
    FineTracker(const FineOptions& fine, const EdgeOptions& edges, const SensorOptions& sensor)
        : options_(fine), edge_options_(edges), sensor_(sensor), associator_(fine) {}

    FineResult track(const Keyframe& keyframe, const FineFrame& frame, const Pose& T_start,
                     const PosePrior& prior, const RollingShutter& shutter, const Brightness& brightness);

    /// What track() reports, at a given pose and without refining it: inliers, scale and matched ratio;
    /// converged where these are enough. No covariance. Fills matches().
    FineResult assess(const Keyframe& keyframe, const FineFrame& frame, const Pose& T_current_keyframe,
                      const RowMotion& rows);

    /// Edge-wise association at a given pose, without refining it: fills matches().
    void associate(const Keyframe& keyframe, const FineFrame& frame, const Pose& T_current_keyframe,
                   const RowMotion& rows, double radius);

    /// Adds the last frame's inliers to what is known of the read-out time, where they add enough. The frame
    /// is then registered some more, with the read-out time free: what points are associated with follows
    /// the read-out time that is assumed, and tells only a part of what it lacks. Changes matches().
    void addReadoutEvidence(const Keyframe& keyframe, const Pose& T_current_keyframe,
                            const RollingShutter& shutter, const FineFrame& frame,
                            ReadoutEstimator& estimator);

    /// Counts which of the keyframe's points the last frame found.
    void countHits(Keyframe& keyframe, const PinholeCamera& camera) const;

    const EdgeMatches& matches() const { return matches_; }  ///< of the last frame

    /// The coarse pose or the one that is likely beforehand: where they are apart, whichever finds more
    /// edges. Moving shadows and blur lead photometry astray before they do edges.
    Pose betterStart(const Keyframe& keyframe, const FineFrame& frame, const Pose& T_coarse,
                     const Pose& T_likely, const RollingShutter& shutter);

  private:
    /// Normal equations of one frame's residuals in its pose and the read-out time.
    struct ReadoutEquations {
        Matrix6d hessian = Matrix6d::Identity() * 1e-6;
        Vector6d mixed = Vector6d::Zero(), gradient = Vector6d::Zero();
        double own = 0, own_gradient = 0;
    };
    /// Of residuals and points where they are now, with keyframe and frame at the read-out time of `rows`.
    ReadoutEquations readoutEquations(const Keyframe& keyframe, const Pose& T_current_keyframe,
                                      const RowMotion& rows, const FineFrame& frame) const;
    void project(const std::vector<float>& x, const std::vector<float>& y, const std::vector<float>& z,
                 const Pose& pose, const PinholeCamera& camera, const RowMotion& rows);
    void associateProjected(const Keyframe& keyframe, const FineFrame& frame, const Pose& T_current_keyframe,
                            double radius);
    void geometricResiduals(const Keyframe& keyframe, const FineFrame& frame, const RowMotion& rows);
    void depthResiduals(const Keyframe& keyframe, const FineFrame& frame);
    void weigh(const Keyframe& keyframe);
    float currentDepth(std::size_t point, const FineFrame& frame);
    void accumulate(const PinholeCamera& camera, const OrganizedEdges& current, PoseSystem& system);

    FineOptions options_;
    EdgeOptions edge_options_;
    SensorOptions sensor_;
    EdgeAssociator associator_;
    PhotometricResiduals photometric_;
    EdgeMatches matches_;
    std::vector<float> x_, y_, z_, u_, v_;            // of all keyframe points
    std::vector<float> moved_x_, moved_y_, moved_z_;  // keyframe points at another read-out time
    // of the matches; sharpness: information across an edge as a share of what it would be at rest
    std::vector<float> residual_, sharpness_, weight_, depth_residual_, depth_weight_;
    std::vector<float> current_depth_, scratch_;
    InformationRows rows_;
    double scale_ = 1;
    int inliers_ = 0;
};

}  // namespace roevo
