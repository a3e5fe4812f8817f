#include "roevo_mrpt/posed_rawlog.h"

#include <mrpt/obs/CActionCollection.h>
#include <mrpt/obs/CActionRobotMovement3D.h>
#include <mrpt/obs/CObservation3DRangeScan.h>
#include <mrpt/obs/CObservationRobotPose.h>
#include <mrpt/obs/CSensoryFrame.h>

#include <map>

#include "roevo_mrpt/rawlog_reader.h"
#include "roevo_mrpt/rawlog_writer.h"
#include "roevo_mrpt/time_conversions.h"

namespace roevo {
namespace {

using namespace mrpt::obs;

CActionCollection actionOf(const PosedScan& scan, mrpt::Clock::time_point time) {
    CActionCollection actions;
    if (!scan.motion) return actions;
    CActionRobotMovement3D movement;
    movement.timestamp = time;
    movement.poseChange = *scan.motion;
    movement.rawOdometryIncrementReading = scan.motion->mean;
    movement.estimationMethod = CActionRobotMovement3D::emVisualOdometry;
    actions.insert(movement);
    return actions;
}

CObservation::Ptr poseOf(const PosedScan& scan, mrpt::Clock::time_point time) {
    auto pose = CObservationRobotPose::Create();
    pose->timestamp = time;
    pose->sensorLabel = "roevo";
    pose->pose = scan.pose;
    return pose;
}

/// Puts what is in files of its own where the new rawlog has its own. Points and confidences, which follow
/// from the depth or are not used, are left behind when they are in files: MRPT loads no scan that lacks one.
void adopt(CObservation3DRangeScan& scan, RawlogWriter& out) {
    if (scan.hasIntensityImage && scan.intensityImage.isExternallyStored())
        scan.intensityImage.setExternalStorage(
            out.addImageFile(scan.intensityImage.getExternalStorageFileAbsolutePath()));
    if (scan.points3D_isExternallyStored()) scan.hasPoints3D = false;
    if (scan.confidenceImage.isExternallyStored()) scan.hasConfidenceImage = false;
    if (scan.rangeImage_isExternallyStored()) scan.rangeImage_forceResetExternalStorage();  // it is in memory
}

}  // namespace

void copyWithPoses(const std::string& rawlog, const std::string& sensor_label,
                   const std::vector<PosedScan>& scans, RawlogWriter& out) {
    std::map<double, const PosedScan*> by_time;
    for (const PosedScan& scan : scans) by_time[scan.timestamp] = &scan;
    CSensoryFrame frame;
    RawlogReader reader(rawlog, sensor_label);
    reader.onOther([&](const CObservation& other) {
        frame.insert(std::dynamic_pointer_cast<CObservation>(other.duplicateGetSmartPtr()));
    });
    while (const auto scan = reader.next()) {
        const auto posed = by_time.find(fromMrptTime(scan->timestamp));
        if (posed == by_time.end()) continue;
        adopt(*scan, out);
        frame.insert(poseOf(*posed->second, scan->timestamp));
        frame.insert(scan);
        out.add(actionOf(*posed->second, scan->timestamp));
        out.add(frame);
        frame.clear();
        by_time.erase(posed);  // a second scan with its stamp was rejected
    }
    if (frame.size() == 0) return;
    out.add(CActionCollection());
    out.add(frame);
}

}  // namespace roevo
