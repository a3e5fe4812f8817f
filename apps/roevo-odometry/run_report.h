#pragma once
#include <optional>
#include <string>
#include <vector>

#include "evaluation/evaluate.h"
#include "roevo/odometry.h"

namespace roevo {

/// One input frame, for frames.csv.
struct FrameRecord {
    FrameResult result;
    double ms_decode = 0;
    bool dropped = false;  ///< came while tracking was busy (--realtime)
};

/// How often the camera was lost, and what became of it.
struct Losses {
    std::size_t lost = 0;         ///< times that tracking failed after it had worked
    std::size_t found_again = 0;  ///< of them, those that ended at a keyframe that was recognised
    std::size_t regained = 0;     ///< of them, those that tracking came out of by itself
    std::size_t joined = 0;       ///< tracks that were begun anew and later joined to an older one
    std::size_t loops_closed = 0;
    std::size_t pieces = 0;  ///< of the trajectory; where they are relative to each other was not measured

    bool found_in_map = false;  ///< one ended where the camera was found in map_in, which is none of these
    bool to_the_end = false;    ///< the last frame was lost

    /// "lost 3 times, found again once", for one loss at least.
    std::string toText() const;
};

/// The map of an earlier recording that a run began with.
struct LoadedMap {
    std::string file;
    int keyframes = 0;  ///< the first of all
    bool localise_only = false;
};

/// The map that a run leaves.
struct SavedMap {
    std::string file;  ///< empty: none
    int keyframes = 0;
};

/// All that a run came to.
struct RunReport {
    std::vector<std::string> command;  ///< that this is the result of
    std::string input, kind, camera_source, warning, sensor_label;
    PinholeCamera camera;
    double readout_time = 0;  ///< of the rolling shutter, as learned or set, s
    bool readout_learned = false;
    Mode mode = Mode::kBundleAdjustment;
    std::vector<FrameRecord> frames;
    std::vector<StampedPose> trajectory;
    std::vector<KeyframeInfo> keyframes;  ///< without those of map_in
    std::optional<LoadedMap> map_in;
    SavedMap map_out;
    std::vector<std::string> files;  ///< that were written: names in the output folder, paths elsewhere
    std::size_t map_edges = 0, map_points = 0, semi_dense_points = 0;
    std::vector<StampedPose> camera_on_robot;  ///< T_robot_camera of the frames with a pose
    bool mounted = false;                    ///< some frame's sensor sat elsewhere than on the robot's origin
    std::vector<MapRefusal> final_refusals;  ///< of what was refined together at the end
    double final_seconds = 0;                ///< of refining all keyframes together at the end
    double wall_seconds = 0;
    std::string ground_truth;              ///< file or folder, empty when there is none
    std::optional<Evaluation> evaluation;  ///< against the ground truth
    std::string evaluation_fault;          ///< why there is none although there is a ground truth
    std::string scale_warning;             ///< the ground truth has another scale, in one line, or empty

    std::size_t count(FrameStatus status) const;
    std::size_t dropped() const;
    Losses losses() const;
    /// The piece of the trajectory that each frame belongs to, from 1 on in the order of time; 0 without a
    /// pose. Pieces that were joined later are one.
    std::vector<int> segments() const;
    /// The frame that was recognised first in the map of map_in, or null.
    const FrameResult* localised() const;
    /// The keyframe of that map that a frame was recognised by, or -1.
    int mapKeyframeOf(const FrameResult& frame) const;
    /// The segment that is in the world of map_in; 0 where there is none.
    int mapSegment() const;
    /// Keyframes of pieces that are not in map_out.
    std::size_t leftOut() const;
    /// Keyframes that are not in map_out because others in it show the same.
    std::size_t covered() const;
    /// Of the final trajectory, m, without what is between its pieces.
    double pathLength() const;
    /// Where not all of the trajectory is in the world of map_in; else empty.
    std::string mapWarning() const;
    /// Where the errors are of less than half of the trajectory; else empty.
    std::string evaluationWarning() const;
    /// That the camera's intrinsics seem to be of another image size; else empty.
    std::string cameraWarning() const;
    /// Where half of the frames that were not dropped or more are rejected: why most of these are; else
    /// empty.
    std::string rejectionWarning() const;

    /// Empty when at least one frame was tracked (or the only frame initialised), else the commonest reason.
    /// Poses that are not numbers are a failure, too: no result is printed then.
    std::string failure() const;
};

/// A reason without the file that it names at its end ("…: <path>"), so that equal faults can be counted.
std::string reasonWithoutFile(const std::string& reason);

/// One row per frame, as the contract has it.
std::string framesCsv(const RunReport& report);

/// The 6x6 covariance of every pose, as the contract has it.
std::string covariancesText(const RunReport& report);

/// summary.json.
std::string summaryJson(const RunReport& report);

/// A few lines for the terminal.
void printSummary(const RunReport& report, const std::string& output_dir);
/// Prints what each stage takes, ms, and its median over that of decoding the same frames.
void printProfile(const RunReport& report);

}  // namespace roevo
