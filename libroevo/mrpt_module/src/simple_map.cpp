#include "roevo_mrpt/simple_map.h"

#include <mrpt/maps/CColouredPointsMap.h>
#include <mrpt/obs/CObservationPointCloud.h>
#include <mrpt/obs/CSensoryFrame.h>
#include <mrpt/poses/CPose3DPDFGaussian.h>

#include <stdexcept>

#include "coloured_points.h"
#include "gz_file.h"
#include "roevo_mrpt/pose_conversions.h"
#include "roevo_mrpt/time_conversions.h"
#include "tracking/relative_pose.h"
#include "whole_file.h"

namespace roevo {
namespace {

constexpr int kGzLevel = 1;  // as the rawlogs'; more makes it much slower and hardly smaller

Matrix6d turned(const Matrix6d& covariance, const Eigen::Matrix3d& R) {
    return turnedBy(R) * covariance * turnedBy(R).transpose();
}

}  // namespace

const Pose& RobotContext::mountAt(double timestamp) const {
    if (mounts.empty()) throw std::logic_error("RobotContext: there is no mount of the camera on the robot");
    auto after = mounts.upper_bound(timestamp);
    if (after != mounts.begin()) --after;
    return after->second;
}

mrpt::Clock::time_point RobotContext::stampOf(double timestamp) const {
    const auto known = stamps.find(timestamp);
    return known == stamps.end() ? toMrptTime(timestamp) : known->second;
}

mrpt::poses::CPose3DPDFGaussian RobotContext::robotPose(double timestamp, const Pose& T_world_camera) const {
    const auto known = covariances.find(timestamp);
    const Matrix6d covariance = known == covariances.end() ? Matrix6d(Matrix6d::Zero()) : known->second;
    return toMrptGaussian(T_map_world * T_world_camera, turned(covariance, T_map_world.linear()),
                          mountAt(timestamp).inverse());
}

mrpt::poses::CPose3DPDFGaussian robotMotion(const Pose& T_from_to, const Matrix6d& covariance,
                                            const Pose& mount_from, const Pose& mount_to) {
    const Pose T_robot_to = mount_from * T_from_to;
    if (!covariance.allFinite()) {  // no motion is known; infinity turned would be no number
        const mrpt::poses::CPose3D mean = toMrpt(T_robot_to * mount_to.inverse());
        return {mean, mrpt::math::CMatrixDouble66(covariance)};
    }
    return toMrptGaussian(T_robot_to, turned(covariance, T_robot_to.linear()), mount_to.inverse());
}

void buildSimpleMap(const std::vector<KeyframeInfo>& keyframes, const EdgeMap& keyframe_edges,
                    const RobotContext& context, mrpt::maps::CSimpleMap& out) {
    out.clear();
    for (const KeyframeInfo& keyframe : keyframes) {
        auto cloud = mrpt::obs::CObservationPointCloud::Create();
        cloud->timestamp = context.stampOf(keyframe.timestamp);
        cloud->sensorLabel = "roevo_edges";
        cloud->sensorPose = toMrpt(context.mountAt(keyframe.timestamp) * sensorFromOptical().inverse());
        auto points = mrpt::maps::CColouredPointsMap::Create();
        const Pose T_sensor_world = sensorFromOptical() * keyframe.T_world_camera.inverse();
        for (const MapEdge& edge : keyframe_edges)
            if (edge.keyframe_id == keyframe.id) appendEdge(*points, edge, T_sensor_world);
        cloud->pointcloud = points;
        const auto frame = mrpt::obs::CSensoryFrame::Create();
        frame->insert(cloud);
        out.insert(mrpt::poses::CPose3DPDFGaussian::Create(
                       context.robotPose(keyframe.timestamp, keyframe.T_world_camera)),
                   frame);
    }
}

void saveSimpleMap(const std::string& file, const mrpt::maps::CSimpleMap& map) {
    writeWholeFile(file, [&](const std::string& temporary) {
        GzFile out;
        return out.open(temporary, kGzLevel) && out.write(map) && out.close();
    });
}

}  // namespace roevo
