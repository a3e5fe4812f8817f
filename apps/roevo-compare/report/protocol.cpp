#include "roevo-compare/report/tables.h"

namespace roevo {

const std::vector<std::string>& protocolLines() {
    static const std::vector<std::string> lines{
        "Association: each pose with the ground truth pose of the nearest time stamp, at most 0.02 s apart, "
        "one "
        "to one; the time of a frame is that of its colour image.",
        "ATE: distances between camera centres after an SE(3) alignment without scale (Umeyama) over all "
        "associated poses; RMSE in cm.",
        "RPE over 1 s: error of the relative motion from each pose to the one nearest to 1 s later (within "
        "0.1 s); RMSE in cm/s and deg/s. RPE per frame: the same to the next pose, in cm and deg. Neither "
        "needs "
        "an alignment.",
        "Same input: every method gets the same frames in the same order, undistorted, depth registered to "
        "colour. Frames that cannot be read are given to none and do not count.",
        "Frames tracked: share of these frames to which the method measured the motion. Errors are over the "
        "poses that a method gave, so those of a method that lost frames are of fewer, usually easier "
        "frames: "
        "below 90 % it ranks behind all that tracked more, and its figures are marked.",
        "One configuration for all sequences; no option is tuned to a sequence or to a method's advantage.",
        "One processor core for each run, one run after the other on it. Times per frame are over tracked "
        "frames, without reading and decoding; memory is the largest resident memory of the run's process.",
        "Rank: by RMSE, 1 is best; equal errors share the better rank. A method that gave no error counts as "
        "last in the mean rank; one that could not be run on this machine is not ranked.",
    };
    return lines;
}

}  // namespace roevo
