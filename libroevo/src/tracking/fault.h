#pragma once
#include <string>

namespace roevo {

/// Why a frame could not be used, tracked, or made a keyframe: in words, one line; none where it could.
struct Fault {
    std::string words{};

    explicit operator bool() const { return !words.empty(); }
};

}  // namespace roevo
