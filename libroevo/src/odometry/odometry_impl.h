#pragma once
#include <exception>
#include <limits>
#include <memory>
#include <optional>

#include "frame_preparer.h"
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
          preparer(raw, scaledTo(raw, opts)),
          tracker(std::move(own_tracker)),
          motion(opts.motion, opts.sensor, raw.height),
          world(raw, opts, *tracker) {}

    PinholeCamera camera;
    OdometryOptions options;  // as given
    Pose T_world_start;
    FramePreparer preparer;
    std::unique_ptr<Tracker> tracker;
    MotionModel motion;  // relative to the reference, as all but the world
    World world;

    std::unique_ptr<Frame> frame, frame_before;
    std::vector<std::unique_ptr<Frame>> lost;  // the last ones, since the camera's pose was known
    std::optional<Tracking> candidate;         // of the frame before, if it can still become a keyframe
    std::exception_ptr failure;                // what a frame threw: all is half done
    double last_timestamp = -std::numeric_limits<double>::infinity();
    double edges_ms = 0;
    bool measured = false;   // the pose of what is in `frame` was
    bool is_frozen = false;  // images since then are the same
    bool localised = false;  // as the last frame's reason told
    int lost_frames = 0;
    double lost_since = 0;  // s

    void requireWhole() const {
        if (failure) std::rethrow_exception(failure);
    }
    /// What changes something: where it throws, all is half done.
    template <class Work>
    auto changing(const Work& work) {
        requireWhole();
        try {
            return work();
        } catch (...) {
            failure = std::current_exception();
            throw;
        }
    }
    FrameResult processFrame(PreparedFrame::Content prepared);
    void expect(double timestamp);
    void take(std::unique_ptr<Frame> fresh);
    bool isFrozen(const Frame& fresh);
    Outcome frozen(std::unique_ptr<Frame> fresh);
    Outcome start();
    Tracking track(const Prediction& prediction);
    void trackFromNearer(Outcome& outcome, Prediction& prediction);
    Tracking searchBetter(const Tracking& tracking, const Prediction& prediction);
    Tracking confirmed(const Keyframe& keyframe, Tracking tracking, const Prediction& prediction);
    std::optional<RelativePose> trackFromPrevious();
    std::optional<RelativePose> trackFromHere();
    std::optional<Outcome> anchorAt(const RelativePose& found, const Tracking& failed);
    Outcome findAgain(Outcome outcome, double since_measured);
    Outcome bridge(Outcome outcome, double since_measured);
    bool returnToFormer(Outcome& outcome);
    void renewReference(Outcome& outcome);
    void lookForOtherTrack(Outcome& outcome);
    void learn(Tracking& tracking, const Prediction& prediction);
    MotionModel startingHere(const Pose& T_keyframe_camera) const;
    void trackBack(const Tracking& tracking);
    Fault beginTrack(const Pose& T_world_camera, const Matrix6d& covariance, double lost_for,
                     Outcome& outcome);
    Fault promote(const Frame& promoted, const Tracking& tracked);
    FrameResult report(const Outcome& outcome);
};

}  // namespace roevo
