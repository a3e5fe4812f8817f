#pragma once
#include <array>
#include <numeric>
#include <optional>
#include <string>
#include <vector>

#include "programs/progress.h"
#include "study.h"

namespace roevo {

/// What is timed on every frame.
enum Operation : std::size_t {
    kDetect,             ///< gradient, threshold, Canny: the same for both
    kOrganize,           ///< adjacency, oriented search, normals, pixel grid
    kField,              ///< exact distance field
    kField5x5,           ///< the same as OpenCV approximates it
    kCoarse,             ///< coarse tracking before our registration
    kCoarseField,        ///< and before the distance field's
    kRegistration,       ///< ours
    kRegistrationField,  ///< the distance field's
    kWhole,              ///< our tracking with all that is not listed
    kAlike,              ///< ours, reduced to what the distance field's does, see RegistrationWork
    kAlikeField,         ///< the distance field's for kFixedSteps steps from the same start
    kOperations
};
using FrameTimes = std::array<double, kOperations>;  ///< ms

/// How much a registration did.
struct RegistrationWork {
    std::size_t points = 0;  ///< of the keyframe, looked up in every step
    int steps = 0;
};
struct FrameWork {
    RegistrationWork ours, field;
    /// Both on the same keyframe, frame and start: kFixedSteps steps with the residual of edges alone,
    /// neither photometric nor of depth. No points where one of them did not converge.
    RegistrationWork alike;
};

/// What was measured on one recording.
struct Measured {
    std::string name;
    std::vector<FrameTimes> frames;
    std::vector<FrameWork> work;  ///< of the same frames
    std::vector<double> mapping;  ///< ms, of every keyframe
    std::size_t all_frames = 0;   ///< that could be read

    double mappingSum() const { return std::accumulate(mapping.begin(), mapping.end(), 0.0); }
    /// None when no map took effect.
    std::optional<double> mappingPerFrame() const {
        if (mapping.empty()) return std::nullopt;
        return mappingSum() / static_cast<double>(all_frames);
    }
};

constexpr int kEfficiencyPasses = 3;

/// Our odometry and the one with the distance field take turns on every frame, on one core: processor time of
/// this thread, but for mapping, which tells the clock's. The recording is run
/// kEfficiencyPasses times and an operation's time on a frame is the least of them: the work is the same
/// every time, and whatever else the computer does only adds to it.
/// @param done  frames so far, for the progress
Measured measureEfficiency(const StudyInput& input, Progress& progress, std::size_t& done);

}  // namespace roevo
