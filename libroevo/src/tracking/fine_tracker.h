#pragma once
#include <vector>

#include "tracking/coarse_tracker.h"
#include "tracking/edge_term.h"
#include "tracking/readout_estimator.h"

namespace roevo {

struct FineResult {
    bool converged = false;
    Pose T_current_keyframe = Pose::Identity();
    int iterations = 0;          ///< steps that were taken
    int inliers = 0;             ///< associated points that passed the chi-square test
    double matched_ratio = 0;    ///< see EdgeMatches
    double depth_agreement = 1;  ///< see EdgeTerm::depthAgreement()
    /// Of the left perturbation (t, phi) of T_current_keyframe; common is what rows add that may take longer
    /// to read than is known
    PoseUncertainty uncertainty;
    Matrix6d of_velocity = Matrix6d::Zero();  ///< covariance that a guessed velocity of the rows adds to it
};

/// Edge-wise registration: EdgeTerm joined by the photometric term and by what is likely beforehand.
class FineTracker {
  public:
    /// @param camera  with its lens
    FineTracker(const PinholeCamera& camera, const OdometryOptions& options)
        : options_(options.fine), ideal_(camera.undistorted()), edges_(camera, options) {}

    /// Minimises: the pose and its covariance. assess() tells the rest.
    [[nodiscard]] FineResult track(const Keyframe& keyframe, const Frame& frame, const Pose& T_start,
                                   const PosePrior& prior, const RollingShutter& shutter,
                                   const Brightness& brightness);

    /// Inliers, matched ratio and agreement of depths at a given pose; converged where these are
    /// enough. No covariance. Fills matches().
    [[nodiscard]] FineResult assess(const Keyframe& keyframe, const Frame& frame,
                                    const Pose& T_current_keyframe, const RowMotion& rows);

    /// The depth images of frames count from now on, or not.
    void useDepth(bool use) { edges_.useDepth(use); }

    /// Edge-wise association at a given pose, without refining it: fills matches().
    void associate(const Keyframe& keyframe, const Frame& frame, const Pose& T_current_keyframe,
                   const RowMotion& rows, double radius);

    /// Adds what a frame tells of the read-out time, where that is enough. The frame is registered some more
    /// for it, with the read-out time free: what points are associated with follows the read-out time that is
    /// assumed, and tells only a part of what it lacks.
    /// @param matches  at that pose
    void addReadoutEvidence(const Keyframe& keyframe, const Pose& T_current_keyframe,
                            const EdgeMatches& matches, const RollingShutter& shutter, const Frame& frame,
                            ReadoutEstimator& estimator);

    const EdgeMatches& matches() const { return edges_.matches(); }         ///< of the last call
    const std::vector<float>& weights() const { return edges_.weights(); }  ///< of these matches, 0: outliers

    /// The coarse pose or the one that is likely beforehand: where they are apart, whichever finds more
    /// edges. Moving shadows and blur lead photometry astray before they do edges.
    Pose chooseInitialPose(const Keyframe& keyframe, const Frame& frame, const Pose& T_coarse,
                           const Pose& T_likely, const RollingShutter& shutter);

  private:
    FineOptions options_;
    PinholeCamera ideal_;
    EdgeTerm edges_;
    PhotometricTerm photometric_;
    EdgeClusters clusters_;
};

}  // namespace roevo
