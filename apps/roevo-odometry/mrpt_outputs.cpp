#include "mrpt_outputs.h"

#include <mrpt/obs/CObservation3DRangeScan.h>

#include <filesystem>
#include <map>
#include <set>

#include "programs/interrupt.h"
#include "programs/output_folder.h"
#include "programs/program.h"
#include "roevo_mrpt/observation_converter.h"
#include "roevo_mrpt/pose_conversions.h"
#include "roevo_mrpt/posed_rawlog.h"
#include "roevo_mrpt/simple_map.h"

namespace roevo {
namespace {

RobotContext contextOf(const RunReport& report) {
    RobotContext context;
    for (const StampedPose& mount : report.camera_on_robot)
        context.mounts[mount.timestamp] = mount.T_world_camera;
    if (context.mounts.empty()) context.mounts[0] = sensorFromOptical();
    context.T_map_world = context.mounts.begin()->second;
    for (const FrameRecord& frame : report.frames)
        if (frame.result.hasPose()) context.covariances[frame.result.timestamp] = frame.result.covariance;
    return context;
}

/// Puts the images of the keyframes beside their edges.
void addImages(const RunSettings& settings, const RunReport& report, const RobotContext& context,
               mrpt::maps::CSimpleMap& map) {
    std::map<double, std::size_t> keyframes;
    for (std::size_t i = 0; i < report.keyframes.size(); ++i) keyframes[report.keyframes[i].timestamp] = i;
    const auto source = openSource(settings.input, settings.choice);
    for (SourceFrame frame; !keyframes.empty() && source->next(frame);) {
        InterruptGuard::check();
        const auto keyframe = keyframes.find(frame.timestamp);
        if (keyframe == keyframes.end() || !frame.fault.empty()) continue;
        auto scan = mrpt::obs::CObservation3DRangeScan::Create();
        *scan = toScan(frame.frame, report.camera, context.mountAt(frame.timestamp));
        std::next(map.begin(), keyframe->second)->sf->insert(scan);  // MRPT's versions differ in get()
        keyframes.erase(keyframe);
    }
}

std::vector<PosedScan> posedScans(const RunReport& report, const Odometry& odometry,
                                  const RobotContext& context) {
    std::vector<PosedScan> scans;
    for (std::size_t i = 0; i < report.trajectory.size(); ++i) {
        const auto& [timestamp, T_world_camera] = report.trajectory[i];
        PosedScan scan{timestamp, context.robotPose(timestamp, T_world_camera), {}};
        if (i > 0) {
            const StampedPose& before = report.trajectory[i - 1];
            const Matrix6d covariance = odometry.motionCovariance(i - 1, i);
            if (covariance.allFinite())  // the motion that leads from pose to pose, smoothed as these are
                scan.motion = robotMotion(before.T_world_camera.inverse() * T_world_camera, covariance,
                                          context.mountAt(before.timestamp), context.mountAt(timestamp));
        }
        scans.push_back(std::move(scan));
    }
    return scans;
}

}  // namespace

MrptOutputs::MrptOutputs(const RunSettings& settings, const FrameSource& source) : settings_(settings) {
    if (!settings.simple_map.empty()) simple_map_.emplace(settings.simple_map).stream();
    const std::string& rawlog = settings.rawlog_with_poses;
    if (rawlog.empty()) return;
    if (source.kind() != "rawlog")
        throw UsageError("--rawlog-with-poses is for rawlogs, and " + settings.input +
                         " is none: make one of it by rgbd2rawlog first, which gives the same poses");
    if (std::filesystem::path(rawlog).extension() != ".rawlog")
        throw UsageError("--rawlog-with-poses must end in .rawlog: " + rawlog);
    rawlog_.emplace(rawlog, source.camera());
}

void MrptOutputs::write(const RunReport& report, const Odometry& odometry) {
    if (!simple_map_ && !rawlog_) return;
    const RobotContext context = contextOf(report);
    if (simple_map_) {
        mrpt::maps::CSimpleMap map;
        buildSimpleMap(report.keyframes, odometry.keyframeEdges(), context, map);
        if (settings_.simple_map_images) addImages(settings_, report, context, map);
        saveSimpleMap(simple_map_->temporaryPath(), map);
    }
    if (rawlog_) {
        copyWithPoses(settings_.input, settings_.choice.sensor_label, posedScans(report, odometry, context),
                      *rawlog_);
        rawlog_->close();
    }
    written_ = true;
}

void MrptOutputs::commit() {
    if (!written_) return;
    if (simple_map_) simple_map_->commit();
    if (rawlog_) rawlog_->finish();
}

}  // namespace roevo
