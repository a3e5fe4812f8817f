#pragma once
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "roevo/types.h"

namespace roevo {

/// Times of one stage over the frames, ms.
struct StageStatistics {
    std::string name;
    double median = 0, p95 = 0, mean = 0;
};

/// One method's run over one recording, as it is kept in a folder (see rows.h). The method ran in a process
/// of its own, on one core, so that its memory and its crashes are its own.
struct MethodRun {
    std::string method, label, note;
    std::string input;    ///< as given on the command line
    std::string part;     ///< what of the recording was run: "frames 10 to 24"; empty: all of it
    std::string config;   ///< every option in force, as in config_used.ini, where it is at hand
    std::string skipped;  ///< why the method was not run at all (a library lacks it); empty when it was
    std::string failure;  ///< why there is no (whole) result: what it threw, the signal that ended it, a NaN
    std::size_t frames = 0, tracked = 0, rejected = 0;  ///< rejected: unreadable, no method can use them
    std::vector<StageStatistics> stages;                ///< of tracked frames
    StageStatistics total;                              ///< of tracked frames, decoding apart
    StageStatistics decode;
    double cpu_ms_per_frame = 0;  ///< processor time of all threads by frame, decoding apart
    double core_lost = 0;         ///< share (0 to 1) of the run's time in which other programs had its core
    std::string background;       ///< name of the work beside the frames, e.g. "mapping"; may be empty
    double background_ms = 0;     ///< mean of one piece of it
    double memory_peak_mb = 0;    ///< of the process
    std::vector<StampedPose> trajectory;
    std::string scene;                  ///< file name of the 3-D scene in the folder, or empty
    std::vector<std::string> warnings;  ///< what is odd about the recording or the result, one line each
    std::string not_pinned;             ///< why its process was not bound to one core; empty when it was
    std::string key;                    ///< by which roevo-batch tells what it was made of; else empty
    std::string trajectory_file;  ///< with poses that another program made: no times are known; else empty
    std::size_t poses = 0;        ///< of the trajectory, where it is known but not at hand
    /// Of its part, where there is a ground truth that may not be at hand.
    std::optional<double> ground_truth_length_m;

    bool ok() const { return skipped.empty() && failure.empty(); }
};

/// Between a method's name and that of a configuration, where a method is run with several.
constexpr char kVariantMark = '@';

/// Other programs had the core of a run for longer than this share of its time: its times are in doubt.
constexpr double kDisturbedShare = 0.05;
inline bool isDisturbed(const MethodRun& run) {
    return run.core_lost > kDisturbedShare;
}

}  // namespace roevo
