#pragma once
#include <string>

#include "recordings/bags/bag_file.h"
#include "recordings/bags/topic_choice.h"
#include "recordings/dataset_reader.h"

namespace roevo {

/// Both cameras of a recording, and how they sit.
struct BagCameras {
    PinholeCamera colour, depth;
    Pose T_depth_colour = Pose::Identity();  ///< optical frames; identity when depth is aligned to colour
    bool aligned = true;                     ///< both are the same camera
    std::string source;                      ///< of the colour camera, in words
    std::vector<std::string> notes;          ///< where the rest comes from, a line each
};

/// Reads intrinsics from camera_info and, where depth is not in the colour camera's frame, the extrinsics
/// from what the bag tells of its frames.
/// @param topics  of this bag, as chooseTopics() gives them
/// @throws std::runtime_error with one line that names the topic or the frames in question.
BagCameras readCameras(const BagFile& bag, const BagTopicNames& topics);

/// A bag as a dataset: its images are paired by the stamps of their headers and decoded when they are read;
/// `<stem>_groundtruth.txt` beside it is the ground truth. Messages that cannot be used are left out and
/// told.
/// @throws std::runtime_error with one line: openMessageStore(), chooseTopics(), readCameras(), or nothing
/// that fits together in time
DatasetDescription loadBag(const std::string& path, const DatasetOptions& options);

}  // namespace roevo
