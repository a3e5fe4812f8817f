#include "tracking/rolling_shutter.h"

#include <Eigen/Geometry>

namespace roevo {

Velocity velocityOf(const Pose& T_begin_end, double seconds) {
    const Eigen::AngleAxisd turn(T_begin_end.linear());
    return {T_begin_end.linear().transpose() * T_begin_end.translation() / seconds,
            turn.angle() / seconds * turn.axis()};
}

RowMotion RowMotion::atPyramidLevel(int level) const {
    const double scale = 1 << level;
    return {velocity, turn, seconds_per_row * scale, (reference_row + 0.5) / scale - 0.5};
}

namespace {

kernels::RowSpeed speedOf(const RowMotion& motion) {
    kernels::RowSpeed speed{};
    for (int k = 0; k < 3; ++k) {
        speed.velocity[k] = static_cast<float>(motion.seconds_per_row * motion.velocity[k]);
        speed.turn[k] = static_cast<float>(motion.seconds_per_row * motion.turn[k]);
    }
    speed.reference_row = static_cast<float>(motion.reference_row);
    return speed;
}

}  // namespace

void exchangeMotion(const RowMotion& from, const RowMotion& to, const std::vector<float>& rows,
                    std::size_t count, Points3& points) {
    kernels::best().exchangeMotion(speedOf(from), speedOf(to), rows.data(), count, points.x.data(),
                                   points.y.data(), points.z.data());
}

RowMotion RollingShutter::motion(const Pose& T_current_keyframe) const {
    if (since_previous <= 0) return rows;
    const Pose T_previous_current = T_previous_keyframe * T_current_keyframe.inverse();
    const Velocity mean = velocityOf(T_previous_current, since_previous);
    if (earlier_interval <= 0) return {mean.linear, mean.turn, rows.seconds_per_row, rows.reference_row};
    // Means of two intervals, half of the way on to the end of the last one. All the way, the poses of a
    // camera whose edges all lie in the rows that are read first swing ever wider: there, what a pose
    // turns too far a velocity that follows from it takes back
    const double ahead = 0.5 * since_previous / (since_previous + earlier_interval);
    Vector6d now, earlier;
    now << mean.linear, mean.turn;
    earlier << T_previous_current.linear().transpose() * rows.velocity, rows.turn;
    const Vector6d believed = earlier + gain * ((1 + ahead) * (now - earlier));
    return {believed.head<3>(), believed.tail<3>(), rows.seconds_per_row, rows.reference_row};
}

kernels::Projection makeProjection(const Pose& T, const PinholeCamera& camera, const RowMotion& rows) {
    kernels::Projection projection{};
    for (int r = 0; r < 3; ++r) {
        for (int c = 0; c < 3; ++c) projection.rotation[3 * r + c] = static_cast<float>(T.linear()(r, c));
        projection.translation[r] = static_cast<float>(T.translation()[r]);
    }
    projection.fx = static_cast<float>(camera.fx);
    projection.fy = static_cast<float>(camera.fy);
    projection.cx = static_cast<float>(camera.cx);
    projection.cy = static_cast<float>(camera.cy);
    projection.rows = speedOf(rows);
    projection.last_row = static_cast<float>(camera.height - 1);
    return projection;
}

void project(const Points3& points, const Pose& T_current_keyframe, const PinholeCamera& camera,
             const RowMotion& rows, ProjectedPoints3& out) {
    const std::size_t padded = points.size();
    for (auto* array : {&out.x, &out.y, &out.z, &out.u, &out.v}) array->resize(padded);
    kernels::best().project(makeProjection(T_current_keyframe, camera, rows), points.x.data(),
                            points.y.data(), points.z.data(), padded,
                            {out.x.data(), out.y.data(), out.z.data(), out.u.data(), out.v.data()});
}

}  // namespace roevo
