#include "tracking/gauss_newton.h"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <algorithm>

#include "tracking/se3.h"

namespace roevo {
namespace {

/// -H^-1 g; zero when that is not usable.
template <int kSize>
Eigen::Matrix<double, kSize, 1> stepOf(const Eigen::Matrix<double, kSize, kSize>& H,
                                       const Eigen::Matrix<double, kSize, 1>& g) {
    using Step = Eigen::Matrix<double, kSize, 1>;
    const Eigen::LDLT<Eigen::Matrix<double, kSize, kSize>> factor(H);
    if (factor.info() != Eigen::Success || !factor.isPositive()) return Step::Zero();
    const Step step = -factor.solve(g);
    return step.allFinite() ? step : Step::Zero();
}

}  // namespace

kernels::InformationArrays InformationRows::arrays(std::size_t count) {
    const std::size_t padded = kernels::paddedSize(count);
    for (auto* array : {&points_.x, &points_.y, &points_.z}) array->resize(padded);
    kernels::InformationArrays out{points_.x.data(), points_.y.data(), points_.z.data(), {}, {}};
    for (int a = 0; a < 6; ++a) {
        matrix_[a].resize(padded);
        out.matrix[a] = matrix_[a].data();
    }
    for (int a = 0; a < 3; ++a) {
        vector_[a].resize(padded);
        out.vector[a] = vector_[a].data();
    }
    return out;
}

void InformationRows::scale(const std::vector<float>& factors) {
    const auto by = [&](std::vector<float>& array) {
        for (std::size_t i = 0; i < array.size(); ++i) array[i] *= factors[i];
    };
    for (auto& array : matrix_) by(array);
    for (auto& array : vector_) by(array);
}

kernels::NormalEquations InformationRows::sum() {
    kernels::NormalEquations equations;
    kernels::best().accumulate(arrays(points_.size()), points_.size(), equations);
    return equations;
}

void PoseSystem::add(const kernels::NormalEquations& part) {
    int k = 0;
    for (int r = 0; r < 6; ++r) {
        gradient[r] += part.gradient[r];
        for (int c = r; c < 6; ++c, ++k) {
            hessian(r, c) += part.hessian[k];
            if (c != r) hessian(c, r) += part.hessian[k];
        }
    }
}

PoseSystem PoseSystem::operator/(double times) const {
    return {hessian / times, gradient / times, readout_mixed / times, readout_hessian / times,
            readout_gradient / times};
}

Vector6d PoseSystem::solve() const {
    return stepOf(hessian, gradient);
}

Eigen::Matrix<double, 7, 1> PoseSystem::solveWithReadout() const {
    Eigen::Matrix<double, 7, 7> H;
    H << hessian, readout_mixed, readout_mixed.transpose(), readout_hessian;
    Eigen::Matrix<double, 7, 1> g;
    g << gradient, readout_gradient;
    return stepOf(H, g);
}

PriorTerm::PriorTerm(const PosePrior& prior)
    : mean_(prior.mean), errors_(prior.errors), information_(prior.weight * prior.covariance.inverse()) {}

bool PriorTerm::linearise(const Linearisation& at, PoseSystem& system) {
    system.hessian += information_;
    system.gradient += information_ * incrementOf(at.T_current_keyframe * mean_.inverse());
    return true;
}

bool DampingTerm::linearise(const Linearisation&, PoseSystem& system) {
    system.hessian.diagonal().head<3>().array() += 1 / (sigma_translation_ * sigma_translation_);
    system.hessian.diagonal().tail<3>().array() += 1 / (sigma_rotation_ * sigma_rotation_);
    return true;
}

GaussNewtonResult minimise(const Pose& T_start, RollingShutter shutter,
                           const std::vector<ResidualTerm*>& terms, const GaussNewtonOptions& options) {
    // Costs jump a little as robust scales are estimated anew; beyond the second factor it diverges
    constexpr double kAsGood = 1.02, kDiverging = 1.2, kCostFloor = 0.5;
    GaussNewtonResult result;
    result.T_current_keyframe = T_start;
    Pose T = T_start;
    for (int iteration = 0; iteration < options.max_iterations; ++iteration) {
        const Linearisation at{T, shutter.motion(T), iteration};
        PoseSystem system;
        result.complete = std::all_of(terms.begin(), terms.end(),
                                      [&](ResidualTerm* term) { return term->linearise(at, system); });
        if (!result.complete) break;
        const double cost = terms.front()->cost();
        if (options.keep_best && result.cost >= 0 && cost > kDiverging * result.cost + kCostFloor) break;
        if (!options.keep_best || result.cost < 0 || cost <= kAsGood * result.cost) {
            result.cost = result.cost < 0 ? cost : std::min(result.cost, cost);
            result.T_current_keyframe = T;
            terms.front()->keep();
        }
        result.system = system;
        result.iterations = iteration + 1;
        const double factor = iteration < options.relaxed_from ? 1 : options.relaxation;
        Vector6d step;
        if (options.free_readout) {
            const Eigen::Matrix<double, 7, 1> whole = factor * system.solveWithReadout();
            step = whole.head<6>();
            shutter.rows.seconds_per_row += whole[6];
        } else {
            step = factor * system.solve();
        }
        for (ResidualTerm* term : terms) term->update();
        T = poseIncrement(step) * T;
        const double motion =
            options.focal_length * (step.tail<3>().norm() + step.head<3>().norm() / options.depth);
        if (motion < options.still && iteration >= options.settled_from) break;
    }
    if (!options.keep_best) result.T_current_keyframe = T;
    result.seconds_per_row = shutter.rows.seconds_per_row;
    return result;
}

}  // namespace roevo
