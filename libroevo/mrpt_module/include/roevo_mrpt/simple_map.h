#pragma once
#include <mrpt/core/Clock.h>
#include <mrpt/maps/CSimpleMap.h>

#include <map>
#include <string>
#include <vector>

#include "roevo/edge_map.h"
#include "roevo/frame_result.h"

namespace roevo {

/// What MRPT wants to know of keyframes beside themselves.
struct RobotContext {
    Pose T_map_world = Pose::Identity();  ///< from the odometry's world into the map's, which has z up
    std::map<double, Pose> mounts;        ///< T_robot_camera (optical axes) from this time on; one at least
    std::map<double, mrpt::Clock::time_point> stamps;  ///< MRPT's, which count 100 ns; may lack some
    std::map<double, Matrix6d> covariances;  ///< FrameResult::covariance by stamp; where there is none: zero

    /// The last before, or else the first. @throws std::logic_error where there is none
    const Pose& mountAt(double timestamp) const;

    /// MRPT's own stamp where it is known, else that of whole microseconds.
    mrpt::Clock::time_point stampOf(double timestamp) const;

    /// The robot's pose with its covariance, given the camera's in the odometry's world. @throws as mountAt()
    mrpt::poses::CPose3DPDFGaussian robotPose(double timestamp, const Pose& T_world_camera) const;
};

/// A motion of the camera as one of the robot that carries it.
/// @param covariance       of it, as Odometry::motionCovariance(): along the axes of the second camera
/// @param mount_from, mount_to  T_robot_camera before and after it
mrpt::poses::CPose3DPDFGaussian robotMotion(const Pose& T_from_to, const Matrix6d& covariance,
                                            const Pose& mount_from, const Pose& mount_to);

/// Keyframes as MRPT keeps them: the robot's pose in the map, and the edges that the keyframe saw
/// (pseudo-edges, too) as a CObservationPointCloud of a CColouredPointsMap.
/// @param keyframe_edges  Odometry::keyframeEdges(): those of other keyframes are left out
/// @param out             what was in it before is gone
void buildSimpleMap(const std::vector<KeyframeInfo>& keyframes, const EdgeMap& keyframe_edges,
                    const RobotContext& context, mrpt::maps::CSimpleMap& out);

/// Writes a .simplemap file. @throws std::runtime_error when not all of it could be written
void saveSimpleMap(const std::string& file, const mrpt::maps::CSimpleMap& map);

}  // namespace roevo
