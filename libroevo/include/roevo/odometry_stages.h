#pragma once
#include <functional>

#include "roevo/tracking/fine_tracker.h"

namespace roevo {

/// A frame that becomes a keyframe.
struct KeyframeView {
    const EdgePoints3D& edges;
    const ImagePyramid& pyramid;  ///< of the ideal camera
    const cv::Mat& depth;         ///< raw: of the camera with its lens
    const RowMotion& rows;        ///< that `edges` were lifted with
};

/// What an experiment puts in the place of stages of the odometry, so that nothing else differs. Those left
/// empty are ROEVO's own.
struct OdometryStages {
    /// Chooses the points for photometric alignment; else samplePhotometricPoints().
    std::function<PhotometricPoints(const KeyframeView&)> photometric_points;

    /// Refines the coarse pose; else FineTracker::track(), which tells the parameters. Of its result the
    /// pose, its covariance and `converged` count; whether the frame is tracked and a new keyframe is due is
    /// judged by FineTracker::assess() at its pose, as ever.
    std::function<FineResult(const Keyframe&, const FineFrame&, const Pose& T_start, const PosePrior&,
                             const RollingShutter&, const Brightness&)>
        registration;

    /// Milliseconds for FrameResult::ms (but mapping and waiting); else the steady clock.
    double (*clock)() = nullptr;
};

}  // namespace roevo
