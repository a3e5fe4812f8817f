#include "recovery.h"

#include <cmath>

#include "roevo/tracking/se3.h"

namespace roevo {

std::vector<Pose> searchAround(const Pose& T_current_keyframe) {
    constexpr double kStep = 3 * kDegree;
    constexpr int kReach = 6;
    std::vector<Pose> guesses;
    for (int yaw = -kReach; yaw <= kReach; ++yaw) {
        for (int pitch = -kReach; pitch <= kReach; ++pitch) {
            Vector6d turn = Vector6d::Zero();
            turn[3] = pitch * kStep;
            turn[4] = yaw * kStep;
            guesses.push_back(poseIncrement(turn) * T_current_keyframe);
        }
    }
    return guesses;
}

std::string lackOf(const FineResult& refined, const FineOptions& options) {
    if (refined.inliers < options.min_inliers) {
        return "only " + std::to_string(refined.inliers) + " associated edge points, " +
               std::to_string(options.min_inliers) + " needed";
    }
    if (refined.matched_ratio >= options.min_matched_ratio) return "the pose diverged";
    return "only " + std::to_string(std::lround(100 * refined.matched_ratio)) +
           " % of the edges associated, " + std::to_string(std::lround(100 * options.min_matched_ratio)) +
           " % needed";
}

}  // namespace roevo
