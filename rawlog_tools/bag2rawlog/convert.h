#pragma once
#include <string>
#include <vector>

#include "bag2rawlog/bag_file.h"
#include "bag2rawlog/topic_choice.h"
#include "recordings/association_report.h"
#include "roevo/camera/pinhole_camera.h"
#include "roevo/types.h"

namespace roevo {

/// Both cameras of a recording, and how they sit.
struct BagCameras {
    PinholeCamera colour, depth;
    Pose T_depth_colour = Pose::Identity();  ///< optical frames; identity when depth is aligned to colour
    bool aligned = true;                     ///< both are the same camera
    std::string label;                       ///< the colour camera's frame: the sensor's label in the rawlog
    std::vector<std::string> notes;          ///< where all this comes from, a line each
};

/// Reads intrinsics from camera_info and, where depth is not in the colour camera's frame, the extrinsics
/// from /tf_static.
/// @param topics  of this bag, as chooseTopics() gives them
/// @throws std::runtime_error with one line that names the topic or the frames in question.
BagCameras readCameras(const BagFile& bag, const BagTopicNames& topics);

struct BagConversion {
    AssociationReport association;
    std::size_t written = 0;
    std::size_t left_out = 0;          ///< messages that could not be used
    std::vector<std::string> reasons;  ///< a line for each of the first of them
    std::size_t too_far = 0;           ///< depth values that do not fit into 16 bits
};

/// Writes the recording as a rawlog, colour images as PNG beside it, frames stamped by the colour messages'
/// headers. Unusable messages are left out. @throws std::runtime_error when nothing usable is left.
BagConversion convertBag(const BagFile& bag, const BagTopicNames& topics, const BagCameras& cameras,
                         double max_time_difference, const std::string& rawlog);

}  // namespace roevo
