#pragma once
#include <optional>
#include <string>
#include <vector>

#include "roevo/camera/pinhole_camera.h"
#include "roevo/edge_map.h"
#include "roevo/types.h"

namespace roevo {

/// What roevo-odometry has left in its output folder, as far as it is there. World: that of the trajectory.
struct ResultFolder {
    std::string name;  ///< of the recording, or of the folder
    std::string mode;  ///< "ba", "tr" or "ct"; empty when it is not known
    std::vector<StampedPose> trajectory;
    std::vector<StampedPose> live, keyframes;  ///< may be empty
    std::optional<PinholeCamera> camera;
    std::optional<double> path_length;  ///< m, without what is between pieces, where the run told it
    std::string ground_truth;           ///< file that the run was compared with; may be empty
    EdgeMap edges;
    std::vector<ColouredPoint> surface;
    std::vector<std::string> missing;  ///< names of files that are not there
};

/// @throws std::runtime_error when there is no such folder, it has no trajectory.txt, or a file in it is
/// damaged
ResultFolder readResultFolder(const std::string& folder);

}  // namespace roevo
