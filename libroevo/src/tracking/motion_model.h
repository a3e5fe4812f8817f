#pragma once
#include <limits>
#include <optional>

#include "roevo/options.h"
#include "tracking/photometric.h"
#include "tracking/readout_estimator.h"

namespace roevo {

/// What is known of a frame before looking at it, all relative to a reference.
struct Prediction {
    Pose T_reference_camera = Pose::Identity();  ///< by constant velocity
    Pose T_reference_last = Pose::Identity();    ///< of the frame before, measured or not
    PosePrior prior, search_prior;               ///< about the predicted pose; about the last one, wide
    RollingShutter shutter;
    Brightness brightness;      ///< of the last frame, against the reference
    double since_measured = 0;  ///< s
    bool blind = false;         ///< that is so long, and longer than usual, that all this is worth little
};

/// What is known of the camera's motion before a frame is looked at: constant velocity between measured
/// poses. Poses that were only predicted never enter. All poses are relative to a reference, which may
/// change; the velocity is the camera's own and knows of none.
class MotionModel {
  public:
    MotionModel(const MotionOptions& motion, const SensorOptions& sensor, int image_height);

    /// A frame has come, whatever becomes of it: what is usual between frames shows what is a gap.
    void expect(double timestamp);
    /// A pose whose motion since the last one was not measured: first frame, re-anchored, or recognised.
    void anchor(double timestamp, const Pose& T_reference_camera);
    /// A measured pose; with the one before it gives the velocity, unless their stamps nearly coincide (then
    /// it stays) or are far apart (then there is none).
    /// @param uncertainty  of the pose against its reference
    void measure(double timestamp, const Pose& T_reference_camera, const PoseUncertainty& uncertainty = {});
    /// A pose that was not measured: only a search looks around it.
    void assume(const Pose& T_reference_camera) { T_reference_assumed_ = T_reference_camera; }
    /// Brightness of the last frame against the reference.
    void setBrightness(const Brightness& brightness) { brightness_ = brightness; }
    /// The velocity is too old to be believed.
    void forgetVelocity() { interval_ = 0; }
    /// The last frame is the reference now: its pose is exact.
    void becomeReference() { uncertainty_ = {}; }
    /// Poses are relative to another keyframe from now on.
    void changeReference(const Pose& T_new_old);
    /// The last one that was measured.
    const Pose& measuredPose() const { return T_reference_last_; }
    /// Of the last frame, measured or assumed.
    const Pose& lastPose() const { return T_reference_assumed_; }

    [[nodiscard]] Prediction predict(double timestamp) const;

    /// Rows of a frame whose motion is not known.
    RowMotion stillRows() const;
    /// Of a keyframe that is the first of its track: how its rows moved shows only in the next frame, and
    /// taken for still it would teach that there is no read-out time. Still where the next frame is too late.
    RowMotion firstRows(double interval, const Pose& T_keyframe_next) const;
    double secondsPerRow() const;
    ReadoutEstimator& readout() { return readout_; }
    /// It was learned in an earlier recording of the same camera.
    void beginReadout(double seconds_per_row) {
        constexpr double kSigma = 2e-3;  // s: so well recordings of a few seconds tell it
        readout_.begin(seconds_per_row, kSigma / image_height_);
    }

  private:
    Pose poseAt(double timestamp) const;
    PosePrior prior(double timestamp) const;
    PosePrior searchPrior(double timestamp) const;
    RollingShutter shutter(double timestamp) const;
    double shortestStep() const;
    Matrix6d velocityGain(double dt) const;

    MotionOptions motion_;
    SensorOptions sensor_;
    int image_height_;
    Pose T_reference_last_ = Pose::Identity();     ///< measured
    Pose T_reference_assumed_ = Pose::Identity();  ///< or not
    Brightness brightness_;
    PoseUncertainty uncertainty_;  ///< of the last measured pose; nothing where that is the reference
    /// Of the last two poses as they were measured: how far the velocity may be off, and where it starts.
    Matrix6d covariance_ = Matrix6d::Zero(), covariance_before_ = Matrix6d::Zero();
    double design_effect_ = 1;  ///< of the poses so far
    /// s; before the first pose it is long ago
    double last_timestamp_ = -std::numeric_limits<double>::infinity();
    std::optional<double> last_frame_;  ///< s
    double interval_before_ = 0;        ///< s
    double usual_interval_ = 0;         ///< s, mean of those before the last frame; 0: none yet
    Pose step_ = Pose::Identity();      ///< T_last_current over interval_ seconds
    double interval_ = 0;               ///< s; 0 when no velocity is known
    ReadoutEstimator readout_;
};

}  // namespace roevo
