#pragma once
#include <string>
#include <vector>

#include "recordings/bags/bag_file.h"
#include "recordings/bags/topic_names.h"

namespace roevo {

/// Fills in the names that are empty, where the bag leaves no doubt: of several depth topics the one in the
/// colour camera's frame, of several image topics the only one in colour.
/// @throws std::runtime_error with one line that names the topics in question and the option to choose by; as
/// well when a named topic is missing or of an unusable encoding.
BagTopicNames chooseTopics(const BagFile& bag, BagTopicNames names);

/// The topic of the images without what image_transport adds to it: "/compressed", "/compressedDepth".
std::string imageTopicBase(const std::string& topic);

}  // namespace roevo
