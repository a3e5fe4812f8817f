#include "evaluation/association.h"

#include <algorithm>
#include <cmath>
#include <tuple>

namespace roevo {
namespace {

constexpr double kLargestGap = 0.1;  // s

}  // namespace

std::vector<StampMatch> associateStamps(const std::vector<double>& first, const std::vector<double>& second,
                                        double max_difference) {
    std::vector<std::tuple<double, std::size_t, std::size_t>> candidates;
    for (std::size_t i = 0; i < first.size(); i++) {
        auto j = std::lower_bound(second.begin(), second.end(), first[i] - max_difference);
        for (; j != second.end() && *j <= first[i] + max_difference; ++j)
            candidates.emplace_back(std::abs(*j - first[i]), i, static_cast<std::size_t>(j - second.begin()));
    }
    std::sort(candidates.begin(), candidates.end());

    std::vector<bool> first_taken(first.size()), second_taken(second.size());
    std::vector<StampMatch> matches;
    for (const auto& [difference, i, j] : candidates) {
        if (first_taken[i] || second_taken[j]) continue;
        first_taken[i] = second_taken[j] = true;
        matches.push_back({i, j});
    }
    std::sort(matches.begin(), matches.end(),
              [](const StampMatch& a, const StampMatch& b) { return a.first < b.first; });
    return matches;
}

double smallestDifference(const std::vector<double>& a, const std::vector<double>& b) {
    double smallest = INFINITY;
    for (const double t : a) {
        const auto next = std::lower_bound(b.begin(), b.end(), t);
        if (next != b.end()) smallest = std::min(smallest, *next - t);
        if (next != b.begin()) smallest = std::min(smallest, t - *(next - 1));
    }
    return smallest;
}

std::vector<PosePair> associate(const std::vector<StampedPose>& reference,
                                const std::vector<StampedPose>& estimate, double max_dt) {
    std::vector<PosePair> pairs;
    for (const StampMatch& match : associateStamps(stampsOf(estimate), stampsOf(reference), max_dt))
        pairs.push_back({match.second, match.first});
    return pairs;
}

std::optional<Pose> poseAt(const std::vector<StampedPose>& trajectory, double time) {
    const auto next =
        std::lower_bound(trajectory.begin(), trajectory.end(), time,
                         [](const StampedPose& pose, double bound) { return pose.timestamp < bound; });
    const auto isNear = [&](const StampedPose& pose) {
        return std::abs(pose.timestamp - time) <= kClockJitter;
    };
    if (next == trajectory.begin() || next == trajectory.end()) {
        if (trajectory.empty()) return std::nullopt;
        const StampedPose& end = next == trajectory.end() ? trajectory.back() : trajectory.front();
        return isNear(end) ? std::make_optional(end.T_world_camera) : std::nullopt;
    }
    const StampedPose &a = *(next - 1), &b = *next;
    const double gap = b.timestamp - a.timestamp;
    if (gap > kLargestGap)
        return isNear(b)   ? std::make_optional(b.T_world_camera)
               : isNear(a) ? std::make_optional(a.T_world_camera)
                           : std::nullopt;
    const double share = (time - a.timestamp) / gap;
    const Pose &from = a.T_world_camera, &to = b.T_world_camera;
    return Pose(from.rotation().slerp(share, to.rotation()),
                (1 - share) * from.translation() + share * to.translation());
}

}  // namespace roevo
