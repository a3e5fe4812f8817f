#pragma once
#include <Eigen/Core>
#include <cmath>
#include <cstddef>
#include <vector>

#include "roevo/camera/pinhole_camera.h"
#include "roevo/types.h"
#include "tracking/points3.h"

namespace roevo {

/// Mean velocity of a camera over a motion.
struct Velocity {
    Eigen::Vector3d linear, turn;  ///< m/s, rad/s, along the axes of the camera at the end
};
/// @param T_begin_end  of the camera, over `seconds`
Velocity velocityOf(const Pose& T_begin_end, double seconds);

/// How the camera moves while the rows of one image are read, in its own frame.
struct RowMotion {
    Eigen::Vector3d velocity = Eigen::Vector3d::Zero();  ///< m/s
    Eigen::Vector3d turn = Eigen::Vector3d::Zero();      ///< rad/s
    double seconds_per_row = 0;                          ///< 0: all rows at once
    double reference_row = 0;                            ///< row at whose time the pose holds, px

    bool operator==(const RowMotion& other) const {
        return velocity == other.velocity && turn == other.turn && seconds_per_row == other.seconds_per_row &&
               reference_row == other.reference_row;
    }
    /// Whether anything is known of the motion.
    bool known() const { return !velocity.isZero(0) || !turn.isZero(0); }
    /// The same for a pyramid level, whose rows are 2^level as tall.
    RowMotion atPyramidLevel(int level) const;
    /// Velocity of a static point in the camera frame, m/s.
    Eigen::Vector3d pointVelocity(const Eigen::Vector3d& point) const {
        return -(velocity + turn.cross(point));
    }
    /// Where a point of the camera frame, seen on `row`, is at the time of the reference row.
    Eigen::Vector3d toReference(const Eigen::Vector3d& point, double row) const {
        return point - (row - reference_row) * seconds_per_row * pointVelocity(point);
    }
    /// The same motion with another read-out time.
    RowMotion at(double other_seconds_per_row) const {
        return {velocity, turn, other_seconds_per_row, reference_row};
    }
};

/// Moves the first `count` points, seen on these rows, which `from` brought to the reference row, to where
/// `to` would have brought them. A motion that would bring a point to the camera is none: such a point stays.
void exchangeMotion(const RowMotion& from, const RowMotion& to, const std::vector<float>& rows,
                    std::size_t count, Points3& points);

/// Images whose rows are read one after the other while the camera moves. The motion follows from the pose
/// itself and the previous frame's.
struct RollingShutter {
    /// How they are read, and the mean motion over the interval before the previous pose, in that camera's
    /// axes. Where there is no previous pose, the motion itself.
    RowMotion rows;
    double readout_sigma = 0;     ///< one sigma of rows.seconds_per_row, s
    double earlier_interval = 0;  ///< s, length of that; 0: not known
    Pose T_previous_keyframe = Pose::Identity();
    double since_previous = 0;  ///< s; 0 when there is no trusted previous pose
    /// Of a change of the velocity, along the camera's axes (linear, then turn): what is believed of it.
    Matrix6d gain = Matrix6d::Identity();
    /// Variance of the rows' velocity, by axis (linear, then turn), m^2/s^2 and rad^2/s^2.
    Vector6d velocity_variance = Vector6d::Zero();

    RowMotion motion(const Pose& T_current_keyframe) const;
    /// As long as the read-out time of a row may well be, s.
    double longReadout() const { return std::hypot(rows.seconds_per_row, readout_sigma); }
};

/// Rigid motion, camera and row motion for the kernels.
kernels::Projection makeProjection(const Pose& T_current_keyframe, const PinholeCamera& camera,
                                   const RowMotion& rows);

/// Moves padded points of a keyframe into a camera and projects them.
void project(const Points3& points, const Pose& T_current_keyframe, const PinholeCamera& camera,
             const RowMotion& rows, ProjectedPoints3& out);

}  // namespace roevo
