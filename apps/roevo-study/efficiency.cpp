// Time of every operation, ours against registration by a distance field (the paper's "Efficiency Analysis"):
// both odometries take turns on every frame, in one process, so that noise hits both alike.
#include <algorithm>
#include <array>
#include <chrono>
#include <opencv2/core/utility.hpp>
#include <opencv2/imgproc.hpp>

#include "evaluation/error_statistics.h"
#include "roevo-compare/methods/distance_field.h"
#include "roevo/camera/undistorter.h"
#include "roevo/edges/organize.h"
#include "roevo/odometry.h"
#include "roevo/odometry_stages.h"
#include "study.h"
#include "support/gnuplot.h"
#include "support/progress.h"

namespace roevo {
namespace {

using Clock = std::chrono::steady_clock;

/// Milliseconds that `work` takes.
template <class Work>
double timed(Work&& work) {
    const Clock::time_point start = Clock::now();
    work();
    return std::chrono::duration<double, std::milli>(Clock::now() - start).count();
}

/// OpenCV's threads put away while this lives.
class OneThread {
  public:
    OneThread() { cv::setNumThreads(1); }
    ~OneThread() { cv::setNumThreads(before_); }
    OneThread(const OneThread&) = delete;

  private:
    int before_ = cv::getNumThreads();
};

/// What one frame costs, ms.
struct FrameTimes {
    double detect = 0;               // gradient, threshold, Canny: the same for both
    double organize = 0, field = 0;  // feature processing
    double field_5x5 = 0;            // the distance field as OpenCV approximates it
    double coarse = 0, coarse_field = 0;
    double registration = 0, registration_field = 0;
    double whole = 0;  // of our tracking, with all that is not listed
};

/// Edges of one image, and a distance field of them.
class FeatureProcessing {
  public:
    FeatureProcessing(const PinholeCamera& camera, const EdgeOptions& options)
        : camera_(camera), options_(options), undistorter_(camera) {}

    void measure(const cv::Mat& grey, FrameTimes& times) {
        const cv::Mat& image = undistorter_.apply(grey, undistorted_);
        times.detect = timed([&] {
            computeGradient(image, options_.blur_sigma, gradient_);
            const double high = std::max(options_.min_high_threshold,
                                         options_.canny_high_factor * otsuThreshold(gradient_.magnitude));
            canny(gradient_, options_.canny_low_ratio * high, high, mask_);
        });
        times.field = timed([&] { field_.build(mask_.mask); });
        times.field_5x5 = timed([&] {
            cv::compare(mask_.mask, 0, background_, cv::CMP_EQ);
            cv::distanceTransform(background_, approximate_, cv::DIST_L2, cv::DIST_MASK_5, CV_32F);
        });
        times.organize = timed([&] {  // last: it changes the mask
            adjustAdjacency(mask_);
            organizer_.organize(gradient_, mask_, options_.angle_deg, options_.min_length, edges_);
            computeNormals(edges_, options_.tangent_span);
            grid_.build(edges_, camera_.width, camera_.height);
        });
    }

  private:
    PinholeCamera camera_;
    EdgeOptions options_;
    Undistorter undistorter_;
    cv::Mat undistorted_, background_, approximate_;
    Gradient gradient_;
    EdgeMask mask_;
    EdgeOrganizer organizer_;
    OrganizedEdges edges_;
    EdgeGrid grid_;
    DistanceField field_;
};

OdometryOptions optionsFor(const StudyInput& input, Mode mode) {
    OdometryOptions options = input.options;
    options.mode = mode;
    options.mapping.semi_dense_points = 0;  // sampled beside tracking, and neither method needs it
    options.mapping.deterministic = true;
    return options;
}

/// Both odometries; their registrations are timed by the same clock around the same call.
class Contest {
  public:
    explicit Contest(const StudyInput& input)
        : fine_(input.options.fine, input.options.edges, input.options.sensor),
          field_(input.options.fine, 0),
          ours_(input.camera, optionsFor(input, Mode::kBundleAdjustment), Pose::Identity(), stages(fine_)),
          theirs_(input.camera, optionsFor(input, Mode::kTracking), Pose::Identity(), stages(field_)),
          features_(input.camera, input.options.edges) {}
    Contest(const Contest&) = delete;  // the odometries point to the trackers

    /// @return whether both tracked the frame
    bool process(const RgbdFrame& frame, bool ours_first, FrameTimes& times) {
        bool both = true;
        for (const bool ours : {ours_first, !ours_first}) {
            registration_ = 0;
            const FrameResult result = (ours ? ours_ : theirs_).processFrame(frame);
            both = both && result.status == FrameStatus::kOk;
            if (ours) {
                mapping_ms += result.ms.mapping;
                mapped += result.ms.mapping > 0;
                times.coarse = result.ms.coarse;
                times.registration = registration_;
                times.whole = result.ms.total - result.ms.waiting;
                ours_.trajectory();  // waits for the map, so that it is not at work while others are timed
            } else {
                times.coarse_field = result.ms.coarse;
                times.registration_field = registration_ - field_.takeTimes().field;
            }
        }
        if (both) features_.measure(frame.grey, times);
        return both;
    }

    double mapping_ms = 0;
    std::size_t mapped = 0;

  private:
    template <class Tracker>
    OdometryStages stages(Tracker& tracker) {
        OdometryStages stages;
        stages.registration = [this, &tracker](const Keyframe& keyframe, const FineFrame& frame,
                                               const Pose& T_start, const PosePrior& prior,
                                               const RollingShutter& shutter, const Brightness& brightness) {
            FineResult result;
            registration_ +=
                timed([&] { result = tracker.track(keyframe, frame, T_start, prior, shutter, brightness); });
            return result;
        };
        return stages;
    }

    FineTracker fine_;
    DistanceFieldTracker field_;
    Odometry ours_, theirs_;
    FeatureProcessing features_;
    double registration_ = 0;  // of the frame at work
};

/// What was measured on one recording.
struct Measured {
    std::string name;
    std::vector<FrameTimes> frames;
    double mapping_per_frame = 0, mapping_per_keyframe = 0;  // ms, means
    std::size_t all_frames = 0, keyframes = 0;
};

Measured measure(const StudyInput& input, Progress& progress, std::size_t& done) {
    Measured measured;
    measured.name = input.name;
    Contest contest(input);
    const auto source = input.open();
    for (SourceFrame frame; source->next(frame);) {
        progress.update(++done);
        if (!frame.fault.empty()) continue;
        FrameTimes times;
        if (contest.process(frame.frame, done % 2 == 0, times)) measured.frames.push_back(times);
        ++measured.all_frames;
    }
    measured.keyframes = contest.mapped;
    if (measured.all_frames > 0)
        measured.mapping_per_frame = contest.mapping_ms / static_cast<double>(measured.all_frames);
    if (contest.mapped > 0)
        measured.mapping_per_keyframe = contest.mapping_ms / static_cast<double>(contest.mapped);
    return measured;
}

using Operation = double (*)(const FrameTimes&);
struct Row {
    const char *pipeline, *operation;
    Operation ms;
};
constexpr Row kRows[] = {
    {"ROEVO", "edge detection", [](const FrameTimes& t) { return t.detect; }},
    {"ROEVO", "organizing edges", [](const FrameTimes& t) { return t.organize; }},
    {"ROEVO", "coarse tracking", [](const FrameTimes& t) { return t.coarse; }},
    {"ROEVO", "registration", [](const FrameTimes& t) { return t.registration; }},
    {"ROEVO", "sum", [](const FrameTimes& t) { return t.detect + t.organize + t.coarse + t.registration; }},
    {"distance field", "edge detection", [](const FrameTimes& t) { return t.detect; }},
    {"distance field", "building the field", [](const FrameTimes& t) { return t.field; }},
    {"distance field", "coarse tracking", [](const FrameTimes& t) { return t.coarse_field; }},
    {"distance field", "registration", [](const FrameTimes& t) { return t.registration_field; }},
    {"distance field", "sum",
     [](const FrameTimes& t) { return t.detect + t.field + t.coarse_field + t.registration_field; }},
    {"distance field", "building the field (5x5 approximation)",
     [](const FrameTimes& t) { return t.field_5x5; }},
    {"ROEVO", "whole frame", [](const FrameTimes& t) { return t.whole; }},
};

std::vector<double> values(const Measured& measured, Operation ms) {
    std::vector<double> all;
    for (const FrameTimes& times : measured.frames) all.push_back(ms(times));
    return all;
}
double middle(const Measured& measured, Operation ms) {
    return median(values(measured, ms)).value_or(0);
}

void addRows(CsvTable& table, const Measured& measured) {
    for (const Row& row : kRows) {
        const std::vector<double> ms = values(measured, row.ms);
        const ErrorStatistics statistics = errorStatistics(ms);
        table.add({measured.name, row.pipeline, row.operation, CsvTable::number(statistics.median, 4),
                   CsvTable::number(percentile(ms, 0.95), 4), CsvTable::number(statistics.mean, 4),
                   std::to_string(ms.size())});
    }
    table.add({measured.name, "ROEVO local mapping", "per frame", "", "",
               CsvTable::number(measured.mapping_per_frame, 4), std::to_string(measured.all_frames)});
    table.add({measured.name, "ROEVO local mapping", "per keyframe", "", "",
               CsvTable::number(measured.mapping_per_keyframe, 4), std::to_string(measured.keyframes)});
}

/// Stacked bars, three for each recording: our tracking, the distance field's, our mapping.
void draw(StudyReport& report, const std::string& folder, const std::vector<Measured>& all) {
    constexpr int kBlocks = 6;  // detection, organizing, field, coarse, registration, mapping
    constexpr std::array<const char*, kBlocks> kNames = {
        "edge detection",  "organizing edges", "building the distance field",
        "coarse tracking", "registration",     "local mapping (mean per frame)"};
    constexpr std::array<int, kBlocks> kColours = {7, 3, 2, 6, 1, 5};
    std::vector<std::vector<double>> bars;
    std::string tics, labels;
    for (std::size_t r = 0; r < all.size(); ++r) {
        const Measured& m = all[r];
        const double at = 4 * static_cast<double>(r);
        const auto ms = [&](std::size_t row) { return middle(m, kRows[row].ms); };
        const double blocks[3][kBlocks] = {{ms(0), ms(1), 0, ms(2), ms(3), 0},
                                           {ms(5), 0, ms(6), ms(7), ms(8), 0},
                                           {0, 0, 0, 0, 0, m.mapping_per_frame}};
        constexpr std::array<const char*, 3> kShort = {"ROEVO", "DF", "map"};
        for (std::size_t b = 0; b < 3; ++b) {
            std::vector<double> bar{at + static_cast<double>(b)};
            double sum = 0;
            for (const double block : blocks[b]) bar.push_back(sum += block);
            bars.push_back(bar);
            tics += (tics.empty() ? "" : ", ") + gnuplotText(kShort[b]) + format(" %g", bar[0]);
        }
        labels += format("set label %zu ", r + 1) + gnuplotText(m.name) +
                  format(" at first %g, graph -0.13 center\n", at + 1);
    }
    std::string script = gnuplotData("bars", bars) + labels +
                         "set title 'Time per frame on one core (medians)'\nset ylabel 'ms'\n"
                         "set yrange [0:*]\nset xtics scale 0 (" +
                         tics + ")\n" +
                         format("set xrange [-0.8:%g]\n", 4.0 * static_cast<double>(all.size()) - 1.2) +
                         "set boxwidth 0.8\nset grid noxtics\nset bmargin 4.5\n"
                         "set key outside right center Left reverse invert\nplot ";
    for (int block = kBlocks; block-- > 0;)  // the higher ones first, the lower ones over them
        script += format("$bars using 1:%d with boxes lt %d title ", block + 2,
                         kColours[static_cast<std::size_t>(block)]) +
                  gnuplotText(kNames[static_cast<std::size_t>(block)]) + (block > 0 ? ", " : "\n");
    const int width = std::clamp(420 + 190 * static_cast<int>(all.size()), 760, 1600);
    addPlot(report, folder, "efficiency.svg", script, width, 460);
}

}  // namespace

StudyReport studyEfficiency(const std::vector<StudyInput>& inputs, const std::string& folder) {
    const OneThread one_thread;
    StudyReport report;
    CsvTable table({"recording", "pipeline", "operation", "median_ms", "p95_ms", "mean_ms", "count"});
    std::vector<Measured> all;
    Measured together;
    Progress progress("efficiency", 0);
    std::size_t done = 0;
    double mapping = 0;
    for (const StudyInput& input : inputs) {
        Measured measured = measure(input, progress, done);
        if (measured.frames.empty()) {
            report.notes.push_back(input.name + ": no frame was tracked by both methods");
            continue;
        }
        addRows(table, measured);
        mapping += measured.mapping_per_frame * static_cast<double>(measured.all_frames);
        together.all_frames += measured.all_frames;
        together.frames.insert(together.frames.end(), measured.frames.begin(), measured.frames.end());
        all.push_back(std::move(measured));
    }
    progress.finish();
    addTable(report, folder, "efficiency.csv", table);
    report.notes.push_back(
        "efficiency: only frames that both tracked; the field is exact (OpenCV, DIST_MASK_PRECISE); left out "
        "on "
        "both sides: undistortion, image pyramid, lifting a keyframe's edges, the keyframe rule");
    if (all.empty()) {
        report.summary = "no frame was tracked by both methods";
        return report;
    }
    draw(report, folder, all);
    const auto ms = [&](std::size_t row) { return middle(together, kRows[row].ms); };
    report.summary = format(
        "medians: organizing edges %.2f ms, distance field %.2f ms; registration %.2f ms, by the field %.2f "
        "ms; "
        "in all %.2f ms and %.2f ms; mapping %.2f ms per frame",
        ms(1), ms(6), ms(3), ms(8), ms(4), ms(9), mapping / static_cast<double>(together.all_frames));
    return report;
}

}  // namespace roevo
