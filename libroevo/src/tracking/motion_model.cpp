#include "tracking/motion_model.h"

#include <Eigen/Cholesky>
#include <algorithm>

#include "tracking/relative_pose.h"
#include "tracking/se3.h"

namespace roevo {
namespace {

constexpr double kLongestPrediction = 0.5;  ///< s; nobody moves on evenly for longer
constexpr double kLongestAway = 3600;       ///< s; by then it may be anywhere
constexpr double kAnyTurn = 180;            ///< degrees
/// Times the mean interval between frames, or that of a Kinect where it is longer: still a usual one.
constexpr double kUsual = 2.5;
constexpr double kShortestStep = 0.005,  ///< s, or half of the usual interval
    kLongestStep = 0.35;                 ///< s between two poses that make a velocity
constexpr double kLeastSigma = 1e-3;     ///< m and rad, of any motion
constexpr double kSearchTurn = 20;       ///< degrees, one sigma, of a camera that is searched for
constexpr double kLongestReadout = 0.1;  ///< s
constexpr double kLearning = 0.2;        ///< share of the newest frame in means

/// By axis: linear, and of a turn in degrees (squared in radians).
Vector6d squared(double linear, double turn_deg) {
    Vector6d out;
    out << Eigen::Vector3d::Constant(linear), Eigen::Vector3d::Constant(kDegree * turn_deg);
    return out.cwiseAbs2();
}

}  // namespace

MotionModel::MotionModel(const MotionOptions& motion, const SensorOptions& sensor, int image_height)
    : motion_(motion),
      sensor_(sensor),
      image_height_(image_height),
      readout_(sensor.readout_sigma / image_height, sensor.readout_memory) {}

void MotionModel::expect(double timestamp) {
    const double interval = last_frame_ ? timestamp - *last_frame_ : 0;
    if (usual_interval_ <= 0)
        usual_interval_ = std::min(interval, kLongestPrediction);  // the first may be a gap
    else  // a gap counts for no more than what is just usual, so that another rate is learned in a few frames
        usual_interval_ +=
            kLearning * (std::min(interval_before_, kUsual * usual_interval_) - usual_interval_);
    interval_before_ = interval;
    last_frame_ = timestamp;
}

void MotionModel::anchor(double timestamp, const Pose& T_reference_camera) {
    T_reference_last_ = T_reference_assumed_ = T_reference_camera;
    uncertainty_ = {};
    covariance_.setZero();
    covariance_before_.setZero();
    brightness_ = Brightness();
    last_timestamp_ = timestamp;
    interval_ = 0;
}

void MotionModel::measure(double timestamp, const Pose& T_reference_camera,
                          const PoseUncertainty& uncertainty) {
    design_effect_ += kLearning * (uncertainty.designEffect() - design_effect_);
    const double interval = timestamp - last_timestamp_;
    // What moved between two stamps that nearly coincide is mostly their errors: the velocity stays
    if (interval >= shortestStep()) {
        step_ = T_reference_last_.inverse() * T_reference_camera;
        interval_ = interval <= kLongestStep ? interval : 0;
        covariance_before_ = covariance_;
    }
    uncertainty_ = uncertainty;
    covariance_ = uncertainty.covariance();
    T_reference_last_ = T_reference_assumed_ = T_reference_camera;
    last_timestamp_ = timestamp;
}

void MotionModel::changeReference(const Pose& T_new_old) {
    T_reference_last_ = T_new_old * T_reference_last_;
    T_reference_assumed_ = T_new_old * T_reference_assumed_;
    brightness_ = Brightness();
}

Prediction MotionModel::predict(double timestamp) const {
    const double dt = timestamp - last_timestamp_;
    return {poseAt(timestamp),
            T_reference_assumed_,
            prior(timestamp),
            searchPrior(timestamp),
            shutter(timestamp),
            brightness_,
            dt,
            usual_interval_ > 0 && dt > kUsual * std::max(usual_interval_, 1 / kFrameRate)};
}

Pose MotionModel::poseAt(double timestamp) const {
    if (interval_ <= 0) return T_reference_last_;
    const double elapsed = std::clamp(timestamp - last_timestamp_, 0.0, kLongestPrediction);
    return T_reference_last_ * interpolate(Pose::Identity(), step_, elapsed / interval_);
}

PosePrior MotionModel::prior(double timestamp) const {
    // Where two stamps nearly coincide, the time between them is mostly their errors
    const double since = timestamp - last_timestamp_;
    const double dt = since < shortestStep() ? std::max(since, usual_interval_) : since;
    const bool moving = interval_ > 0;
    // A mean velocity is that of the middle of its interval: x(dt) - v dt = a dt (dt + interval) / 2. In a
    // longer time it says nothing, and a camera comes as far as its speed lets it
    const double even = std::min(dt, kLongestPrediction), onwards = std::min(dt, kLongestAway) - even;
    const double by_acceleration = even * (even + (moving ? interval_ : 0)) / 2;
    const double by_speed = (moving ? 0 : even) + onwards;
    const Matrix6d by_motion = squared(motion_.acceleration * by_acceleration + motion_.speed * by_speed,
                                       std::min(motion_.angular_acceleration_deg * by_acceleration +
                                                    motion_.angular_speed_deg * by_speed,
                                                kAnyTurn))
                                   .cwiseMax(kLeastSigma * kLeastSigma)
                                   .asDiagonal();
    const Pose mean = poseAt(timestamp);
    const Matrix6d onward = carriedTo(T_reference_last_.inverse() * mean);
    // The velocity errs by both poses that it is made of, the last one twice
    const double share = moving ? dt / interval_ : 0;
    const Matrix6d of_poses = (1 + share) * (1 + share) * covariance_ + share * share * covariance_before_;
    return {mean.inverse(), by_motion + onward * of_poses * onward.transpose(), design_effect_,
            sum(uncertainty_, onward, {by_motion, {}})};
}

PosePrior MotionModel::searchPrior(double timestamp) const {
    const double dt = timestamp - last_timestamp_;
    const Matrix6d wide = squared(0.1 + motion_.speed * dt, kSearchTurn).asDiagonal();
    return {T_reference_last_.inverse(), wide, 1, {wide, {}}};
}

RollingShutter MotionModel::shutter(double timestamp) const {
    RollingShutter shutter;
    shutter.rows = stillRows().at(secondsPerRow());
    if (sensor_.estimate_readout) shutter.readout_sigma = readout_.sigma();
    const double dt = timestamp - last_timestamp_;
    const bool known = dt >= shortestStep() && dt <= kLongestStep;
    // A mean velocity is that of half the time ago
    shutter.velocity_variance =
        known ? squared(motion_.acceleration * dt / 2, motion_.angular_acceleration_deg * dt / 2)
              : squared(motion_.speed, motion_.angular_speed_deg);
    if (known) {
        shutter.T_previous_keyframe = T_reference_last_.inverse();
        shutter.since_previous = dt;
        if (interval_ > 0) {
            const Velocity earlier = velocityOf(step_, interval_);
            shutter.rows.turn = earlier.turn;
            shutter.rows.velocity = earlier.linear;
            shutter.earlier_interval = interval_;
            shutter.gain = velocityGain(dt);
        }
    }
    return shutter;
}

/// Kalman gain of a velocity from three poses `dt` s apart: what likely accelerations change in that time,
/// and what the poses' errors do.
Matrix6d MotionModel::velocityGain(double dt) const {
    constexpr double kThreePoses = 1.5 * 1.5 + 2 * 2 + 0.5 * 0.5;  // their shares in it, squared
    const Matrix6d changes =
        squared(motion_.acceleration * dt, motion_.angular_acceleration_deg * dt).asDiagonal();
    const Matrix6d both = changes + kThreePoses / (dt * dt) * covariance_;
    return both.ldlt().solve(changes).transpose();
}

RowMotion MotionModel::firstRows(double interval, const Pose& T_keyframe_next) const {
    RowMotion rows = stillRows().at(secondsPerRow());
    if (!(interval >= kShortestStep && interval <= kLongestStep)) return rows;
    const Velocity velocity = velocityOf(T_keyframe_next, interval);
    rows.turn = velocity.turn;
    rows.velocity = T_keyframe_next.translation() / interval;
    return rows;
}

/// Between two stamps that nearly coincide, for this camera.
double MotionModel::shortestStep() const {
    return usual_interval_ > 0 ? std::min(kShortestStep, usual_interval_ / 2) : kShortestStep;
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
