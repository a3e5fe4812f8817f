#include "odometry/motion_smoother.h"

#include <Eigen/Cholesky>
#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "tracking/relative_pose.h"
#include "tracking/robust.h"
#include "tracking/se3.h"

namespace roevo {
namespace {

constexpr double kExactPosition = 1e-5, kExactTurn = 3e-6;  // m, rad: one sigma of what is exact
constexpr double kFirstVelocity = 2;                        // m/s, rad/s: one sigma
constexpr double kUsualNoise = 0.1;                         // m^2/s^3, rad^2/s^3: where to begin
constexpr double kFineStep = 1.75;                          // factor to which it is learned
constexpr double kLeastNoise = 1e-7, kMostNoise = 1e3, kLeastJitter = 1e-3;
constexpr int kRounds = 3;  // of learning how heavy the tails are

using Vector12d = Eigen::Matrix<double, 12, 1>;
using Matrix12d = Eigen::Matrix<double, 12, 12>;

/// Position and orientation, summed up along the world's axes from sample to sample, and their velocity.
struct State {
    Vector12d mean = Vector12d::Zero();
    Matrix12d covariance = Matrix12d::Zero();
};

class MotionSmoother {
  public:
    explicit MotionSmoother(std::vector<MotionSample> samples);
    /// By how much each sample is to be moved, along the world's axes.
    std::vector<Vector6d> corrections();

  private:
    double filter();
    void smooth();
    void learnNoise(double factor);
    void learnTails();
    Matrix12d transition(std::size_t k) const;

    std::vector<MotionSample> samples_;
    std::vector<Vector6d> poses_;        ///< as measured
    std::vector<Matrix6d> covariances_;  ///< of these
    std::vector<double> tails_;          ///< factor of the noise in the time before each sample
    std::array<double, 2> noise_{kUsualNoise, kUsualNoise};  ///< m^2/s^3, rad^2/s^3
    /// Share of the covariances of positions and of orientations: the rest is common to neighbours.
    std::array<double, 2> jitter_{1, 1};
    std::vector<State> predicted_, updated_;
    std::vector<Vector12d> smoothed_;
};

MotionSmoother::MotionSmoother(std::vector<MotionSample> samples)
    : samples_(std::move(samples)), tails_(samples_.size(), 1) {
    Vector6d exact = Vector6d::Constant(kExactPosition * kExactPosition);
    exact.tail<3>().setConstant(kExactTurn * kExactTurn);
    Vector6d sum = Vector6d::Zero();
    for (std::size_t k = 0; k < samples_.size(); ++k) {
        const Pose& T = samples_[k].T_world_camera;
        if (k > 0) {
            const Pose& before = samples_[k - 1].T_world_camera;
            const Eigen::AngleAxisd turn(Eigen::Matrix3d(T.linear() * before.linear().transpose()));
            sum.head<3>() += T.translation() - before.translation();
            sum.tail<3>() += turn.angle() * turn.axis();
        }
        const Matrix6d to_world = turnedBy(T.linear());
        poses_.push_back(sum);
        covariances_.push_back(to_world * samples_[k].covariance * to_world.transpose());
        covariances_.back().diagonal() += exact;
    }
    predicted_.resize(samples_.size());
    updated_.resize(samples_.size());
    smoothed_.resize(samples_.size());
}

Matrix12d MotionSmoother::transition(std::size_t k) const {
    Matrix12d F = Matrix12d::Identity();
    F.topRightCorner<6, 6>().diagonal().setConstant(samples_[k].timestamp - samples_[k - 1].timestamp);
    return F;
}

/// @return logarithm of the likelihood of all poses, but for a constant
double MotionSmoother::filter() {
    State state;
    state.covariance.diagonal().head<6>().setOnes();
    state.covariance.diagonal().tail<6>().setConstant(kFirstVelocity * kFirstVelocity);
    Vector6d jitter;
    jitter << Eigen::Vector3d::Constant(std::sqrt(jitter_[0])),
        Eigen::Vector3d::Constant(std::sqrt(jitter_[1]));
    double likelihood = 0;
    for (std::size_t k = 0; k < samples_.size(); ++k) {
        if (k > 0) {
            const double dt = samples_[k].timestamp - samples_[k - 1].timestamp;
            state.mean.head<6>() += dt * state.mean.tail<6>();
            auto pose = state.covariance.topLeftCorner<6, 6>();
            auto mixed = state.covariance.topRightCorner<6, 6>();
            auto velocity = state.covariance.bottomRightCorner<6, 6>();
            pose += dt * (mixed + mixed.transpose()) + dt * dt * velocity;
            mixed += dt * velocity;
            for (int i = 0; i < 6; ++i) {
                const double noise = noise_[i < 3 ? 0 : 1] * tails_[k];
                pose(i, i) += noise * dt * dt * dt / 3;
                mixed(i, i) += noise * dt * dt / 2;
                velocity(i, i) += noise * dt;
            }
            state.covariance.bottomLeftCorner<6, 6>() = mixed.transpose();
        }
        predicted_[k] = state;
        if (samples_[k].measured) {
            const Vector6d error = poses_[k] - state.mean.head<6>();
            const Eigen::LDLT<Matrix6d> factor(state.covariance.topLeftCorner<6, 6>() +
                                               jitter.asDiagonal() * covariances_[k] * jitter.asDiagonal());
            likelihood -= (error.dot(factor.solve(error)) + factor.vectorD().array().log().sum()) / 2;
            const Eigen::Matrix<double, 12, 6> gain = factor.solve(state.covariance.topRows<6>()).transpose();
            state.mean += gain * error;
            state.covariance -= (gain * state.covariance.topRows<6>()).eval();
            state.covariance = (state.covariance + state.covariance.transpose()).eval() / 2;
        }
        updated_[k] = state;
    }
    return likelihood;
}

void MotionSmoother::smooth() {
    smoothed_.back() = updated_.back().mean;
    for (std::size_t k = samples_.size() - 1; k-- > 0;) {
        const Matrix12d gain =
            predicted_[k + 1].covariance.ldlt().solve(transition(k + 1) * updated_[k].covariance).transpose();
        smoothed_[k] = updated_[k].mean + gain * (smoothed_[k + 1] - predicted_[k + 1].mean);
    }
}

/// Of accelerations, linear and angular, and the share of jitter, in steps of this factor as long as poses
/// become likelier.
void MotionSmoother::learnNoise(double factor) {
    double best = filter();
    const auto improve = [&](double& value, double least, double most) {
        for (const double by : {factor, 1 / factor}) {
            const double before = std::exchange(value, std::clamp(value * by, least, most));
            const double likelihood = value == before ? best : filter();
            if (likelihood > best) {
                best = likelihood;
                return true;
            }
            value = before;
        }
        return false;
    };
    for (bool better = true; better;) {
        better = false;
        for (double& share : jitter_) better = improve(share, kLeastJitter, 1) || better;
        for (double& noise : noise_) better = improve(noise, kLeastNoise, kMostNoise) || better;
    }
    filter();
}

/// Where the velocity changed more than elsewhere, the noise was stronger.
void MotionSmoother::learnTails() {
    smooth();
    for (std::size_t k = 1; k < samples_.size(); ++k) {
        const double dt = samples_[k].timestamp - samples_[k - 1].timestamp;
        const Vector12d change = smoothed_[k] - transition(k) * smoothed_[k - 1];
        double squared = 0;
        for (int i = 0; i < 6; ++i) {
            // By the inverse of the noise's covariance
            const double moved = change[i] / dt, faster = change[i + 6];
            squared += (12 * moved * moved - 12 * moved * faster + 4 * faster * faster) /
                       (noise_[i < 3 ? 0 : 1] * dt);
        }
        tails_[k] = (kStudentNu + squared) / (kStudentNu + 12);
    }
}

std::vector<Vector6d> MotionSmoother::corrections() {
    for (const double factor : {10., 3., kFineStep}) learnNoise(factor);
    for (int round = 0; round < kRounds; ++round) {
        learnTails();
        learnNoise(kFineStep);
    }
    smooth();
    std::vector<Vector6d> corrections;
    for (std::size_t k = 0; k < samples_.size(); ++k)
        corrections.push_back(smoothed_[k].head<6>() - poses_[k]);
    return corrections;
}

/// Of a piece of a motion without a long gap.
void smoothPiece(std::vector<MotionSample>::iterator first, std::vector<MotionSample>::iterator end) {
    if (end - first < 3) return;
    for (const Vector6d& correction : MotionSmoother({first, end}).corrections()) {
        MotionSample& sample = *first++;
        const bool exact = sample.measured && sample.covariance.isZero(0);
        if (exact || !correction.allFinite()) continue;
        Pose& pose = sample.T_world_camera;
        pose.setRotation(poseIncrement(correction).rotation() * pose.rotation());
        pose.translation() += correction.head<3>();
    }
}

}  // namespace

void bridgeMotion(std::vector<MotionSample>& samples) {
    auto last = samples.begin();
    for (auto next = samples.begin(); next != samples.end(); ++next) {
        if (!next->measured) continue;
        const double duration = next->timestamp - last->timestamp;
        for (auto between = last + 1; between < next; ++between)
            between->T_world_camera = interpolate(last->T_world_camera, next->T_world_camera,
                                                  (between->timestamp - last->timestamp) / duration);
        last = next;
    }
}

void smoothMotion(std::vector<MotionSample>& samples) {
    bridgeMotion(samples);  // what follows is to first order
    auto piece = samples.begin(), last = piece;
    for (auto next = samples.begin(); next != samples.end(); ++next) {
        if (!next->measured) continue;
        if (next->timestamp - last->timestamp > kLongestGap) {
            smoothPiece(piece, last + 1);
            piece = next;
        }
        last = next;
    }
    if (!samples.empty()) smoothPiece(piece, last + 1);
}

}  // namespace roevo
