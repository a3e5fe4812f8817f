#include "evaluation/evaluate.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <iterator>
#include <stdexcept>
#include <string>

namespace roevo {
namespace {

constexpr std::size_t kMinPairs = 3;
constexpr double kLargestMaxDt = 1;  // s, that roevo-eval takes

std::string seconds(double value, int decimals = 6) {
    char text[64];
    std::snprintf(text, sizeof text, "%.*f s", decimals, value);
    return text;
}

std::string count(std::size_t poses) {
    return std::to_string(poses) + (poses == 1 ? " pose" : " poses");
}

std::string range(const std::vector<StampedPose>& poses) {
    return count(poses.size()) + " from " + seconds(poses.front().timestamp) + " to " +
           seconds(poses.back().timestamp);
}

double largestGap(const std::vector<StampedPose>& poses) {
    double gap = 0;
    for (std::size_t i = 1; i < poses.size(); ++i)
        gap = std::max(gap, poses[i].timestamp - poses[i - 1].timestamp);
    return gap;
}

// What would let the two trajectories meet, in words; empty when nothing is known to.
std::string advice(const std::vector<StampedPose>& reference, const std::vector<StampedPose>& estimate,
                   std::size_t found, double closest, double max_dt) {
    if (found == estimate.size()) return "; the estimate itself is too short";
    const auto duration = [](const std::vector<StampedPose>& poses) {
        return poses.back().timestamp - poses.front().timestamp;
    };
    const double overlap = std::min(reference.back().timestamp, estimate.back().timestamp) -
                           std::max(reference.front().timestamp, estimate.front().timestamp);
    if (overlap >= 0 && overlap >= 0.5 * std::min(duration(reference), duration(estimate)))
        return closest <= kLargestMaxDt ? "; try a larger --max-dt of roevo-eval"
                                        : "; are the stamps in seconds, from the same clock?";

    const double offset = reference.front().timestamp - estimate.front().timestamp;
    auto shifted = estimate;
    for (StampedPose& pose : shifted) pose.timestamp += offset;
    const std::size_t common = associate(reference, shifted, max_dt).size();
    if (common < kMinPairs) return "; even if both began together only " + count(common) + " would be common";
    return "; to let both start together add " + seconds(offset) +
           " to the estimate's stamps (roevo-eval --offset), then " + count(common) + " are common";
}

std::string explainTooFew(const std::vector<StampedPose>& reference, const std::vector<StampedPose>& estimate,
                          std::size_t found, double max_dt) {
    const double closest = smallestDifference(stampsOf(reference), stampsOf(estimate));
    return (found == 0   ? std::string("no pose has")
            : found == 1 ? "only 1 pose has"
                         : "only " + count(found) + " have") +
           " a reference within " + seconds(max_dt, 3) + " (at least 3 are needed): reference has " +
           range(reference) + " (largest gap " + seconds(largestGap(reference), 3) + "), estimate has " +
           range(estimate) + "; the closest stamps are " + seconds(closest) + " apart" +
           advice(reference, estimate, found, closest, max_dt);
}

// Of the estimate, in units of the reference's.
double scaleOf(const std::vector<StampedPose>& reference, const std::vector<StampedPose>& estimate,
               const std::vector<PosePair>& pairs) {
    std::vector<Eigen::Vector3d> source, target;
    for (const PosePair& pair : pairs) {
        source.push_back(estimate[pair.estimate].T_world_camera.translation());
        target.push_back(reference[pair.reference].T_world_camera.translation());
    }
    return bestScale(source, target);
}

bool allFinite(const Evaluation& evaluation) {
    for (const ErrorStatistics* s :
         {&evaluation.ate.translation, &evaluation.rpe_second.translation, &evaluation.rpe_second.rotation,
          &evaluation.rpe_frame.translation, &evaluation.rpe_frame.rotation})
        if (s->count > 0 && !(std::isfinite(s->rmse) && std::isfinite(s->std) && std::isfinite(s->max)))
            return false;
    return true;
}

}  // namespace

Evaluation evaluate(const std::vector<StampedPose>& reference, const std::vector<StampedPose>& estimate,
                    double max_dt, Alignment alignment) {
    if (reference.empty() || estimate.empty())
        throw std::runtime_error(std::string("the ") + (reference.empty() ? "reference" : "estimate") +
                                 " has no pose");
    Evaluation result;
    result.pairs = associate(reference, estimate, max_dt);
    if (result.pairs.size() < kMinPairs)
        throw std::runtime_error(explainTooFew(reference, estimate, result.pairs.size(), max_dt));
    if (alignment == Alignment::kSim3) {
        // The best rotation does not depend on the scale: what is left to do is rigid
        const double scale = scaleOf(reference, estimate, result.pairs);
        auto scaled = estimate;
        for (StampedPose& pose : scaled) pose.T_world_camera.translation() *= scale;
        result = evaluate(reference, scaled, max_dt);
        result.scale = scale;
        return result;
    }
    result.ate = absoluteTrajectoryError(reference, estimate, result.pairs, alignment);
    result.rpe_second = relativePoseErrorOverTime(reference, estimate, result.pairs, 1.0);
    result.rpe_frame = relativePoseErrorPerFrame(reference, estimate, result.pairs);
    // Squares of what is beyond 1e150 m are no numbers any more
    if (!allFinite(result)) throw std::runtime_error("its errors are too large to be computed");
    return result;
}

std::vector<StampedPose> coveredPart(const std::vector<StampedPose>& reference,
                                     const std::vector<StampedPose>& trajectory) {
    std::vector<StampedPose> covered;
    if (trajectory.empty()) return covered;
    std::copy_if(reference.begin(), reference.end(), std::back_inserter(covered), [&](const auto& pose) {
        return pose.timestamp >= trajectory.front().timestamp - kDefaultMaxDt &&
               pose.timestamp <= trajectory.back().timestamp + kDefaultMaxDt;
    });
    return covered;
}

double pathLength(const std::vector<StampedPose>& trajectory) {
    double length = 0;
    for (std::size_t i = 1; i < trajectory.size(); ++i)
        length +=
            (trajectory[i].T_world_camera.translation() - trajectory[i - 1].T_world_camera.translation())
                .norm();
    return length;
}

}  // namespace roevo
