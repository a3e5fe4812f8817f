#pragma once
#include <mrpt/poses/CPose3DPDFGaussian.h>

#include <optional>
#include <string>
#include <vector>

namespace roevo {

class RawlogWriter;

/// Where the robot was when a scan was taken.
struct PosedScan {
    double timestamp = 0;                  ///< s, of the scan
    mrpt::poses::CPose3DPDFGaussian pose;  ///< T_map_robot
    std::optional<mrpt::poses::CPose3DPDFGaussian>
        motion;  ///< since the posed scan before, where it was measured
};

/// Copies the scans of a rawlog that have a pose, as MRPT's localisation and mapping want them: for each a
/// CActionCollection with a CActionRobotMovement3D (visual odometry), then a CSensoryFrame with a
/// CObservationRobotPose, the scan itself, and all other observations and actions since the scan before.
/// Planar movements become a CObservationOdometry. Scans without a pose are left out.
/// @param sensor_label  as RawlogReader has it
/// @param out  images of the scans are linked or copied; finish() is left to the caller
/// @throws std::runtime_error
void copyWithPoses(const std::string& rawlog, const std::string& sensor_label,
                   const std::vector<PosedScan>& scans, RawlogWriter& out);

}  // namespace roevo
