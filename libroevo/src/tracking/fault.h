#pragma once
#include <array>
#include <string>

namespace roevo {

/// Why a frame could not be used, tracked, or made a keyframe, with the numbers that decided.
struct Fault {
    enum class Kind {
        kNone,
        // of the input
        kTimeNotFinite,
        kTimeUnit,
        kTimeRepeated,
        kTimeBackward,
        kNoColour,
        kGreyType,
        kGreySize,  ///< numbers: width and height of the image, of the camera
        kColourType,
        kColourSize,  ///< the same
        kDepthType,
        kDepthSize,  ///< the same
        kMaskType,
        kMaskSize,  ///< the same
        // of a keyframe
        kNoDepth,
        kFewPointsWithDepth,  ///< numbers: found, needed
        // of tracking
        kFewPointsInView,  ///< coarse; numbers: points in view, points of the keyframe
        kCoarseAstray,
        kFewInliers,  ///< numbers: found, needed
        kFewMatched,  ///< numbers: found, needed, percent of the edges
        kDiverged,
        kDepthContradicts,  ///< number: share of points whose depths agree, percent
        kGap,               ///< number: how long no pose was measured, ms
        kUnconfirmed,       ///< the same
        kFrozen,
        kTimeLeap  ///< number: by how much the stamp is ahead, s
    };
    Kind kind = Kind::kNone;
    std::array<int, 4> numbers{};

    explicit operator bool() const { return kind != Kind::kNone; }
};

/// In words, one line; empty for none.
std::string describe(const Fault& fault);

}  // namespace roevo
