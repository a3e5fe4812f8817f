#include <Eigen/Cholesky>

#include "roevo/tracking/fine_tracker.h"
#include "roevo/tracking/se3.h"

namespace roevo {
namespace {

/// How much less the evidence of one frame counts for the read-out time: its velocity is only known from two
/// poses.
constexpr double kCaution = 100;
/// Share of what is known that a frame must add to be worth its time.
constexpr double kLeastWorth = 0.01;
constexpr int kIterations = 5;
constexpr double kOverRelaxation = 1.6;  ///< as in tracking: associations follow
constexpr double kFreedom = 0.005;       ///< s, one sigma, of the read-out time in these iterations

}  // namespace

FineTracker::ReadoutEquations FineTracker::readoutEquations(const Keyframe& keyframe,
                                                            const Pose& T_current_keyframe,
                                                            const RowMotion& rows,
                                                            const FineFrame& frame) const {
    ReadoutEquations sums;
    for (std::size_t k = 0; k < matches_.size(); ++k) {
        if (weight_[k] <= 0) continue;
        const auto i = static_cast<std::size_t>(matches_.reference[k]);
        const auto p = static_cast<std::size_t>(matches_.current[k]);
        const double a = frame.camera->fx / static_cast<double>(z_[i]),
                     b = frame.camera->fy / static_cast<double>(z_[i]);
        const Eigen::Vector3d point(x_[i], y_[i], z_[i]);
        const Eigen::Vector2d normal(frame.edges->normal_x[p], frame.edges->normal_y[p]);
        const Eigen::Vector3d by_point(
            a * normal.x(), b * normal.y(),
            -(a * normal.x() * point.x() + b * normal.y() * point.y()) / point.z());
        const Eigen::Vector3d in_keyframe(keyframe.edges.x[i], keyframe.edges.y[i], keyframe.edges.z[i]);
        const double by_current =
            by_point.dot(rows.pointVelocity(point)) * (static_cast<double>(v_[i]) - rows.reference_row);
        const double by_keyframe =
            -by_point.dot(T_current_keyframe.linear() * keyframe.row_motion.pointVelocity(in_keyframe)) *
            (static_cast<double>(keyframe.edges.image.y[i]) - rows.reference_row);
        const double by_readout = by_current + by_keyframe;
        // As it would be with no read-out time
        const double residual = static_cast<double>(residual_[k]) - by_readout * rows.seconds_per_row;
        Vector6d by_pose;
        by_pose << by_point, point.cross(by_point);
        const double weight = static_cast<double>(weight_[k]) / kCaution;
        sums.hessian += weight * by_pose * by_pose.transpose();
        sums.mixed += weight * by_readout * by_pose;
        sums.gradient += weight * residual * by_pose;
        sums.own += weight * by_readout * by_readout;
        sums.own_gradient += weight * by_readout * residual;
    }
    return sums;
}

void FineTracker::addReadoutEvidence(const Keyframe& keyframe, const Pose& T_current_keyframe,
                                     const RollingShutter& shutter, const FineFrame& frame,
                                     ReadoutEstimator& estimator) {
    const EdgePoints3D& edges = keyframe.edges;
    const double start = shutter.seconds_per_row;
    Pose pose = T_current_keyframe;
    RollingShutter now = shutter;
    const auto toReadout = [&] {
        moved_x_ = edges.x;
        moved_y_ = edges.y;
        moved_z_ = edges.z;
        exchangeMotion(keyframe.row_motion, keyframe.row_motion.at(now.seconds_per_row), edges.image.y,
                       edges.size(), moved_x_, moved_y_, moved_z_);
        const RowMotion rows = now.motion(pose);
        project(moved_x_, moved_y_, moved_z_, pose, *frame.camera, rows);
        associateProjected(keyframe, frame, pose, options_.final_radius);
        geometricResiduals(keyframe, frame, rows);
        weigh(keyframe);
        return readoutEquations(keyframe, pose, rows, frame);
    };
    ReadoutEquations sums = readoutEquations(keyframe, pose, now.motion(pose), frame);
    if (estimator.worth(sums.hessian, sums.mixed, sums.own) < kLeastWorth) return;
    const double freedom = kFreedom / frame.camera->height;
    for (int iteration = 0; iteration < kIterations; ++iteration) {
        Eigen::Matrix<double, 7, 7> hessian;
        hessian << sums.hessian, sums.mixed, sums.mixed.transpose(),
            sums.own + 1 / (kCaution * freedom * freedom);
        Eigen::Matrix<double, 7, 1> gradient;
        gradient << sums.gradient + sums.mixed * now.seconds_per_row,
            sums.own_gradient + sums.own * now.seconds_per_row +
                (now.seconds_per_row - start) / (kCaution * freedom * freedom);
        const Eigen::Matrix<double, 7, 1> step = -kOverRelaxation * hessian.ldlt().solve(gradient);
        if (!step.allFinite()) return;
        pose = poseIncrement(step.head<6>()) * pose;
        now.seconds_per_row += step[6];
        sums = toReadout();
        if (inliers_ < options_.min_inliers) return;
    }
    estimator.add(sums.hessian, sums.mixed, sums.own, sums.gradient, sums.own_gradient);
}

}  // namespace roevo
