#pragma once
#include <string>

namespace roevo {

/// Topics of a bag to read; an empty name means: find it.
struct BagTopicNames {
    std::string colour, depth, colour_info;
    std::string depth_info;  ///< stays empty where the bag has none

    bool any() const { return !(colour + depth + colour_info + depth_info).empty(); }
};

}  // namespace roevo
