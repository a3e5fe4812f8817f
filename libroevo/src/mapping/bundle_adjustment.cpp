#include "roevo/mapping/bundle_adjustment.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "roevo/tracking/fine_tracker.h"
#include "roevo/tracking/se3.h"

namespace roevo {
namespace {

constexpr double kMinScale = 0.1, kMaxScale = 2.0;  ///< px
constexpr double kStudentNu = 5;         ///< degrees of freedom of the t-distribution that residuals follow
constexpr double kLeastVariance = 1e-6;  ///< m^2 of depth: a millimetre, whatever the sensor
constexpr double kNearest = 0.05;        ///< m; nearer points cannot be projected
constexpr double kFarOff = 100;          ///< px, for a point that cannot be projected
constexpr double kLookShare = 0.7;       ///< a keyframe looks at an edge when so much of it is in its image
constexpr double kSeeShare = 0.3;        ///< and sees it when so much of that is observed
constexpr double kFrameEvidence = 3;     ///< keyframes that all frames since a keyframe count as
constexpr std::size_t kScaleStep = 3;    ///< every so manieth point is enough for a median
constexpr double kStill = 0.005;         ///< px of image motion; smaller steps end the refinement

double studentWeight(double squared) {
    return (kStudentNu + 1) / (kStudentNu + squared);
}

/// Along the edge next to nothing is known, and what there is comes from normals that differ by noise. While
/// poses move, a little of the known directions' information holds a point: more would hold the poses back.
/// Where only points are fitted they keep their place along the edge, or they would slide.
void holdAlongEdge(Eigen::Matrix3d& information, bool firmly) {
    if (!firmly) {
        information.diagonal().array() += 1e-6 * information.trace();
        return;
    }
    Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> directions;
    directions.computeDirect(information);
    const Eigen::Vector3d least = directions.eigenvectors().col(0);
    information += (information.trace() * least) * least.transpose();
}

}  // namespace

/// An observation's part in the normal equations, in the world's axes: information A and gradient b of the
/// fused point. The pose's part follows, because moving the camera is moving the point the other way:
/// with G = [I; [P]x], H_pose = G A G^T, H_pose,point = -G A, g_pose = -G b.
struct BundleAdjuster::Term {
    Eigen::Matrix3d information = Eigen::Matrix3d::Zero();
    Eigen::Vector3d gradient = Eigen::Vector3d::Zero();
    bool inlier = false;
};

double BundleAdjuster::tangentResidual(const MapKeyframe& keyframe, std::size_t i,
                                       const Eigen::Vector3d& in_camera) const {
    const Eigen::Vector2d pixel = camera_.project(in_camera);
    return static_cast<double>(keyframe.image.normal_x[i]) *
               (pixel.x() - static_cast<double>(keyframe.image.x[i])) +
           static_cast<double>(keyframe.image.normal_y[i]) *
               (pixel.y() - static_cast<double>(keyframe.image.y[i]));  // Eq. (7)
}

BundleAdjuster::Term BundleAdjuster::linearise(const WindowKeyframe& view, std::size_t i,
                                               const Eigen::Vector3d& world) const {
    Term term;
    const MapKeyframe& keyframe = *view.keyframe;
    const Eigen::Matrix3d& R = view.T_world_camera.linear();
    const Eigen::Vector3d q = R.transpose() * (world - view.T_world_camera.translation());
    const auto measured = static_cast<double>(keyframe.z[i]);
    if (!(q.z() > kNearest)) return term;
    const double inverse = 1 / q.z();
    const auto nx = static_cast<double>(keyframe.image.normal_x[i]);
    const auto ny = static_cast<double>(keyframe.image.normal_y[i]);
    const double residual = tangentResidual(keyframe, i, q);
    const double squared = residual * residual / (scale_ * scale_);
    const auto trust = static_cast<double>(keyframe.weight[i]);
    if (squared > options_.chi2) return term;
    term.inlier = true;
    const double a0 = camera_.fx * nx * inverse, a1 = camera_.fy * ny * inverse;
    const Eigen::Vector3d across = R * Eigen::Vector3d(a0, a1, -(a0 * q.x() + a1 * q.y()) * inverse);
    const double w = trust * studentWeight(squared) / (scale_ * scale_);
    term.information.noalias() = (w * across) * across.transpose();
    term.gradient = (w * residual) * across;
    const double sigma = sensor_.depth_noise * measured * measured;
    const double variance = sigma * sigma + kLeastVariance;
    const double depth_residual = q.z() - measured;
    const double depth_squared = depth_residual * depth_residual / variance;
    if (depth_squared <= options_.depth_chi2) {
        const Eigen::Vector3d along = R.col(2);
        const double v = options_.depth_weight * trust * studentWeight(depth_squared) / variance;
        term.information.noalias() += (v * along) * along.transpose();
        term.gradient += (v * depth_residual) * along;
    }
    return term;
}

double BundleAdjuster::estimateScale(const std::vector<WindowKeyframe>& window, const FusedEdges& edges) {
    scratch_.clear();
    for (int e = 0; e < edges.numEdges(); ++e) {
        const auto edge = static_cast<std::size_t>(e);
        if (edges.verdicts[edge] != EdgeVerdict::kTrue) continue;
        for (auto p = static_cast<std::size_t>(edges.begin[edge]);
             p < static_cast<std::size_t>(edges.begin[edge + 1]); p += kScaleStep) {
            const auto first = static_cast<std::size_t>(edges.observation_begin[p]);
            const auto end = static_cast<std::size_t>(edges.observation_begin[p + 1]);
            if (end - first < 2) continue;
            for (std::size_t k = first; k < end; ++k) {
                const Observation& seen = edges.observations[k];
                const WindowKeyframe& view = window[static_cast<std::size_t>(seen.slot)];
                const auto i = static_cast<std::size_t>(seen.point);
                const Eigen::Vector3d q = view.T_world_camera.linear().transpose() *
                                          (edges.points[p] - view.T_world_camera.translation());
                if (!(q.z() > kNearest)) continue;
                scratch_.push_back(static_cast<float>(std::abs(tangentResidual(*view.keyframe, i, q))));
            }
        }
    }
    if (scratch_.empty()) return kMaxScale;
    const auto middle = scratch_.begin() + static_cast<std::ptrdiff_t>(scratch_.size() / 2);
    std::nth_element(scratch_.begin(), middle, scratch_.end());
    return std::clamp(1.4826 * static_cast<double>(*middle), kMinScale, kMaxScale);
}

RefinementResult BundleAdjuster::refine(std::vector<WindowKeyframe>& window, FusedEdges& edges,
                                        const std::vector<RelativePrior>& priors, int iterations,
                                        double first_scale) {
    RefinementResult result;
    const std::size_t slots = window.size();
    std::vector<int> column(slots, -1);
    int columns = 0;
    for (std::size_t s = 0; s < slots; ++s) {
        if (!window[s].fixed) {
            column[s] = columns;
            columns += 6;
        }
    }
    Eigen::MatrixXd hessian(columns, columns);
    Eigen::VectorXd gradient(columns);
    std::vector<Term> terms;
    std::vector<std::size_t> term_slots;
    for (int iteration = 0; iteration < iterations; ++iteration) {
        // Wide at first where old and new keyframes may have drifted apart
        scale_ = std::max(estimateScale(window, edges), first_scale / (1 << std::min(iteration, 10)));
        hessian.setZero();
        gradient.setZero();
        result.inliers.assign(slots, 0);
        for (int e = 0; e < edges.numEdges(); ++e) {
            const auto edge = static_cast<std::size_t>(e);
            if (edges.verdicts[edge] != EdgeVerdict::kTrue) continue;
            for (auto p = static_cast<std::size_t>(edges.begin[edge]);
                 p < static_cast<std::size_t>(edges.begin[edge + 1]); ++p) {
                const auto first = static_cast<std::size_t>(edges.observation_begin[p]);
                const auto end = static_cast<std::size_t>(edges.observation_begin[p + 1]);
                if (end - first < 2) continue;
                terms.clear();
                term_slots.clear();
                Eigen::Matrix3d sum = Eigen::Matrix3d::Zero();
                Eigen::Vector3d total = Eigen::Vector3d::Zero();
                for (std::size_t k = first; k < end; ++k) {
                    const auto slot = static_cast<std::size_t>(edges.observations[k].slot);
                    const Term term = linearise(
                        window[slot], static_cast<std::size_t>(edges.observations[k].point), edges.points[p]);
                    if (!term.inlier) continue;
                    ++result.inliers[slot];
                    sum += term.information;
                    total += term.gradient;
                    terms.push_back(term);
                    term_slots.push_back(slot);
                }
                if (terms.size() < 2) continue;
                holdAlongEdge(sum, columns == 0);
                const Eigen::Matrix3d inverse = sum.inverse();
                const Eigen::Vector3d step = -inverse * total;  // edge fitting, the inner problem of Eq. (18)
                edges.points[p] += step;
                const Eigen::Matrix3d P = skew(edges.points[p]);
                for (std::size_t a = 0; a < terms.size(); ++a) {
                    const int row = column[term_slots[a]];
                    if (row < 0) continue;
                    const Eigen::Vector3d b = terms[a].gradient + terms[a].information * step;
                    gradient.segment<3>(row) -= b;
                    gradient.segment<3>(row + 3) -= P * b;
                    const Eigen::Matrix3d through = terms[a].information * inverse;
                    for (std::size_t c = 0; c < terms.size(); ++c) {
                        const int col = column[term_slots[c]];
                        if (col < row) continue;  // upper triangle, and what is not fixed
                        if (a != c && !options_.joint_refinement) continue;
                        Eigen::Matrix3d M = Eigen::Matrix3d::Zero();
                        if (a == c) M = terms[a].information;
                        if (options_.joint_refinement) M -= through * terms[c].information;
                        const Eigen::Matrix3d PM = P * M;
                        hessian.block<3, 3>(row, col) += M;
                        hessian.block<3, 3>(row, col + 3) -= M * P;
                        hessian.block<3, 3>(row + 3, col) += PM;
                        hessian.block<3, 3>(row + 3, col + 3) -= PM * P;
                    }
                }
            }
        }
        if (columns == 0) continue;  // all poses are fixed: only the points are fitted
        hessian /= kCorrelatedPoints;
        gradient /= kCorrelatedPoints;
        for (const RelativePrior& prior : priors) {
            // Error of T_world_to against T_world_from * T_from_to, as a perturbation in the world's axes
            const auto from = static_cast<std::size_t>(prior.from), to = static_cast<std::size_t>(prior.to);
            const Pose expected = window[from].T_world_camera * prior.T_from_to;
            const Eigen::Matrix3d turned = window[to].T_world_camera.linear() * expected.linear().transpose();
            const Eigen::AngleAxisd angle(turned);
            // Perturbations are world-left, xi = (t, phi) with x <- exp(phi) x + t; the camera's centre moves
            // by t + phi x centre
            Vector6d error;
            error << window[to].T_world_camera.translation() - expected.translation(),
                angle.angle() * angle.axis();
            Matrix6d to_centre = Matrix6d::Identity();
            to_centre.topRightCorner<3, 3>() = -skew(window[to].T_world_camera.translation());
            const Matrix6d own = to_centre.transpose() * prior.information * to_centre;
            const Vector6d pull = to_centre.transpose() * prior.information * error;
            const int row = column[from], col = column[to];
            if (col >= 0) {
                hessian.block<6, 6>(col, col) += own;
                gradient.segment<6>(col) += pull;
            }
            if (row >= 0) {
                hessian.block<6, 6>(row, row) += own;
                gradient.segment<6>(row) -= pull;
            }
            if (row >= 0 && col >= 0) hessian.block<6, 6>(std::min(row, col), std::max(row, col)) -= own;
        }
        hessian.diagonal().array() += 1e-6;
        const Eigen::VectorXd step = -hessian.selfadjointView<Eigen::Upper>().ldlt().solve(gradient);
        if (!step.allFinite()) break;
        ++result.iterations;
        result.last_step = 0;
        for (std::size_t s = 0; s < slots; ++s) {
            if (column[s] < 0) continue;
            const Vector6d xi = step.segment<6>(column[s]);
            const Pose before = window[s].T_world_camera;
            window[s].T_world_camera = poseIncrement(xi) * before;
            orthonormalise(window[s].T_world_camera);
            const double moved = (window[s].T_world_camera.translation() - before.translation()).norm() /
                                     std::max(0.1, window[s].keyframe->median_depth) +
                                 xi.tail<3>().norm();
            result.last_step = std::max(result.last_step, camera_.fx * moved);
        }
        if (result.last_step < kStill) break;
    }
    result.scale = scale_;
    return result;
}

double BundleAdjuster::spreadOf(const std::vector<WindowKeyframe>& window, const FusedEdges& edges,
                                std::size_t p) const {
    const auto first = static_cast<std::size_t>(edges.observation_begin[p]);
    const auto end = static_cast<std::size_t>(edges.observation_begin[p + 1]);
    double sum = 0;
    for (std::size_t k = first; k < end; ++k) {
        const WindowKeyframe& view = window[static_cast<std::size_t>(edges.observations[k].slot)];
        const auto i = static_cast<std::size_t>(edges.observations[k].point);
        const Eigen::Vector3d q =
            view.T_world_camera.linear().transpose() * (edges.points[p] - view.T_world_camera.translation());
        const double residual = q.z() > kNearest ? tangentResidual(*view.keyframe, i, q) : kFarOff;
        sum += residual * residual;
    }
    return std::sqrt(sum / static_cast<double>(end - first - 1));
}

std::pair<int, int> BundleAdjuster::countLooks(const std::vector<WindowKeyframe>& window,
                                               const FusedEdges& edges, std::size_t edge) const {
    constexpr double kMargin = 5;
    const auto first = static_cast<std::size_t>(edges.begin[edge]);
    const auto end = static_cast<std::size_t>(edges.begin[edge + 1]);
    int looked = 0, seen = 0;
    for (std::size_t slot = 0; slot < window.size(); ++slot) {
        const WindowKeyframe& view = window[slot];
        int inside = 0, observed = 0;
        for (std::size_t p = first; p < end; ++p) {
            const Eigen::Vector3d q = view.T_world_camera.linear().transpose() *
                                      (edges.points[p] - view.T_world_camera.translation());
            if (!(q.z() > sensor_.min_depth)) continue;
            const Eigen::Vector2d pixel = camera_.project(q);
            if (pixel.x() < kMargin || pixel.y() < kMargin || pixel.x() > camera_.width - 1 - kMargin ||
                pixel.y() > camera_.height - 1 - kMargin) {
                continue;
            }
            ++inside;
            const auto from = edges.observations.begin() + edges.observation_begin[p];
            const auto to = edges.observations.begin() + edges.observation_begin[p + 1];
            observed += std::any_of(from, to,
                                    [&](const Observation& observation) {
                                        return observation.slot == static_cast<std::int32_t>(slot);
                                    })
                            ? 1
                            : 0;
        }
        if (inside < kLookShare * static_cast<double>(end - first)) continue;
        ++looked;
        seen += observed >= kSeeShare * inside ? 1 : 0;
    }
    return {looked, seen};
}

void BundleAdjuster::judge(const std::vector<WindowKeyframe>& window, FusedEdges& edges) const {
    std::vector<double> spreads;
    for (int e = 0; e < edges.numEdges(); ++e) {
        const auto edge = static_cast<std::size_t>(e);
        EdgeVerdict& verdict = edges.verdicts[edge];
        verdict = edges.views[edge] > 1 ? EdgeVerdict::kTrue : EdgeVerdict::kUnconfirmed;
        spreads.clear();
        for (auto p = static_cast<std::size_t>(edges.begin[edge]);
             p < static_cast<std::size_t>(edges.begin[edge + 1]); ++p) {
            if (edges.observation_begin[p + 1] - edges.observation_begin[p] < 2) continue;
            spreads.push_back(spreadOf(window, edges, p));
        }
        if (!spreads.empty()) {
            const auto middle = spreads.begin() + static_cast<std::ptrdiff_t>(spreads.size() / 2);
            std::nth_element(spreads.begin(), middle, spreads.end());
            if (*middle > options_.max_spread * scale_) {
                verdict = EdgeVerdict::kSpread;
                continue;
            }
        }
        // The keyframe in which an edge was found first proves nothing
        const auto [looked, seen] = countLooks(window, edges, edge);
        const double found = foundShare(window, edges, edge);
        const double frames = found < 0 ? 0 : kFrameEvidence;
        const double evidence = looked - 1 + frames;
        if (evidence < options_.min_looks - 1) continue;
        if (seen - 1 + frames * found < options_.min_seen * evidence) verdict = EdgeVerdict::kVanishing;
    }
}

double BundleAdjuster::foundShare(const std::vector<WindowKeyframe>& window, const FusedEdges& edges,
                                  std::size_t edge) const {
    double sum = 0;
    int count = 0;
    for (auto k =
             static_cast<std::size_t>(edges.observation_begin[static_cast<std::size_t>(edges.begin[edge])]);
         k <
         static_cast<std::size_t>(edges.observation_begin[static_cast<std::size_t>(edges.begin[edge + 1])]);
         ++k) {
        const MapKeyframe& keyframe = *window[static_cast<std::size_t>(edges.observations[k].slot)].keyframe;
        const std::int32_t own =
            keyframe.image.edge_of[static_cast<std::size_t>(edges.observations[k].point)];
        const float found = keyframe.found[static_cast<std::size_t>(own)];
        if (found < 0) continue;
        sum += static_cast<double>(found);
        ++count;
    }
    return count > 0 ? sum / count : -1;
}

}  // namespace roevo
