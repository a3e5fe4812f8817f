#include "roevo/tracking/motion_model.h"

#include <Eigen/Geometry>
#include <algorithm>

#include "roevo/tracking/se3.h"

namespace roevo {
namespace {

constexpr double kLongestPrediction = 0.5;  ///< s; nobody moves on evenly for longer
constexpr double kShortestStep = 0.005,
                 kLongestStep = 0.15;    ///< s between two poses that make a velocity for the rows
constexpr double kLeastSigma = 1e-3;     ///< m and rad, of any prior
constexpr double kLongestReadout = 0.1;  ///< s

}  // namespace

MotionModel::MotionModel(const MotionOptions& motion, const SensorOptions& sensor, int image_height)
    : motion_(motion),
      sensor_(sensor),
      image_height_(image_height),
      readout_(sensor.readout_sigma / image_height, sensor.readout_memory) {}

void MotionModel::anchor(double timestamp, const Pose& T_world_camera) {
    T_world_last_ = T_world_camera;
    last_timestamp_ = timestamp;
    has_last_ = true;
    velocity_dt_ = 0;
}

void MotionModel::measure(double timestamp, const Pose& T_world_camera) {
    velocity_ = T_world_last_.inverse() * T_world_camera;
    velocity_dt_ = timestamp - last_timestamp_;
    T_world_last_ = T_world_camera;
    last_timestamp_ = timestamp;
}

Pose MotionModel::predict(double timestamp) const {
    if (velocity_dt_ <= 0) return T_world_last_;
    const double elapsed = std::clamp(timestamp - last_timestamp_, 0.0, kLongestPrediction);
    return T_world_last_ * interpolate(Pose::Identity(), velocity_, elapsed / velocity_dt_);
}

PosePrior MotionModel::prior(double timestamp, const Pose& T_world_keyframe) const {
    const double dt = timestamp - last_timestamp_;
    PosePrior prior;
    prior.mean = predict(timestamp).inverse() * T_world_keyframe;
    prior.sigma_translation = motion_.acceleration * dt * dt / 2;
    prior.sigma_rotation = motion_.angular_acceleration_deg * kDegree * dt * dt / 2;
    if (velocity_dt_ <= 0) {
        prior.sigma_translation += motion_.speed * dt;
        prior.sigma_rotation += motion_.angular_speed_deg * kDegree * dt;
    }
    prior.sigma_translation = std::max(prior.sigma_translation, kLeastSigma);
    prior.sigma_rotation = std::max(prior.sigma_rotation, kLeastSigma);
    return prior;
}

PosePrior MotionModel::searchPrior(double timestamp, const Pose& T_world_keyframe) const {
    const double dt = timestamp - last_timestamp_;
    return {T_world_last_.inverse() * T_world_keyframe, 0.1 + motion_.speed * dt, 20 * kDegree};
}

RollingShutter MotionModel::shutter(double timestamp, const Pose& T_world_keyframe) const {
    RollingShutter shutter;
    shutter.seconds_per_row = secondsPerRow();
    shutter.reference_row = stillRows().reference_row;
    const double dt = timestamp - last_timestamp_;
    if (has_last_ && dt >= kShortestStep && dt <= kLongestStep) {
        shutter.T_previous_keyframe = T_world_last_.inverse() * T_world_keyframe;
        shutter.since_previous = dt;
        if (velocity_dt_ >= kShortestStep && velocity_dt_ <= kLongestStep) {
            const Eigen::AngleAxisd turn(velocity_.linear());
            shutter.earlier_turn = turn.angle() / velocity_dt_ * turn.axis();
            shutter.earlier_velocity =
                velocity_.linear().transpose() * velocity_.translation() / velocity_dt_;
            shutter.earlier_interval = velocity_dt_;
        }
    }
    return shutter;
}

RowMotion MotionModel::stillRows() const {
    RowMotion rows;
    rows.reference_row = sensor_.reference_row * (image_height_ - 1);
    return rows;
}

double MotionModel::secondsPerRow() const {
    const double longest = kLongestReadout / image_height_;
    return sensor_.estimate_readout ? std::clamp(readout_.secondsPerRow(), -longest, longest)
                                    : sensor_.readout_time / image_height_;
}

}  // namespace roevo
