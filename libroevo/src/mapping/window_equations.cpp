#include "window_equations.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

namespace roevo {
namespace {

constexpr double kMinScale = 0.1, kMaxScale = 2.0;  ///< px
constexpr double kStudentNu = 5;         ///< degrees of freedom of the t-distribution that residuals follow
constexpr double kLeastVariance = 1e-6;  ///< m^2 of depth: a millimetre, whatever the sensor
constexpr double kNearest = 0.05;        ///< m; nearer points cannot be projected
constexpr std::size_t kScaleStep = 3;    ///< every so manieth point is enough for a median
constexpr std::int32_t kAnySlot = -1;
/// Of a point along its edge, as a share of what is known across: normals and slopes differ by noise, and
/// points that follow them slide. 1 and 0.001 are about as good.
constexpr double kHold = 0.1;
constexpr double kWeakHold = 1e-6;  ///< of a point in directions in which nothing is known

double studentWeight(double squared) {
    return (kStudentNu + 1) / (kStudentNu + squared);
}

}  // namespace

void WindowEquations::gather(const std::vector<WindowKeyframe>& window, const FusedEdges& edges) {
    points_.clear();
    begin_.assign(1, 0);
    sights_.clear();
    for (int e = 0; e < edges.numEdges(); ++e) {
        const auto edge = static_cast<std::size_t>(e);
        if (edges.verdicts[edge] != EdgeVerdict::kTrue) continue;
        for (std::int32_t p = edges.begin[edge]; p < edges.begin[edge + 1]; ++p) {
            const auto first = static_cast<std::size_t>(edges.observation_begin[static_cast<std::size_t>(p)]);
            const auto end =
                static_cast<std::size_t>(edges.observation_begin[static_cast<std::size_t>(p) + 1]);
            if (end - first < 2) continue;
            for (std::size_t k = first; k < end; ++k) {
                const std::int32_t slot = edges.observations[k].slot;
                const MapKeyframe& keyframe = *window[static_cast<std::size_t>(slot)].keyframe;
                const auto i = static_cast<std::size_t>(edges.observations[k].point);
                const auto nx = static_cast<double>(keyframe.image.normal_x[i]);
                const auto ny = static_cast<double>(keyframe.image.normal_y[i]);
                const double x = static_cast<double>(keyframe.image.x[i]) - camera_.cx;
                const double y = static_cast<double>(keyframe.image.y[i]) - camera_.cy;
                const auto trust = static_cast<double>(keyframe.weight[i]);
                const auto depth = static_cast<double>(keyframe.z[i]);
                const double sigma = sensor_.depth_noise * depth * depth;
                sights_.push_back({camera_.fx * nx, camera_.fy * ny, nx * x + ny * y, -camera_.fx * ny,
                                   camera_.fy * nx, nx * y - ny * x, depth,
                                   static_cast<double>(keyframe.slope[i]), trust,
                                   1 / (sigma * sigma + kLeastVariance), slot});
            }
            points_.push_back(p);
            begin_.push_back(static_cast<std::int32_t>(sights_.size()));
        }
    }
    residuals_.resize(sights_.size());
    const std::size_t slots = window.size();
    rows_.assign(slots, -1);
    num_rows_ = 0;
    for (std::size_t s = 0; s < slots; ++s) {
        if (window[s].fixed) continue;
        rows_[s] = num_rows_;
        num_rows_ += 6;
    }
    hessian.resize(num_rows_, num_rows_);
    gradient.resize(num_rows_);
    blocks_.resize(slots * slots);
    gradients_.resize(slots);
    couplings_.resize(slots);
    scales_.resize(slots);
}

void WindowEquations::evaluate(const std::vector<WindowKeyframe>& window,
                               const std::vector<Eigen::Vector3d>& points, double least_scale) {
    for (std::size_t p = 0; p < points_.size(); ++p) {
        const Eigen::Vector3d& point = points[static_cast<std::size_t>(points_[p])];
        for (auto k = static_cast<std::size_t>(begin_[p]); k < static_cast<std::size_t>(begin_[p + 1]); ++k) {
            const Sight& sight = sights_[k];
            const Pose& T = window[static_cast<std::size_t>(sight.slot)].T_world_camera;
            const Eigen::Vector3d q = T.linear().transpose() * (point - T.translation());
            Residual& out = residuals_[k];
            if (!(q.z() > kNearest)) {
                out.inverse_z = -1;
                continue;
            }
            const double inverse = 1 / q.z();
            const double along = (sight.along_a * q.x() + sight.along_b * q.y()) * inverse - sight.along_c;
            out = {q.x(), q.y(), inverse,
                   (sight.across_a * q.x() + sight.across_b * q.y()) * inverse - sight.across_c,
                   q.z() - sight.depth - sight.slope * along};
        }
    }
    spreads(least_scale);
}

void WindowEquations::spreads(double least_scale) {
    // Registered alone, a keyframe is judged by its own spread: keyframes that drifted together agree among
    // themselves long before they are back, and would else shut out those that did not
    if (!options_.joint_refinement) {
        for (std::size_t s = 0; s < scales_.size(); ++s)
            scales_[s] = spread(static_cast<std::int32_t>(s), least_scale);
    }
    scale = spread(kAnySlot, least_scale);
    if (options_.joint_refinement) std::fill(scales_.begin(), scales_.end(), scale);
}

double WindowEquations::spread(std::int32_t slot, double least_scale) {
    scratch_.clear();
    for (std::size_t p = 0; p < points_.size(); p += kScaleStep) {
        for (auto k = static_cast<std::size_t>(begin_[p]); k < static_cast<std::size_t>(begin_[p + 1]); ++k) {
            if (residuals_[k].inverse_z < 0 || (slot != kAnySlot && sights_[k].slot != slot)) continue;
            scratch_.push_back(static_cast<float>(std::abs(residuals_[k].across)));
        }
    }
    if (scratch_.empty()) return kMaxScale;
    const auto middle = scratch_.begin() + static_cast<std::ptrdiff_t>(scratch_.size() / 2);
    std::nth_element(scratch_.begin(), middle, scratch_.end());
    return std::max(std::clamp(1.4826 * static_cast<double>(*middle), kMinScale, kMaxScale), least_scale);
}

bool WindowEquations::linearise(const Sight& sight, const Residual& residual, const Eigen::Matrix3d& R,
                                Term& term) const {
    const double spread = scales_[static_cast<std::size_t>(sight.slot)];
    const double squared = residual.across * residual.across / (spread * spread);
    if (squared > options_.chi2) return false;
    const double z = residual.inverse_z;
    const double root = std::sqrt(sight.weight * studentWeight(squared)) / spread;
    term.slot = sight.slot;
    term.across_residual = root * residual.across;
    term.across.noalias() = R * Eigen::Vector3d(root * z * sight.across_a, root * z * sight.across_b,
                                                -root * z * (residual.across + sight.across_c));
    const double depth_squared = residual.depth * residual.depth * sight.depth_information;
    if (!(depth_squared <= options_.depth_chi2)) {
        term.depth.setZero();
        term.depth_residual = 0;
        return true;
    }
    const double depth_root = std::sqrt(options_.depth_weight * sight.weight * sight.depth_information *
                                        studentWeight(depth_squared));
    const double slope = sight.slope * z;
    const double along = (sight.along_a * residual.x + sight.along_b * residual.y) * z;
    term.depth_residual = depth_root * residual.depth;
    term.depth.noalias() =
        R * Eigen::Vector3d(-depth_root * slope * sight.along_a, -depth_root * slope * sight.along_b,
                            depth_root * (1 + slope * along));
    return true;
}

void WindowEquations::build(const std::vector<WindowKeyframe>& window, std::vector<Eigen::Vector3d>& points) {
    for (auto& entry : blocks_) entry.setZero();
    for (auto& entry : gradients_) entry.setZero();
    for (auto& entry : couplings_) entry.setZero();
    inliers.assign(window.size(), 0);
    for (std::size_t p = 0; p < points_.size(); ++p) {
        terms_.clear();
        for (auto k = static_cast<std::size_t>(begin_[p]); k < static_cast<std::size_t>(begin_[p + 1]); ++k) {
            if (residuals_[k].inverse_z < 0) continue;
            const auto slot = static_cast<std::size_t>(sights_[k].slot);
            Term term;
            if (!linearise(sights_[k], residuals_[k], window[slot].T_world_camera.linear(), term)) continue;
            ++inliers[slot];
            terms_.push_back(term);
        }
        if (terms_.size() >= 2) addPoint(points[static_cast<std::size_t>(points_[p])]);
    }
    for (std::size_t a = 0; a < rows_.size(); ++a) {
        if (rows_[a] < 0) continue;
        gradient.segment<6>(rows_[a]) = gradients_[a];
        for (std::size_t c = a; c < rows_.size(); ++c) {
            if (rows_[c] >= 0) hessian.block<6, 6>(rows_[a], rows_[c]) = block(a, c);
        }
    }
}

void WindowEquations::addPoint(Eigen::Vector3d& point) {
    Eigen::Matrix3d information = Eigen::Matrix3d::Zero();
    Eigen::Vector3d pull = Eigen::Vector3d::Zero(), direction = Eigen::Vector3d::Zero();
    for (const Term& term : terms_) {
        information.noalias() += term.across * term.across.transpose();
        information.noalias() += term.depth * term.depth.transpose();
        pull += term.across_residual * term.across + term.depth_residual * term.depth;
        direction += term.across.cross(term.depth);
    }
    const double trace = information.trace(), length = direction.norm();
    information.diagonal().array() += kWeakHold * trace;
    if (length > 0)
        information.noalias() += (kHold * trace / (length * length) * direction) * direction.transpose();
    const Eigen::LLT<Eigen::Matrix3d> root(information);
    const Eigen::Vector3d step = -root.solve(pull);
    // The camera turns about the world's origin: the Jacobian of a pose is [I; [P]x] times the point's
    point += step;
    touched_.clear();
    for (const Term& term : terms_) {
        const auto slot = static_cast<std::size_t>(term.slot);
        if (rows_[slot] < 0) continue;
        Vector6 across, depth;
        across << term.across, point.cross(term.across);
        depth << term.depth, point.cross(term.depth);
        gradients_[slot] -= (term.across_residual + term.across.dot(step)) * across +
                            (term.depth_residual + term.depth.dot(step)) * depth;
        auto& own = block(slot, slot);
        own.noalias() += across * across.transpose();
        own.noalias() += depth * depth.transpose();
        if (!options_.joint_refinement) continue;
        if (std::find(touched_.begin(), touched_.end(), term.slot) == touched_.end())
            touched_.push_back(term.slot);
        const Eigen::Vector3d k_across = root.matrixL().solve(term.across);
        const Eigen::Vector3d k_depth = root.matrixL().solve(term.depth);
        couplings_[slot].noalias() += across * k_across.transpose();
        couplings_[slot].noalias() += depth * k_depth.transpose();
    }
    std::sort(touched_.begin(), touched_.end());
    for (std::size_t a = 0; a < touched_.size(); ++a) {
        const Coupling& first = couplings_[static_cast<std::size_t>(touched_[a])];
        for (std::size_t c = a; c < touched_.size(); ++c) {
            block(static_cast<std::size_t>(touched_[a]), static_cast<std::size_t>(touched_[c])).noalias() -=
                first * couplings_[static_cast<std::size_t>(touched_[c])].transpose();
        }
    }
    for (const std::int32_t slot : touched_) couplings_[static_cast<std::size_t>(slot)].setZero();
}

}  // namespace roevo
