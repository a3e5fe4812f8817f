#include "tracking/readout_estimator.h"

#include <Eigen/Cholesky>
#include <cmath>
#include <utility>

namespace roevo {
namespace {

/// Information and gradient that the pose leaves to the read-out time; none where it is not known itself.
std::pair<double, double> withoutPose(const PoseSystem& evidence) {
    const Eigen::LDLT<Matrix6d> factor(evidence.hessian);
    if (factor.info() != Eigen::Success || !factor.isPositive()) return {};
    const Vector6d eliminated = factor.solve(evidence.readout_mixed);
    return {evidence.readout_hessian - evidence.readout_mixed.dot(eliminated),
            evidence.readout_gradient - eliminated.dot(evidence.gradient)};
}

}  // namespace

void ReadoutEstimator::add(const PoseSystem& evidence, double frames) {
    const auto [information, gradient] = withoutPose(evidence);
    if (!(information > 0) || !std::isfinite(gradient)) return;
    const double kept = std::pow(memory_, frames);
    information_ = kept * information_ + information;
    vector_ = kept * vector_ - gradient;
}

double ReadoutEstimator::worth(const PoseSystem& evidence) const {
    return withoutPose(evidence).first / (prior_ + information_);
}

}  // namespace roevo
