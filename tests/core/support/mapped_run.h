#pragma once
/// Runs of the odometry with local mapping over a small simulated room that is rendered once per program.

#include <cstring>
#include <opencv2/core.hpp>

#include "core/support/random_pose.h"
#include "core/support/simulated.h"

namespace roevo::testing {

constexpr int kRendered = 26;           ///< frames
constexpr double kInterval = 1 / 30.0;  ///< s
constexpr double kMoved = 1e-9;         ///< m; what is less is rounding

inline const Sequence& room() {
    static const Sequence sequence = simulate(smallRoom(), kRendered);
    return sequence;
}

/// Away for as many frames as are rendered, back again, away ...
inline Sequence backAndForth(int count) {
    Sequence path;
    path.camera = room().camera;
    for (int i = 0; i < count; ++i) {
        const int k = i % (2 * kRendered - 2);
        const auto at = static_cast<std::size_t>(k < kRendered ? k : 2 * kRendered - 2 - k);
        path.frames.push_back(room().frames[at]);
        path.truth.push_back(room().truth[at]);
        path.frames.back().timestamp = path.truth.back().timestamp = 1 + i * kInterval;
    }
    return path;
}

/// Keyframes every few frames, so that short sequences map a lot.
inline OdometryOptions manyKeyframes() {
    OdometryOptions options;
    options.keyframe.max_translation = 0.02;
    return options;
}

struct MappedRun {
    std::vector<FrameResult> results;
    std::vector<StampedPose> final_poses, live_poses;
    std::vector<KeyframeInfo> keyframes;

    int updates() const {
        return static_cast<int>(std::count_if(results.begin(), results.end(), [](const auto& result) {
            return result.map_correction > kMoved;
        }));
    }
};

/// @param between  done before every frame
template <class Between>
MappedRun runOver(const Sequence& sequence, const OdometryOptions& options, const Between& between) {
    Odometry odometry(sequence.camera, options, sequence.start());
    MappedRun run;
    for (const RgbdFrame& frame : sequence.frames) {
        between(odometry);
        run.results.push_back(odometry.processFrame(frame));
    }
    run.final_poses = odometry.trajectory();
    run.live_poses = odometry.liveTrajectory();
    run.keyframes = odometry.keyframes();
    return run;
}

inline MappedRun runOver(const Sequence& sequence, const OdometryOptions& options) {
    return runOver(sequence, options, [](Odometry&) {});
}

inline bool sameBytes(const std::vector<StampedPose>& a, const std::vector<StampedPose>& b) {
    return a.size() == b.size() &&
           std::equal(a.begin(), a.end(), b.begin(), [](const auto& p, const auto& q) {
               return p.timestamp == q.timestamp && p.T_world_camera.matrix() == q.T_world_camera.matrix();
           });
}

inline double distance(const Pose& a, const Pose& b) {
    return (a.translation() - b.translation()).norm();
}

inline RgbdFrame black(double timestamp) {
    return {timestamp, cv::Mat::zeros(240, 320, CV_8UC1), cv::Mat::zeros(240, 320, CV_32FC1), cv::Mat()};
}

}  // namespace roevo::testing
