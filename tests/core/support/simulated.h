#pragma once
#include <algorithm>
#include <cmath>
#include <opencv2/core/utility.hpp>
#include <vector>

#include "evaluation/evaluate.h"
#include "roevo/odometry.h"
#include "roevo_simulator/simulator.h"

namespace roevo::testing {

/// A simulated sequence held in memory.
struct Sequence {
    PinholeCamera camera;
    std::vector<RgbdFrame> frames;
    std::vector<StampedPose> truth;
    Pose start() const { return truth.front().T_world_camera; }
};

/// Whoever changes OpenCV's number of threads leaves it as it was.
struct ThreadsRestored {
    int before = cv::getNumThreads();
    ~ThreadsRestored() { cv::setNumThreads(before); }
};

/// The first `count` frames of a simulation, as the sensor measures them.
inline Sequence simulate(const simulator::SimulationOptions& options, int count) {
    const simulator::Simulator simulator(options);
    Sequence sequence;
    sequence.camera = simulator.camera();
    for (int i = 0; i < count; ++i) {
        const simulator::SimulatedFrame frame = simulator.frame(i);
        sequence.frames.push_back({frame.timestamp, frame.grey, frame.depth_noisy, cv::Mat()});
        sequence.truth.push_back({frame.timestamp, frame.T_world_camera});
    }
    return sequence;
}

inline simulator::SimulationOptions smallRoom() {
    simulator::SimulationOptions options;
    options.width = 320;
    options.height = 240;
    return options;
}

struct TrackedRun {
    std::vector<FrameResult> results;
    std::vector<StampedPose> trajectory;
    int count(FrameStatus status) const {
        return static_cast<int>(std::count_if(results.begin(), results.end(), [&](const FrameResult& result) {
            return result.status == status;
        }));
    }
};

inline TrackedRun track(const Sequence& sequence, const OdometryOptions& options = OdometryOptions()) {
    Odometry odometry(sequence.camera, options, sequence.start());
    TrackedRun run;
    for (const auto& frame : sequence.frames) run.results.push_back(odometry.processFrame(frame));
    run.trajectory = odometry.trajectory();
    return run;
}

/// Makes the world twice as large. The weights know metres (Eq. (20), the sensor's noise, likely speeds):
/// they are scaled with it.
inline void makeTwiceAsLarge(Sequence& sequence, OdometryOptions& options) {
    options.sensor.max_depth *= 2;
    options.sensor.min_depth *= 2;
    options.sensor.depth_limit *= 2;
    options.sensor.depth_weight_k /= 2;
    options.sensor.depth_noise /= 2;
    options.motion.acceleration *= 2;
    options.motion.speed *= 2;
    for (auto& frame : sequence.frames) frame.depth = cv::Mat(2 * frame.depth);  // its own memory
    for (auto& pose : sequence.truth) pose.T_world_camera.translation() *= 2;
}

/// RMSE of the positions, m, with no alignment: both begin at the same pose.
inline double positionError(const TrackedRun& run, const Sequence& sequence) {
    double sum = 0;
    int n = 0;
    for (std::size_t i = 0; i < run.results.size(); ++i) {
        if (!run.results[i].hasPose()) continue;
        sum += (run.results[i].T_world_camera.translation() - sequence.truth[i].T_world_camera.translation())
                   .squaredNorm();
        ++n;
    }
    return std::sqrt(sum / std::max(1, n));
}

}  // namespace roevo::testing
