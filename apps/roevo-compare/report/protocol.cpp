#include "roevo-compare/report/protocol.h"

namespace roevo {

namespace {

std::string coreText(bool pinned) {
    return pinned ? "One processor core for each run." : "Not pinned: not every run was bound to one core.";
}

std::string commonText(const Conditions& conditions) {
    if (conditions.frames && conditions.config) return "same frames and one configuration for all";
    return std::string(conditions.frames ? "same frames for all" : "frames differ") + ", " +
           (conditions.config ? "one configuration for all" : "options differ");
}

}  // namespace

std::vector<std::string> protocolLines(const Conditions& conditions) {
    return {
        "Association: each pose with the ground truth pose of the nearest time stamp, at most 0.02 s apart, "
        "one to one, the closest pair first. The time of a frame is that of its colour image.",
        "ATE: distances between camera centres after an SE(3) alignment without scale (Umeyama) over all "
        "associated poses; RMSE in cm.",
        "RPE over 1 s: error of the relative motion from each pose to the one nearest to 1 s later (within "
        "0.1 s); RMSE in cm/s and deg/s. RPE per frame: the same to the next pose, in cm and deg. Neither "
        "needs an alignment.",
        std::string(conditions.frames ? "Same frames for every method, in the same order"
                                      : "Not the same frames for every method (see the remarks)") +
            ", as the lens saw them, depth registered to colour. Frames that cannot be read are given to "
            "none and count as not tracked. All use depth within the same limits; options of the sensor and "
            "of the motion model hold for all that know them.",
        "Frames tracked: share of all frames to which the method measured the motion. Errors are over all "
        "poses that a method gave, those that it predicted where it had lost track, too. Below 90 % it ranks "
        "behind all that tracked more, and its errors are marked.",
        conditions.config ? "One configuration for all sequences; no option is tuned to a sequence."
                          : "Runs of ROEVO differ in their options (see the remarks).",
        coreText(conditions.pinned) +
            " Times per frame are over tracked frames, without reading and decoding; memory is the largest "
            "resident memory of the run's process.",
        "Rank: by RMSE, 1 is best; equal errors share the better rank. A method without a result counts as "
        "last in the mean rank; one that could not be run on this machine is not ranked. A sequence is what "
        "was run of it here, be it the whole or a part.",
    };
}

std::string errorProtocol(const Conditions& conditions) {
    return "RMSE; association within 0.02 s, one to one; ATE after an SE(3) alignment without scale; " +
           commonText(conditions) + ".";
}

std::string shareProtocol(const Conditions& conditions) {
    return std::string("Share of all frames to which the method measured the motion; ") +
           (conditions.frames ? "the same frames for all." : "frames differ.");
}

std::string costProtocol(const Conditions& conditions) {
    return std::string(conditions.pinned ? "One core" : "Not pinned to one core") +
           ", reading and decoding apart; times over tracked frames; " + commonText(conditions) + ".";
}

}  // namespace roevo
