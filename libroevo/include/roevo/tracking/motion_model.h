#pragma once
#include "roevo/options.h"
#include "roevo/tracking/gauss_newton.h"
#include "roevo/tracking/rolling_shutter.h"

namespace roevo {

/// What is known of the camera's motion before a frame is looked at: constant velocity between measured
/// poses. Poses that were only predicted never enter.
class MotionModel {
  public:
    MotionModel(const MotionOptions& motion, const SensorOptions& sensor, int image_height);

    /// A pose whose motion since the last one was not measured: first frame, re-anchored, or found again by a
    /// search.
    void anchor(double timestamp, const Pose& T_world_camera);
    /// A measured pose; with the one before it gives the velocity.
    void measure(double timestamp, const Pose& T_world_camera);
    /// The velocity is too old to be believed.
    void forgetVelocity() { velocity_dt_ = 0; }

    /// The world's axes were corrected: poses become correction * pose.
    void moveWorld(const Pose& correction) { T_world_last_ = correction * T_world_last_; }

    Pose predict(double timestamp) const;
    /// About predict(), as wide as the likely acceleration allows since the last measured pose.
    PosePrior prior(double timestamp, const Pose& T_world_keyframe) const;
    /// About the last measured pose, as wide as a search looks.
    PosePrior searchPrior(double timestamp, const Pose& T_world_keyframe) const;

    RollingShutter shutter(double timestamp, const Pose& T_world_keyframe) const;
    /// Rows of a frame whose motion is not known.
    RowMotion stillRows() const;
    double secondsPerRow() const;
    ReadoutEstimator& readout() { return readout_; }

  private:
    MotionOptions motion_;
    SensorOptions sensor_;
    int image_height_;
    Pose T_world_last_ = Pose::Identity();
    double last_timestamp_ = 0;
    bool has_last_ = false;
    Pose velocity_ = Pose::Identity();  ///< T_last_current over velocity_dt_ seconds
    double velocity_dt_ = 0;            ///< s; 0 when no velocity is known
    ReadoutEstimator readout_;
};

}  // namespace roevo
