#include "roevo_mrpt/posed_rawlog.h"

#include <mrpt/obs/CActionCollection.h>
#include <mrpt/obs/CActionRobotMovement2D.h>
#include <mrpt/obs/CActionRobotMovement3D.h>
#include <mrpt/obs/CObservation3DRangeScan.h>
#include <mrpt/obs/CObservationOdometry.h>
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

/// What was recorded since the scan before.
struct Recorded {
    CActionCollection actions;
    CSensoryFrame frame;
    mrpt::poses::CPose2D wheels;  ///< since the beginning

    /// MRPT's particle filters would follow a planar movement in place of the one that was seen, so that it
    /// becomes an observation of odometry.
    void add(const CActionCollection& more) {
        for (const auto& action : more) {
            const auto movement = std::dynamic_pointer_cast<CActionRobotMovement2D>(action.get_ptr());
            if (!movement) {
                actions.insert(*action);
                continue;
            }
            wheels = wheels + (movement->estimationMethod == CActionRobotMovement2D::emOdometry
                                   ? movement->rawOdometryIncrementReading
                                   : movement->poseChange->getMeanVal());
            auto odometry = CObservationOdometry::Create();
            odometry->timestamp = movement->timestamp;
            odometry->sensorLabel = "odometry";
            odometry->odometry = wheels;
            frame.insert(odometry);
        }
    }

    /// @param first  in the actions
    void moveTo(RawlogWriter& out, CActionCollection first) {
        for (const auto& action : actions) first.insert(*action);
        out.add(first);
        out.add(frame);
        actions.clear();
        frame.clear();
    }
};

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
    Recorded recorded;
    RawlogReader reader(rawlog, sensor_label);
    reader.onOther([&](const CObservation& other) {
        recorded.frame.insert(std::dynamic_pointer_cast<CObservation>(other.duplicateGetSmartPtr()));
    });
    reader.onActions([&](const CActionCollection& actions) { recorded.add(actions); });
    while (const auto scan = reader.next()) {
        const auto posed = by_time.find(fromMrptTime(scan->timestamp));
        if (posed == by_time.end()) continue;
        adopt(*scan, out);
        recorded.frame.insert(poseOf(*posed->second, scan->timestamp));
        recorded.frame.insert(scan);
        recorded.moveTo(out, actionOf(*posed->second, scan->timestamp));
        by_time.erase(posed);  // a second scan with its stamp was rejected
    }
    if (recorded.frame.size() + recorded.actions.size() > 0) recorded.moveTo(out, {});
}

}  // namespace roevo
