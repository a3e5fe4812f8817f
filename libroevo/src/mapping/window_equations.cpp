#include "window_equations.h"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <Eigen/SparseCholesky>
#include <algorithm>
#include <cmath>
#include <limits>

#include "kernels/kernels.h"
#include "tracking/motion_blur.h"
#include "tracking/robust.h"
#include "tracking/se3.h"

namespace roevo {
namespace {

constexpr double kNoScale = 2.0;       ///< px of spread where nothing is seen
constexpr std::size_t kScaleStep = 3;  ///< every third point is enough for a median
constexpr std::int32_t kAnySlot = -1;
/// More are mostly empty along a way, but not in a room that keyframes see again and again.
constexpr int kDenseRows = 300;
constexpr double kMostlyFilled = 0.25;  ///< of the blocks: sparse equations take longer
/// Damping of a point's step along its edge, relative to the information across it: normals and slopes differ
/// by noise, and points that follow them slide. 1 and 0.001 are about as good.
constexpr double kDampingAlong = 0.1;
/// Of points that more keyframes see only some make the Hessian, and count for all: the work is the square.
constexpr std::size_t kManyViews = 32;
constexpr double kDamping = 1e-6;  ///< the same in all directions, for those in which nothing is known

}  // namespace

void WindowEquations::gather(const std::vector<WindowKeyframe>& window, const FusedEdges& edges) {
    points_.clear();
    edge_of_.clear();
    begin_.assign(1, 0);
    observations_.clear();
    std::vector<kernels::CameraMotion> motions;  // of each slot
    for (const WindowKeyframe& view : window)
        motions.push_back(cameraMotion(view.keyframe->row_motion, camera_, sensor_.blur_time));
    for (std::size_t edge = 0; edge < edges.views.size(); ++edge) {
        if (edges.verdicts[edge] != EdgeVerdict::kTrue) continue;
        const IndexRange own = edges.pointsOf(edge);
        for (std::size_t p = own.first; p < own.end; ++p) {
            const auto [first, end] = edges.observationsOf(p);
            if (end - first < 2) continue;
            for (std::size_t k = first; k < end; ++k) {
                const std::int32_t slot = edges.observations[k].slot;
                const MapKeyframe& keyframe = *at(window, slot).keyframe;
                const auto i = static_cast<std::size_t>(edges.observations[k].point);
                const double nx = keyframe.image.normal_x[i];
                const double ny = keyframe.image.normal_y[i];
                const double x = keyframe.image.x[i] - camera_.cx;
                const double y = keyframe.image.y[i] - camera_.cy;
                const float blur = blurVariance(at(motions, slot), keyframe.points.x[i], keyframe.points.y[i],
                                                keyframe.points.z[i], keyframe.image.normal_x[i],
                                                keyframe.image.normal_y[i]);
                const double trust = keyframe.weight[i] / (1 + blur);
                if (!(trust > 0)) continue;  // it would tell nothing, and of nothing nothing can be solved
                const double depth = keyframe.points.z[i];
                const double sigma = sensor_.depthSigma(depth);
                observations_.push_back({camera_.fx * nx, camera_.fy * ny, nx * x + ny * y, -camera_.fx * ny,
                                         camera_.fy * nx, nx * y - ny * x, depth, keyframe.slope[i], trust,
                                         1 / (sigma * sigma), slot});
            }
            if (observations_.size() == static_cast<std::size_t>(begin_.back())) continue;
            points_.push_back(static_cast<std::int32_t>(p));
            edge_of_.push_back(static_cast<std::int32_t>(edge));
            begin_.push_back(static_cast<std::int32_t>(observations_.size()));
        }
    }
    residuals_.resize(observations_.size());
    const std::size_t slots = window.size();
    origin_ = slots == 0 ? Eigen::Vector3d::Zero() : Eigen::Vector3d(window[0].T_world_camera.translation());
    rows_.assign(slots, -1);
    num_rows_ = 0;
    anchor_ = -1;
    for (std::size_t s = 0; s < slots; ++s) {
        if (window[s].fixed) {
            if (num_rows_ == 0) anchor_ = static_cast<int>(s);
            continue;
        }
        rows_[s] = num_rows_;
        num_rows_ += 6;
    }
    if (num_rows_ == 0) anchor_ = -1;  // nothing is held against it
    gradient.resize(num_rows_);
    point_blocks_.resize(slots);
    couplings_.resize(slots);
    throughs_.resize(slots);
    scales_.resize(slots);
    inliers.assign(slots, 0);
}

void WindowEquations::evaluate(const std::vector<WindowKeyframe>& window,
                               const std::vector<Eigen::Vector3d>& points, double least_scale) {
    for (std::size_t p = 0; p < points_.size(); ++p) {
        const Eigen::Vector3d& point = at(points, points_[p]);
        const auto [first, end] = rangeOf(begin_, p);
        for (std::size_t k = first; k < end; ++k) {
            const LineObservation& seen = observations_[k];
            const Pose& T = at(window, seen.slot).T_world_camera;
            const Eigen::Vector3d q = T.linear().transpose() * (point - T.translation());
            Residual& out = residuals_[k];
            if (!(q.z() > kNearestInView)) {
                out.inverse_z = -1;
                continue;
            }
            const double inverse = 1 / q.z();
            const double along = (seen.along_a * q.x() + seen.along_b * q.y()) * inverse - seen.along_c;
            out = {q.x(), q.y(), inverse,
                   (seen.across_a * q.x() + seen.across_b * q.y()) * inverse - seen.across_c,
                   q.z() - seen.depth - seen.slope * along};
        }
    }
    scale = spread(kAnySlot, least_scale);
    // Registered alone, a keyframe is judged by its own spread: keyframes that drifted together agree among
    // themselves long before they are back, and would else shut out those that did not
    for (std::size_t s = 0; s < scales_.size(); ++s)
        scales_[s] = options_.joint_refinement ? scale : spread(static_cast<std::int32_t>(s), least_scale);
}

double WindowEquations::spread(std::int32_t slot, double least_scale) {
    scratch_.clear();
    for (std::size_t p = 0; p < points_.size(); p += kScaleStep) {
        const auto [first, end] = rangeOf(begin_, p);
        for (std::size_t k = first; k < end; ++k) {
            if (residuals_[k].inverse_z < 0 || (slot != kAnySlot && observations_[k].slot != slot)) continue;
            scratch_.push_back(static_cast<float>(std::abs(residuals_[k].across)));
        }
    }
    return std::max(scratch_.empty() ? kNoScale : robustScale(scratch_), least_scale);
}

void WindowEquations::build(const std::vector<WindowKeyframe>& window, std::vector<Eigen::Vector3d>& points) {
    const auto block_rows = static_cast<std::size_t>(numBlockRows());
    blocks_.assign(num_rows_ == 0 ? 0 : block_rows * block_rows, Matrix6d::Zero());
    gradients_.assign(rows_.size(), Vector6d::Zero());
    edge_gradients_.assign(rows_.size(), Vector6d::Zero());
    pulls_.clear();
    inliers.assign(window.size(), 0);
    const std::size_t stride = 1 + points_.size() / hessian_points_;
    for (std::size_t p = 0; p < points_.size(); ++p) {
        int count = 0;
        touched_.clear();
        direction_.setZero();
        const auto [first, end] = rangeOf(begin_, p);
        for (std::size_t k = first; k < end; ++k) {
            if (residuals_[k].inverse_z < 0) continue;
            const auto slot = static_cast<std::size_t>(observations_[k].slot);
            if (!addObservation(observations_[k], residuals_[k], window[slot].T_world_camera.linear()))
                continue;
            ++inliers[slot];
            ++count;
        }
        const std::size_t every = std::max(stride, 1 + (touched_.size() - 1) / kManyViews);
        const auto counts_for = static_cast<double>(every) / static_cast<double>(stride);
        if (count >= 2) addPoint(at(points, points_[p]), p % every == 0 ? counts_for : 0);
        for (const std::int32_t slot : touched_) at(point_blocks_, slot).used = false;
        const bool last_of_edge = p + 1 == points_.size() || edge_of_[p + 1] != edge_of_[p];
        if (anchor_ >= 1 && last_of_edge) addPulls(edge_of_[p]);
    }
    if (stride > 1)  // as if all points had made it
        for (Matrix6d& block : blocks_) block *= static_cast<double>(stride);
    for (std::size_t a = 0; a < rows_.size(); ++a)
        if (rows_[a] >= 0) gradient.segment<6>(rows_[a]) = gradients_[a];
}

void WindowEquations::add(int slot, int other_slot, const Matrix6d& block) {
    if (row(slot) >= 0 && row(other_slot) >= 0) blocks_[blockOf(slot, other_slot)] += block;
}

void WindowEquations::addDamping(double damping) {
    for (std::size_t a = 0; a < rows_.size(); ++a)
        if (rows_[a] >= 0) blocks_[blockOf(a, a)].diagonal().array() += damping;
}

template <class Take>
void WindowEquations::eachBlock(const Take& take) const {
    for (std::size_t a = 0; a < rows_.size(); ++a)
        for (std::size_t c = a; c < rows_.size(); ++c)
            if (rows_[a] >= 0 && rows_[c] >= 0) take(rows_[a], rows_[c], blocks_[blockOf(a, c)]);
}

Eigen::MatrixXd WindowEquations::hessian() const {
    Eigen::MatrixXd dense(num_rows_, num_rows_);
    eachBlock([&](int row, int column, const Matrix6d& block) { dense.block<6, 6>(row, column) = block; });
    return dense;
}

Eigen::VectorXd WindowEquations::step() const {
    if (num_rows_ <= kDenseRows) return -hessian().selfadjointView<Eigen::Upper>().ldlt().solve(gradient);
    const auto filled =
        std::count_if(blocks_.begin(), blocks_.end(), [](const Matrix6d& b) { return !b.isZero(0); });
    const Eigen::VectorXd none =
        Eigen::VectorXd::Constant(num_rows_, std::numeric_limits<double>::quiet_NaN());
    if (static_cast<double>(filled) > kMostlyFilled * static_cast<double>(blocks_.size()) / 2) {
        Eigen::MatrixXd dense = hessian();
        const Eigen::LLT<Eigen::Ref<Eigen::MatrixXd>, Eigen::Upper> solver(dense);
        return solver.info() == Eigen::Success ? Eigen::VectorXd(-solver.solve(gradient)) : none;
    }
    std::vector<Eigen::Triplet<double>> entries;
    eachBlock([&](int row, int column, const Matrix6d& block) {
        if (block.isZero(0)) return;
        for (int i = 0; i < 6; ++i)
            for (int j = 0; j < 6; ++j) entries.emplace_back(row + i, column + j, block(i, j));
    });
    Eigen::SparseMatrix<double> sparse(num_rows_, num_rows_);
    sparse.setFromTriplets(entries.begin(), entries.end());
    const Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>, Eigen::Upper> solver(sparse);
    return solver.info() == Eigen::Success ? Eigen::VectorXd(-solver.solve(gradient)) : none;
}

bool WindowEquations::addObservation(const LineObservation& seen, const Residual& residual,
                                     const Eigen::Matrix3d& R) {
    const double spread = at(scales_, seen.slot);
    const double variance = spread * spread, squared = residual.across * residual.across;
    if (squared > options_.chi2 * variance) return false;
    InformationBlock& block = at(point_blocks_, seen.slot);
    if (!block.used) {
        block.used = true;
        block.information.setZero();
        block.gradient.setZero();
        touched_.push_back(seen.slot);
    }
    const double z = residual.inverse_z;
    const double weight = studentWeight(seen.weight, squared, variance);
    const Eigen::Vector3d across =
        R * Eigen::Vector3d(z * seen.across_a, z * seen.across_b, -z * (residual.across + seen.across_c));
    const Eigen::Vector3d weighted = weight * across;
    block.information.noalias() += weighted * across.transpose();
    block.gradient += residual.across * weighted;
    const double depth_squared = residual.depth * residual.depth * seen.depth_information;
    if (!(depth_squared <= options_.depth_chi2)) return true;
    const double slope = seen.slope * z;
    const double along = (seen.along_a * residual.x + seen.along_b * residual.y) * z;
    const Eigen::Vector3d depth =
        R * Eigen::Vector3d(-slope * seen.along_a, -slope * seen.along_b, 1 + slope * along);
    const double depth_weight =
        studentWeight(options_.depth_weight * seen.weight * seen.depth_information, depth_squared);
    const Eigen::Vector3d weighted_depth = depth_weight * depth;
    block.information.noalias() += weighted_depth * depth.transpose();
    block.gradient += residual.depth * weighted_depth;
    direction_ += weighted.cross(depth);
    return true;
}

void WindowEquations::addPoint(Eigen::Vector3d& point, double hessian_weight) {
    Eigen::Matrix3d information = Eigen::Matrix3d::Zero();
    Eigen::Vector3d point_gradient = Eigen::Vector3d::Zero();
    for (const std::int32_t slot : touched_) {
        information += at(point_blocks_, slot).information;
        point_gradient += at(point_blocks_, slot).gradient;
    }
    const double trace = information.trace(), length = direction_.squaredNorm();
    information.diagonal().array() += kDamping * trace;
    if (length > 0)
        information.noalias() += (kDampingAlong * trace / length * direction_) * direction_.transpose();
    const Eigen::Matrix3d inverse = information.inverse();
    const Eigen::Vector3d step = -inverse * point_gradient;
    point += step;
    for (const std::int32_t slot : touched_) {
        const auto s = static_cast<std::size_t>(slot);
        if (rows_[s] < 0) continue;
        const Eigen::Vector3d b = point_blocks_[s].gradient + point_blocks_[s].information * step;
        Vector6d pull;
        pull << b, (point - origin_).cross(b);
        gradients_[s] -= pull;
        if (anchor_ >= 1) edge_gradients_[s] -= pull;  // else nobody asks
    }
    if (hessian_weight > 0) addToHessian(point, inverse, hessian_weight);
}

void WindowEquations::addPulls(std::int32_t edge) {
    for (std::size_t s = 0; s < edge_gradients_.size(); ++s) {
        if (edge_gradients_[s].isZero(0)) continue;
        pulls_.push_back({edge, static_cast<std::int32_t>(s), edge_gradients_[s]});
        edge_gradients_[s].setZero();
    }
}

void WindowEquations::addToHessian(const Eigen::Vector3d& point, const Eigen::Matrix3d& inverse,
                                   double weight) {
    std::sort(touched_.begin(), touched_.end());
    const Eigen::Matrix3d P = skew(point - origin_);
    hessian_rows_.clear();
    for (const std::int32_t slot : touched_) {
        if (!isInHessian(slot)) continue;
        const Eigen::Matrix3d information = weight * at(point_blocks_, slot).information;
        Coupling& coupling = couplings_[hessian_rows_.size()];
        coupling.topRows<3>() = information;
        coupling.bottomRows<3>().noalias() = P * information;
        throughs_[hessian_rows_.size()].noalias() = coupling * (inverse / weight);
        hessian_rows_.push_back(blockRow(slot));
        Matrix6d& diagonal = blocks_[blockOf(slot, slot)];
        diagonal.leftCols<3>() += coupling;
        diagonal.rightCols<3>().noalias() -= coupling * P;
    }
    if (!options_.joint_refinement || hessian_rows_.empty()) return;
    kernels::best().eliminatePoint(couplings_[0].data(), throughs_[0].data(), hessian_rows_.data(),
                                   static_cast<int>(hessian_rows_.size()), numBlockRows(), blocks_[0].data());
}

}  // namespace roevo
