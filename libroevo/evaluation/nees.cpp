#include "evaluation/nees.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <utility>

#include "evaluation/association.h"
#include "tracking/se3.h"

namespace roevo {
namespace {

constexpr double kChiSquare95 = 12.591587;  // of six degrees of freedom

using Block = Eigen::Matrix3d;

/// Of the true motion, as the errors of its two ends make it, along the axes of the second camera.
Matrix6d covarianceOfTruth(const Pose& T_from_to, const TruthNoise& noise) {
    const double position = noise.position * noise.position;
    const double orientation = noise.orientation * noise.orientation;
    // What the first camera's orientation does to the second one's position
    const Block lever = -skew(T_from_to.linear().transpose() * T_from_to.translation());
    Matrix6d covariance = Matrix6d::Zero();
    covariance.topLeftCorner<3, 3>() =
        2 * position * Block::Identity() + orientation * lever * lever.transpose();
    covariance.bottomRightCorner<3, 3>() = 2 * orientation * Block::Identity();
    covariance.topRightCorner<3, 3>() = orientation * lever;
    covariance.bottomLeftCorner<3, 3>() = orientation * lever.transpose();
    return covariance;
}

/// None where the matrix is not positive definite.
template <int N>
std::optional<double> normalised(const Eigen::Matrix<double, N, 1>& error,
                                 const Eigen::Matrix<double, N, N>& covariance) {
    const Eigen::LLT<Eigen::Matrix<double, N, N>> decomposed(covariance);
    if (decomposed.info() != Eigen::Success) return std::nullopt;
    const double nees = error.dot(decomposed.solve(error)) / N;
    return std::isfinite(nees) ? std::make_optional(nees) : std::nullopt;
}

}  // namespace

std::optional<JudgedMotion> judgeMotion(const Pose& truth, const Pose& estimate, const Matrix6d& covariance,
                                        const TruthNoise& noise) {
    const Matrix6d whole = covariance + covarianceOfTruth(truth, noise);
    if (!whole.allFinite()) return std::nullopt;
    const Pose difference = truth.inverse() * estimate;
    const Vector6d error = incrementOf(difference);
    const Eigen::Vector3d error_t = error.head<3>(), error_r = error.tail<3>();
    const Block covariance_t = whole.topLeftCorner<3, 3>(), covariance_r = whole.bottomRightCorner<3, 3>();
    const auto all = normalised<6>(error, whole);
    const auto translation = normalised<3>(error_t, covariance_t);
    const auto rotation = normalised<3>(error_r, covariance_r);
    if (!all || !translation || !rotation) return std::nullopt;
    return JudgedMotion{*all,
                        *translation,
                        *rotation,
                        error_t.norm(),
                        error_r.norm(),
                        std::sqrt(covariance_t.trace()),
                        std::sqrt(covariance_r.trace())};
}

NeesStatistics neesStatistics(const std::vector<JudgedMotion>& motions) {
    NeesStatistics statistics;
    statistics.count = motions.size();
    if (motions.empty()) return statistics;
    const auto count = static_cast<double>(motions.size());
    const auto mean = [&](double JudgedMotion::*figure) {
        double sum = 0;
        for (const JudgedMotion& motion : motions) sum += motion.*figure;
        return sum / count;
    };
    const auto rootMeanSquare = [&](double JudgedMotion::*figure) {
        double sum = 0;
        for (const JudgedMotion& motion : motions) sum += motion.*figure * (motion.*figure);
        return std::sqrt(sum / count);
    };
    for (const auto figure :
         {&JudgedMotion::nees, &JudgedMotion::nees_translation, &JudgedMotion::nees_rotation})
        statistics.mean.*figure = mean(figure);
    for (const auto figure : {&JudgedMotion::error_translation, &JudgedMotion::error_rotation,
                              &JudgedMotion::sigma_translation, &JudgedMotion::sigma_rotation})
        statistics.mean.*figure = rootMeanSquare(figure);
    const auto inside = std::count_if(motions.begin(), motions.end(), [](const JudgedMotion& motion) {
        return 6 * motion.nees <= kChiSquare95;
    });
    statistics.inside = static_cast<double>(inside) / count;
    return statistics;
}

MotionJudge::MotionJudge(std::vector<StampedPose> truth, const TruthNoise& noise,
                         const std::vector<double>& intervals)
    : truth_(std::move(truth)), noise_(noise) {
    for (const double interval : intervals) judged_.push_back({interval, {}, 0});
}

void MotionJudge::add(double timestamp, const Motion& motionBetween) {
    const std::size_t place = added_++;
    const std::optional<Pose> truth = poseAt(truth_, timestamp);
    if (!truth) return;
    entries_.push_back({place, timestamp, *truth});
    for (Judged& judged : judged_) {
        const Entry* const from = startOf(judged.interval);
        if (from == nullptr) continue;
        const auto [T_from_to, covariance] = motionBetween(from->place, place);
        const auto motion = judgeMotion(from->truth.inverse() * *truth, T_from_to, covariance, noise_);
        if (motion)
            judged.motions.push_back(*motion);
        else
            ++judged.unknown;
    }
}

const MotionJudge::Entry* MotionJudge::startOf(double interval) const {
    const auto newest = entries_.end() - 1;
    if (newest == entries_.begin()) return nullptr;
    if (interval == 0) return &entries_.front();
    const double wanted = newest->timestamp - interval;
    const auto later =
        std::lower_bound(entries_.begin(), newest, wanted,
                         [](const Entry& entry, double time) { return entry.timestamp < time; });
    const auto away = [&](auto entry) { return std::abs(entry->timestamp - wanted); };
    const auto nearest =
        later != entries_.begin() && (later == newest || away(later - 1) <= away(later)) ? later - 1 : later;
    return away(nearest) <= kIntervalTolerance * interval ? &*nearest : nullptr;
}

}  // namespace roevo
