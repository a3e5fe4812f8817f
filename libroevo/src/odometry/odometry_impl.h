#pragma once
#include <limits>
#include <memory>
#include <optional>

#include "front_end.h"
#include "input_check.h"
#include "outcome.h"
#include "roevo/odometry.h"
#include "tracking/camera_scale.h"
#include "world.h"

namespace roevo {

/// What happens to a frame; Odometry's own functions only pass on to it.
struct Odometry::Impl {
    Impl(const PinholeCamera& raw, const OdometryOptions& opts, const Pose& start,
         std::unique_ptr<Tracker> own_tracker)
        : camera(raw),
          options(opts),
          T_world_start(start),
          front_end(raw, scaledTo(raw, opts)),
          tracker(std::move(own_tracker)),
          motion(opts.motion, opts.sensor, raw.height),
          world(raw, opts) {}

    PinholeCamera camera;
    OdometryOptions options;  // as given
    Pose T_world_start;
    FrontEnd front_end;
    std::unique_ptr<Tracker> tracker;
    MotionModel motion;  // relative to the reference, as all but the world
    World world;

    std::unique_ptr<Frame> frame = std::make_unique<Frame>(), frame_before = std::make_unique<Frame>();
    std::optional<Tracking> candidate;  // of the frame before, if it can still become a keyframe
    double last_timestamp = -std::numeric_limits<double>::infinity();
    LeapCheck leaps;
    double edges_ms = 0;
    bool measured = false;   // the pose of what is in `frame` was
    bool is_frozen = false;  // images since then are the same
    int lost_frames = 0;
    double lost_since = 0;  // s

    FrameResult processFrame(const RgbdFrame& images);
    void expect(double timestamp);
    void prepare(const RgbdFrame& images);
    bool isFrozen(const RgbdFrame& images);
    Outcome frozen(double timestamp);
    Outcome start();
    Tracking track(const Prediction& prediction);
    Tracking confirmed(Tracking tracking, const Prediction& prediction);
    std::optional<Outcome> anchorAt(const RelativePose& found, const Tracking& failed);
    Outcome findAgain(Tracking failed, double since_measured);
    Outcome bridge(Tracking failed, double since_measured);
    void renewReference(Outcome& outcome);
    void learn(const Tracking& tracking, const Prediction& prediction);
    void settle(const Outcome& outcome);
    Fault beginTrack(const Pose& T_world_camera, const Matrix6d& covariance);
    Fault promote(const Frame& promoted, const Tracking& tracked);
    FrameResult report(const Outcome& outcome);
};

}  // namespace roevo
