#pragma once
#include <string>
#include <vector>

#include "bag2rawlog/bag_file.h"

namespace roevo {

/// Topics to read; an empty name means: find it.
struct BagTopicNames {
    std::string colour, depth, colour_info;
    std::string depth_info;  ///< stays empty where the bag has none
};

/// Fills in the names that are empty, where the bag leaves no doubt: of several depth topics the one in the
/// colour camera's frame, of several image topics the only one in colour.
/// @throws std::runtime_error with one line that names the topics in question and the option to choose by; as
/// well when a named topic is missing, compressed or of an unusable encoding.
BagTopicNames chooseTopics(const BagFile& bag, BagTopicNames names);

}  // namespace roevo
