#pragma once
#include <string>
#include <vector>

#include "recordings/input_choice.h"
#include "study.h"

namespace roevo {

/// What the command line says of the recordings.
struct InputSettings {
    std::vector<std::string> paths;    ///< rawlogs, bags or dataset folders
    bool ignore_ground_truth = false;  ///< even where some is beside a recording
    InputChoice choice;                ///< of all recordings
    std::size_t first = 0, skip = 0;   ///< first 0: all frames
    OdometryOptions options;
    std::vector<Mode> modes{Mode::kBundleAdjustment, Mode::kTracking};  ///< see StudyInput
    TruthNoise truth_noise;
    std::vector<std::size_t> gaps{20, 60, 120};  ///< frames
};

/// Fewer frames show no motion to measure.
inline constexpr std::size_t kFewestFrames = 3;

struct OpenedInputs {
    std::vector<StudyInput> usable;
    std::vector<LeftOut> left_out;
};

/// Opens each recording once to learn its camera and ground truth and that there is something to study.
/// One that cannot be used is left out: not readable, fewer than kFewestFrames frames, depth of no plausible
/// scale, a ground truth that was asked for and is bad.
/// @throws std::runtime_error in one line when not a single one is usable
OpenedInputs openInputs(const InputSettings& settings);

}  // namespace roevo
