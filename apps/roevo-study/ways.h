#pragma once
#include <cstddef>
#include <string>
#include <vector>

#include "study.h"

namespace roevo {

/// One of the ways through a recording that tell luck from gain: keyframes fall elsewhere each time.
struct Way {
    bool backwards = false;
    std::size_t start = 0;  ///< frames left out at its beginning

    std::string name() const;  ///< "forwards", "backwards from frame 3"
};

/// Forwards and backwards, each from five starts (0, 3, 6, 9 and 12 frames left out); fewer where the
/// recording is so short that no kFewestFrames would be left.
std::vector<Way> waysThrough(const StudyInput& input);

/// The recording, and its ground truth, as met on that way. The ground truth must not be empty.
StudyInput along(const StudyInput& input, const Way& way);

}  // namespace roevo
