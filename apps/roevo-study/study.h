#pragma once
#include <functional>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "evaluation/evaluate.h"
#include "evaluation/nees.h"
#include "recordings/frame_source.h"
#include "roevo/camera/pinhole_camera.h"
#include "roevo/odometry.h"
#include "roevo/options.h"
#include "roevo/types.h"

namespace roevo {

/// In the place of a figure that there is none of.
constexpr double kMissing = std::numeric_limits<double>::quiet_NaN();

/// What is wrong with a recording that can be used.
struct RecordingDamage {
    std::size_t frames = 0, unreadable = 0;
    std::string first_fault;  ///< of the first unreadable frame
    std::string warning;      ///< FrameSource::warning()

    std::string text() const;  ///< one line; empty when all is well
};

/// One recording under study. Frames are streamed: experiments open it anew for every pass.
struct StudyInput {
    std::string name;  ///< short and unique among the inputs: a column of the tables, a legend's entry
    std::string path;  ///< as given on the command line
    PinholeCamera camera;
    /// A fresh source of the frames under study (--skip left out, at most --first), decoding ahead.
    std::function<std::unique_ptr<FrameSource>()> open;
    std::vector<StampedPose> ground_truth;    ///< T_world_camera in time order; empty: none
    std::string ground_truth_note;            ///< where it comes from, or why there is none
    OdometryOptions options;                  ///< from --config and --set
    std::vector<Mode> modes;                  ///< for experiments that compare them
    TruthNoise truth_noise;                   ///< of the ground truth, from --truth-sigma
    std::vector<std::size_t> gaps;            ///< frames to cut out, from --gap
    std::shared_ptr<RecordingDamage> damage;  ///< known once it has been read; may be absent
};

/// A recording that could not be used.
struct LeftOut {
    std::string name;    ///< of the recording, or its path where it could not even be opened
    std::string reason;  ///< one line
};

/// What an experiment has to say once its tables and plots are in the folder.
struct StudyReport {
    std::string summary;             ///< one line for the terminal, with the figures that matter
    std::string table;               ///< Markdown, for the terminal and the index; mostly empty
    std::vector<std::string> files;  ///< names in the folder: CSV and SVG, in the order of the index
    std::vector<std::string> notes;  ///< what a reader must know: no ground truth, frames left out
    std::vector<LeftOut> left_out;   ///< recordings that it could not measure anything on
    std::string plot_fault;          ///< why a plot is missing; empty when all were drawn
};

/// Runs over the inputs and writes its CSV and SVG files into the folder, which exists.
/// @throws std::runtime_error in one line when it cannot do anything
using Experiment = StudyReport (*)(const std::vector<StudyInput>& inputs, const std::string& folder);

StudyReport studyCannyThreshold(const std::vector<StudyInput>& inputs, const std::string& folder);
StudyReport studyDepthWeight(const std::vector<StudyInput>& inputs, const std::string& folder);
StudyReport studyAblation(const std::vector<StudyInput>& inputs, const std::string& folder);
StudyReport studyRepeatability(const std::vector<StudyInput>& inputs, const std::string& folder);
StudyReport studyEfficiency(const std::vector<StudyInput>& inputs, const std::string& folder);
StudyReport studySigmas(const std::vector<StudyInput>& inputs, const std::string& folder);
StudyReport studyDistribution(const std::vector<StudyInput>& inputs, const std::string& folder);
StudyReport studyLoop(const std::vector<StudyInput>& inputs, const std::string& folder);
StudyReport studyGaps(const std::vector<StudyInput>& inputs, const std::string& folder);
StudyReport studyGrowth(const std::vector<StudyInput>& inputs, const std::string& folder);

/// Measures on each input. One that fails becomes a line of the report, and the others go on; `measure` must
/// not have added anything to the tables by then.
/// @throws std::runtime_error with the first one's reason when all failed
void forEachInput(const std::vector<StudyInput>& inputs, StudyReport& report,
                  const std::function<void(const StudyInput&)>& measure);

/// One run of the odometry over an input.
struct StudyRun {
    std::vector<StampedPose> trajectory, live;
    std::vector<double> keyframe_times;    ///< s, ascending
    std::size_t frames = 0, tracked = 0;   ///< tracked: measured, or the first; the others are not
    double points = 0;                     ///< on organized edges, mean over the frames
    std::optional<Evaluation> evaluation;  ///< none without ground truth, see `fault`
    std::string fault;                     ///< why there is no evaluation, in words
};
using FrameObserver = std::function<void(const FrameResult&, const Odometry&)>;
/// @param observe  is shown every frame once it was processed
StudyRun trackRecording(const StudyInput& input, const OdometryOptions& options,
                        const FrameObserver& observe = {});

/// Rows of a CSV file, held until all are there.
class CsvTable {
  public:
    explicit CsvTable(std::vector<std::string> head);

    /// Adds a row; text with commas or quotes is quoted. @throws std::logic_error for a wrong number of
    /// fields
    void add(const std::vector<std::string>& fields);
    /// @throws std::runtime_error
    void write(const std::string& path) const;

    /// A number with `digits` significant digits; empty for none and for what is not finite.
    static std::string number(std::optional<double> value, int digits = 6);

  private:
    std::size_t columns_;
    std::string text_;
};

/// A table for the index and the terminal. @param rows  the first is the head
std::string markdownTable(const std::vector<std::vector<std::string>>& rows);

/// Draws `folder`/`name` with gnuplot and lists it in the report; what hinders it goes into plot_fault,
/// because the tables are worth having without it.
void addPlot(StudyReport& report, const std::string& folder, const std::string& name,
             const std::string& script, int width = 860, int height = 500);

/// The text for a plot, as an expression of gnuplot's: long names are broken into lines at their underscores.
std::string plotLabel(const std::string& name);
/// "(label 0, label 1, …)" for `set xtics`.
std::string plotTics(const std::vector<std::string>& names);
/// px that such tics want beside each other. @param rest  px for all but them
int plotWidth(std::size_t names, int rest);

/// Writes the table to `folder`/`name` and lists it in the report. @throws std::runtime_error
void addTable(StudyReport& report, const std::string& folder, const std::string& name, const CsvTable& table);

/// Middle value, the mean of the two in the middle where their number is even; none of an empty list.
std::optional<double> median(std::vector<double> values);

/// As printf.
std::string format(const char* pattern, ...) __attribute__((format(printf, 1, 2)));

}  // namespace roevo
