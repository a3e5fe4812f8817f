#include "tracking/readout_estimator.h"

#include <Eigen/Cholesky>
#include <cmath>

namespace roevo {

void ReadoutEstimator::add(const PoseSystem& evidence, double frames) {
    const Eigen::LDLT<Matrix6d> factor(evidence.hessian);
    if (factor.info() != Eigen::Success || !factor.isPositive()) return;
    const Vector6d eliminated = factor.solve(evidence.readout_mixed);
    const double information = evidence.readout_hessian - evidence.readout_mixed.dot(eliminated);
    const double gradient = evidence.readout_gradient - eliminated.dot(evidence.gradient);
    if (!(information > 0) || !std::isfinite(gradient)) return;
    const double kept = std::pow(memory_, frames);
    information_ = kept * information_ + information;
    vector_ = kept * vector_ - gradient;
}

double ReadoutEstimator::worth(const PoseSystem& evidence) const {
    const Eigen::LDLT<Matrix6d> factor(evidence.hessian);
    if (factor.info() != Eigen::Success || !factor.isPositive()) return 0;
    const Vector6d eliminated = factor.solve(evidence.readout_mixed);
    return (evidence.readout_hessian - evidence.readout_mixed.dot(eliminated)) / (prior_ + information_);
}

}  // namespace roevo
