#pragma once
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "method.h"
#include "tracking/motion_model.h"

namespace roevo {

/// An odometry that registers each frame to one that came before, its reference. Here is what such methods
/// have in common: bad frames are refused, motions are chained to poses, and a frame whose motion could not
/// be measured gets the pose of constant velocity (which stands still after half a second).
class RegistrationMethod : public Method {
  public:
    RegistrationMethod(const PinholeCamera& camera, const OdometryOptions& options);

    MethodFrame processFrame(const RgbdFrame& frame) final;

  protected:
    struct Registration {
        std::optional<Pose> T_reference_frame;  ///< the measured motion
        std::string reason;                     ///< why there is none, in words
        bool becomes_reference = true;          ///< the next frames are registered to this one
        std::vector<double> stage_ms;           ///< in the order of stages()
    };

    /// What is known before a frame is looked at.
    struct Expected {
        Pose T_reference_frame = Pose::Identity();  ///< by constant velocity
        double dt = 0;                              ///< s since the reference
        bool velocity_known = false;                ///< false: at rest, for want of anything better
    };

    /// The first frame, or one after it when none could be used so far: `becomes_reference` tells whether
    /// this one can.
    virtual Registration start(const RgbdFrame& frame) = 0;
    virtual Registration registerFrame(const RgbdFrame& frame, const Expected& expected) = 0;

    const PinholeCamera camera_;

  private:
    MotionModel motion_;
    bool started_ = false;
    double last_timestamp_ = -std::numeric_limits<double>::infinity();
    double reference_timestamp_ = 0;
    Pose T_world_reference_ = Pose::Identity();
    bool velocity_known_ = false;
};

}  // namespace roevo
