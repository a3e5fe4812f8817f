#include "judge.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <optional>

#include "evaluation/evaluate.h"
#include "tracking/se3.h"

namespace roevo::faults {
namespace {

constexpr double kSigmas = 3;
constexpr double kFloor = 0.015, kFloorTurn = 1 * kDegree;  // m, rad: what truth itself and rounding do
constexpr int kRecovery = 5;                                // frames
constexpr double kAteFactor = 1.5, kAteFloor = 0.002;       // m
constexpr std::size_t kShort = 10;                          // frames: a fault that is to be forgotten

std::string text(const char* pattern, double a, double b = 0) {
    char buffer[160];
    std::snprintf(buffer, sizeof buffer, pattern, a, b);
    return buffer;
}

bool isRigid(const Pose& pose) {
    const Eigen::Matrix3d& R = pose.linear();
    return pose.isFinite() && (R * R.transpose() - Eigen::Matrix3d::Identity()).norm() < 1e-6 &&
           std::abs(R.determinant() - 1) < 1e-6;
}

bool isCovariance(const Matrix6d& covariance) {
    if (!covariance.allFinite() || !covariance.isApprox(covariance.transpose(), 1e-6)) return false;
    const Eigen::SelfAdjointEigenSolver<Matrix6d> solver(covariance, Eigen::EigenvaluesOnly);
    return solver.eigenvalues()[0] > -1e-9 * std::max(1.0, solver.eigenvalues()[5]);
}

bool isOk(const FrameResult& result) {
    return result.status == FrameStatus::kOk;
}

/// Motions from one frame that is ok and says nothing to the next against the truth: error, and what their
/// covariance, and corrections by the map that were told, leave unexplained.
void jumps(const std::vector<Shown>& frames, const Odometry& odometry, Played& played) {
    struct Last {
        std::size_t live, frame;
    };
    std::optional<Last> last;
    std::size_t live = 0;
    double moved = 0, turned = 0;
    for (std::size_t i = 0; i < frames.size(); ++i) {
        const FrameResult& result = played.results[i];
        played.jump.push_back(0);
        played.allowed.push_back(0);
        if (!result.hasPose()) continue;
        const std::size_t now = live++;
        moved += result.map_correction;
        turned += result.map_turn;
        if (result.status == FrameStatus::kInitialised) last.reset();
        if (last && isOk(result)) {
            const Pose truth = frames[last->frame].truth.inverse() * frames[i].truth;
            const Pose motion = played.results[last->frame].T_world_camera.inverse() * result.T_world_camera;
            const Pose error = truth.inverse() * motion;
            const Matrix6d covariance = odometry.motionCovariance(last->live, now);
            const double by_position = error.translation().norm() - moved - kFloor -
                                       kSigmas * std::sqrt(covariance.topLeftCorner<3, 3>().trace());
            const double by_turn = rotationAngle(error) - turned - kFloorTurn -
                                   kSigmas * std::sqrt(covariance.bottomRightCorner<3, 3>().trace());
            played.jump.back() =
                by_turn > 0 ? std::max(by_position, by_turn) : by_position;  // a lever of 1 m
        }
        const bool silent = isOk(result) && result.reason.empty();
        if (!silent && result.status != FrameStatus::kInitialised) continue;
        last = Last{now, i};
        moved = turned = 0;
    }
}

/// ATE over the frames that are whole in `frames`.
double ateOf(const std::vector<Shown>& frames, const std::vector<StampedPose>& trajectory) {
    std::vector<StampedPose> truth;
    for (const Shown& shown : frames)
        if (!shown.faulty) truth.push_back({shown.frame.timestamp, shown.truth});
    try {
        return evaluate(truth, trajectory, 1e-4).ate.translation.rmse;
    } catch (const std::exception&) {
        return std::numeric_limits<double>::infinity();
    }
}

void judgeFrames(const std::vector<Shown>& frames, const Played& played, Expected expected,
                 Verdict& verdict) {
    const bool promised = expected != Expected::kSurvived;
    for (std::size_t i = 0; i < frames.size(); ++i) {
        const FrameResult& result = played.results[i];
        const std::string at = text("frame %.0f: ", static_cast<double>(i));
        if (result.hasPose() && !isRigid(result.T_world_camera))
            verdict.broken.push_back(at + "no rigid pose");
        if (!isCovariance(result.covariance)) verdict.broken.push_back(at + "no covariance");
        if (!isOk(result) && result.reason.empty()) verdict.broken.push_back(at + "no reason");
        const bool silent = isOk(result) && result.reason.empty();
        (silent ? verdict.worst_jump : verdict.worst_named) =
            std::max(silent ? verdict.worst_jump : verdict.worst_named, played.jump[i]);
        if (silent && promised && played.jump[i] > 0)
            verdict.broken.push_back(at + text("jumps by %.1f cm unreported", 100 * played.jump[i]));
        if (!silent && promised && played.jump[i] > 0)
            verdict.broken.push_back(at + text("sigma does not cover %.1f cm", 100 * played.jump[i]));
        if (!frames[i].faulty) continue;
        ++verdict.statuses[isOk(result) && !silent ? "ok, named" : toString(result.status)];
        if (verdict.reason.empty()) verdict.reason = result.reason;
        if (expected == Expected::kTracked && !isOk(result))
            verdict.broken.push_back(at + "not tracked: " + result.reason);
        if (expected == Expected::kNamed && silent) verdict.broken.push_back(at + "not named");
    }
}

}  // namespace

Played play(const Recording& recording, const std::vector<Shown>& frames, const OdometryOptions& options) {
    Odometry odometry(recording.camera, options, frames.front().truth);
    Played played;
    for (const Shown& shown : frames) played.results.push_back(odometry.processFrame(shown.frame));
    played.trajectory = odometry.trajectory();
    jumps(frames, odometry, played);
    return played;
}

Verdict judge(const std::vector<Shown>& frames, const Played& played, const Played& clean, Expected expected,
              std::size_t count) {
    Verdict verdict;
    judgeFrames(frames, played, expected, verdict);
    verdict.ate = ateOf(frames, played.trajectory);
    verdict.clean_ate = ateOf(frames, clean.trajectory);
    if (count == 0 || count > kShort || expected == Expected::kSurvived) return verdict;
    std::size_t after = frames.size();
    while (after > 0 && !frames[after - 1].faulty) --after;
    if (after == frames.size()) return verdict;
    verdict.until_ok = -1;
    for (std::size_t i = after; i < frames.size() && verdict.until_ok < 0; ++i)
        if (isOk(played.results[i])) verdict.until_ok = static_cast<int>(i - after) + 1;
    if (verdict.until_ok < 0 || verdict.until_ok > kRecovery)
        verdict.broken.push_back(text("ok again after %.0f frames", verdict.until_ok));
    if (verdict.ate > kAteFactor * verdict.clean_ate + kAteFloor)
        verdict.broken.push_back(text("ATE %.2f cm, clean %.2f", 100 * verdict.ate, 100 * verdict.clean_ate));
    return verdict;
}

}  // namespace roevo::faults
