#include "evaluation/rpe.h"

#include <cmath>
#include <utility>

namespace roevo {
namespace {

constexpr double kDegrees = 180 / 3.14159265358979323846;

using IndexPairs = std::vector<std::pair<std::size_t, std::size_t>>;

RelativeError relativeError(const std::vector<StampedPose>& reference,
                            const std::vector<StampedPose>& estimate, const std::vector<PosePair>& pairs,
                            const IndexPairs& intervals, const std::vector<double>& lengths = {}) {
    std::vector<double> translation, rotation;
    for (std::size_t k = 0; k < intervals.size(); ++k) {
        const auto [i, j] = intervals[k];
        const double length = lengths.empty() ? 1 : lengths[k];
        const Pose motion_reference = reference[pairs[i].reference].T_world_camera.inverse() *
                                      reference[pairs[j].reference].T_world_camera;
        const Pose motion_estimate =
            estimate[pairs[i].estimate].T_world_camera.inverse() * estimate[pairs[j].estimate].T_world_camera;
        const Pose error = motion_reference.inverse() * motion_estimate;
        translation.push_back(error.translation().norm() / length);
        // The quaternion's angle, because the arc cosine of the trace has no digits left for small angles.
        const Eigen::Quaterniond q(error.linear());
        rotation.push_back(2 * std::atan2(q.vec().norm(), std::abs(q.w())) * kDegrees / length);
    }
    return {errorStatistics(std::move(translation)), errorStatistics(std::move(rotation))};
}

}  // namespace

RelativeError relativePoseErrorOverTime(const std::vector<StampedPose>& reference,
                                        const std::vector<StampedPose>& estimate,
                                        const std::vector<PosePair>& pairs, double interval) {
    const auto time = [&](std::size_t k) { return estimate[pairs[k].estimate].timestamp; };
    IndexPairs intervals;
    std::size_t j = 0;
    for (std::size_t i = 0; i < pairs.size(); ++i) {
        const double target = time(i) + interval;
        if (target > time(pairs.size() - 1) + kClockJitter) break;
        while (j + 1 < pairs.size() && std::abs(time(j + 1) - target) <= std::abs(time(j) - target)) ++j;
        if (std::abs(time(j) - target) <= kIntervalTolerance * interval) intervals.emplace_back(i, j);
    }
    return relativeError(reference, estimate, pairs, intervals);
}

RelativeError relativePoseErrorOverDistance(const std::vector<StampedPose>& reference,
                                            const std::vector<StampedPose>& estimate,
                                            const std::vector<PosePair>& pairs, double length) {
    std::vector<double> path(pairs.size(), 0), lengths;  // m up to each pair
    const auto centre = [&](std::size_t k) {
        return reference[pairs[k].reference].T_world_camera.translation();
    };
    for (std::size_t k = 1; k < pairs.size(); ++k) path[k] = path[k - 1] + (centre(k) - centre(k - 1)).norm();
    IndexPairs intervals;
    for (std::size_t i = 0, j = 0; i < pairs.size(); ++i) {
        const auto miss = [&](std::size_t k) { return std::abs(path[k] - path[i] - length); };
        while (j + 1 < pairs.size() && miss(j + 1) <= miss(j)) ++j;
        if (miss(j) > kIntervalTolerance * length) continue;
        intervals.emplace_back(i, j);
        lengths.push_back(path[j] - path[i]);
    }
    return relativeError(reference, estimate, pairs, intervals, lengths);
}

RelativeError relativePoseErrorPerFrame(const std::vector<StampedPose>& reference,
                                        const std::vector<StampedPose>& estimate,
                                        const std::vector<PosePair>& pairs) {
    IndexPairs intervals;
    for (std::size_t i = 0; i + 1 < pairs.size(); ++i) intervals.emplace_back(i, i + 1);
    return relativeError(reference, estimate, pairs, intervals);
}

}  // namespace roevo
