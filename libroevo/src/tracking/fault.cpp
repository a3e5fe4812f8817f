#include "tracking/fault.h"

namespace roevo {

std::string describe(const Fault& fault) {
    using Kind = Fault::Kind;
    const auto number = [&](std::size_t i) { return std::to_string(fault.numbers[i]); };
    const auto sizes = [&] {
        return number(0) + "x" + number(1) + " but the camera is " + number(2) + "x" + number(3);
    };
    switch (fault.kind) {
        case Kind::kNone:
            return {};
        case Kind::kTimeNotFinite:
            return "time stamp is not finite";
        case Kind::kTimeUnit:
            return "time stamp is no time in seconds (it may be missing, or count nanoseconds)";
        case Kind::kTimeRepeated:
            return "repeated time stamp";
        case Kind::kTimeBackward:
            return "time stamp goes backward";
        case Kind::kNoColour:
            return "no colour image";
        case Kind::kGreyType:
            return "grey image is not 8-bit with one channel";
        case Kind::kGreySize:
            return "grey image is " + sizes();
        case Kind::kColourType:
            return "colour image is not 8-bit with three channels";
        case Kind::kColourSize:
            return "colour image is " + sizes();
        case Kind::kDepthType:
            return "depth image is not 32-bit float with one channel";
        case Kind::kDepthSize:
            return "depth image is " + sizes();
        case Kind::kMaskType:
            return "mask is not 8-bit with one channel";
        case Kind::kMaskSize:
            return "mask is " + sizes();
        case Kind::kNoDepth:
            return "no depth image";
        case Kind::kFewPointsWithDepth:
            return "only " + number(0) + " edge points with depth, " + number(1) + " needed";
        case Kind::kFewPointsInView:
            return "coarse tracking saw too few points in the image: " + number(0) + " of " + number(1);
        case Kind::kCoarseAstray:
            return "coarse tracking went astray: hardly any edge is where it should be";
        case Kind::kFewInliers:
            return "only " + number(0) + " associated edge points, " + number(1) + " needed";
        case Kind::kFewMatched:
            return "only " + number(0) + " % of the edges associated, " + number(1) + " % needed";
        case Kind::kDiverged:
            return "the pose diverged";
        case Kind::kDepthContradicts:
            return "the depth image contradicts the keyframe's: " + number(0) + " % of the points agree";
        case Kind::kGap:
            return "a gap of " + number(0) + " ms";
        case Kind::kTimeLeap:
            return "time stamp leaps ahead by " + number(0) +
                   " s; the next frame tells whether it is damaged";
        case Kind::kFrozen:
            return "the image is the same as the one before it: a frozen camera, or one at rest without "
                   "noise";
        case Kind::kUnconfirmed:
            return "the edges do not confirm a pose " + number(0) + " ms after the last";
    }
    return "unknown fault";
}

}  // namespace roevo
