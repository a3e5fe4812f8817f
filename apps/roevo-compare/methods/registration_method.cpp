#include "registration_method.h"

#include <Eigen/Geometry>
#include <stdexcept>

#include "odometry/input_check.h"

namespace roevo {
namespace {

/// Seconds between two frames that make a velocity: nobody moves on evenly for longer, and what moved in a
/// shorter time is mostly an error of the stamps.
constexpr double kShortestGap = 0.005, kLongestGap = 0.5;

}  // namespace

RegistrationMethod::RegistrationMethod(const PinholeCamera& camera, const OdometryOptions& options)
    : camera_(camera), motion_(options.motion, options.sensor, camera.height) {
    if (const std::string fault = camera.check(); !fault.empty()) throw std::invalid_argument(fault);
}

MethodFrame RegistrationMethod::processFrame(const RgbdFrame& frame) {
    MethodFrame out;
    out.stage_ms.assign(stages().size(), 0.0);
    out.reason = inputFault(frame, camera_, last_timestamp_).words;
    if (out.reason.empty() && frame.depth.empty()) out.reason = "no depth image";
    if (!out.reason.empty()) return out;
    const double gap = frame.timestamp - last_timestamp_;
    last_timestamp_ = frame.timestamp;

    if (!started_) {
        const Registration first = start(frame);
        out.stage_ms = first.stage_ms;
        out.reason = first.reason;
        if (!first.becomes_reference) return out;
        started_ = out.tracked = true;
        out.T_world_camera = Pose::Identity();
        reference_timestamp_ = frame.timestamp;
        motion_.anchor(frame.timestamp, Pose::Identity());
        return out;
    }

    if (gap > kLongestGap) {
        motion_.forgetVelocity();
        velocity_known_ = false;
    }
    Expected expected;
    expected.T_reference_frame =
        T_world_reference_.inverse() * motion_.predict(frame.timestamp).T_reference_camera;
    expected.dt = frame.timestamp - reference_timestamp_;
    expected.velocity_known = velocity_known_;
    Registration found = registerFrame(frame, expected);
    out.stage_ms = found.stage_ms;
    out.reason = found.reason;
    if (found.T_reference_frame && !found.T_reference_frame->matrix().allFinite()) {
        found.T_reference_frame.reset();
        out.reason = "the registration gave a number that is not finite";
    }
    out.tracked = found.T_reference_frame.has_value();
    out.T_world_camera = T_world_reference_ * found.T_reference_frame.value_or(expected.T_reference_frame);
    if (out.tracked) {
        velocity_known_ = gap >= kShortestGap && gap <= kLongestGap;
        if (velocity_known_)
            motion_.measure(frame.timestamp, *out.T_world_camera);
        else
            motion_.anchor(frame.timestamp, *out.T_world_camera);
        out.reason.clear();
    }
    if (found.becomes_reference) {
        T_world_reference_ = *out.T_world_camera;
        reference_timestamp_ = frame.timestamp;
    }
    return out;
}

}  // namespace roevo
