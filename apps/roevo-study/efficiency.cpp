// Time of every operation, ours against registration by a distance field (the paper's "Efficiency Analysis"):
// both odometries take turns on every frame, in one process, so that noise hits both alike. Every recording
// is run several times and an operation's time on a frame is the least of them: the work is the same every
// time, and whatever else the computer does only adds to it.
#include <algorithm>
#include <array>
#include <ctime>
#include <numeric>
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

/// Processor time of this thread, ms: other programs and the mapping thread do not count.
double processorTime() {
    timespec now{};
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
    return 1e3 * static_cast<double>(now.tv_sec) + 1e-6 * static_cast<double>(now.tv_nsec);
}

/// Milliseconds of the processor that `work` takes.
template <class Work>
double timed(Work&& work) {
    const double start = processorTime();
    work();
    return processorTime() - start;
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

constexpr int kPasses = 3;

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
    kOperations
};
using FrameTimes = std::array<double, kOperations>;  // ms

/// Edges of one image, and a distance field of them.
class FeatureProcessing {
  public:
    FeatureProcessing(const PinholeCamera& camera, const EdgeOptions& options)
        : camera_(camera), options_(options), undistorter_(camera) {}

    void measure(const cv::Mat& grey, FrameTimes& times) {
        const cv::Mat& image = undistorter_.apply(grey, undistorted_);
        times[kDetect] = timed([&] {
            computeGradient(image, options_.blur_sigma, gradient_);
            const double high = std::max(options_.min_high_threshold,
                                         options_.canny_high_factor * otsuThreshold(gradient_.magnitude));
            canny(gradient_, options_.canny_low_ratio * high, high, mask_);
        });
        times[kField] = timed([&] { field_.build(mask_.mask); });
        times[kField5x5] = timed([&] {
            cv::compare(mask_.mask, 0, background_, cv::CMP_EQ);
            cv::distanceTransform(background_, approximate_, cv::DIST_L2, cv::DIST_MASK_5, CV_32F);
        });
        times[kOrganize] = timed([&] {  // last: it changes the mask
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
            FrameResult result;
            const double whole = timed([&] { result = (ours ? ours_ : theirs_).processFrame(frame); });
            both = both && result.status == FrameStatus::kOk;
            if (ours) {
                if (result.ms.mapping > 0) mapping.push_back(result.ms.mapping);
                times[kCoarse] = result.ms.coarse;
                times[kRegistration] = registration_;
                times[kWhole] = whole;
                // Waits for the map, so that it is not at work while others are timed
                if (result.new_keyframe) ours_.trajectory();
            } else {
                times[kCoarseField] = result.ms.coarse;
                times[kRegistrationField] = registration_;
            }
        }
        if (both) features_.measure(frame.grey, times);
        return both;
    }

    std::vector<double> mapping;  ///< ms, of every keyframe whose map took effect

  private:
    static void prepare(FineTracker&, const FineFrame&) {}
    // Building the field is timed apart
    static void prepare(DistanceFieldTracker& tracker, const FineFrame& frame) { tracker.prepare(frame); }

    template <class Tracker>
    OdometryStages stages(Tracker& tracker) {
        OdometryStages stages;
        stages.registration = [this, &tracker](const Keyframe& keyframe, const FineFrame& frame,
                                               const Pose& T_start, const PosePrior& prior,
                                               const RollingShutter& shutter, const Brightness& brightness) {
            prepare(tracker, frame);
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
    std::vector<double> mapping;  // ms, of every keyframe
    std::size_t all_frames = 0;

    double mappingSum() const { return std::accumulate(mapping.begin(), mapping.end(), 0.0); }
    double mappingPerFrame() const {
        return all_frames > 0 ? mappingSum() / static_cast<double>(all_frames) : 0;
    }
};

Measured measureOnce(const StudyInput& input, bool ours_first, Progress& progress, std::size_t& done) {
    Measured measured;
    measured.name = input.name;
    Contest contest(input);
    const auto source = input.open();
    for (SourceFrame frame; source->next(frame);) {
        progress.update(++done);
        if (!frame.fault.empty()) continue;
        FrameTimes times{};
        if (contest.process(frame.frame, ours_first, times)) measured.frames.push_back(times);
        ours_first = !ours_first;
        ++measured.all_frames;
    }
    measured.mapping = contest.mapping;
    return measured;
}

Measured measure(const StudyInput& input, Progress& progress, std::size_t& done) {
    Measured least = measureOnce(input, true, progress, done);
    const auto take = [](double& a, double b) { a = std::min(a, b); };
    for (int pass = 1; pass < kPasses; ++pass) {
        const Measured again = measureOnce(input, pass % 2 == 0, progress, done);
        for (std::size_t i = 0; i < std::min(least.frames.size(), again.frames.size()); ++i)
            for (std::size_t k = 0; k < kOperations; ++k) take(least.frames[i][k], again.frames[i][k]);
        for (std::size_t i = 0; i < std::min(least.mapping.size(), again.mapping.size()); ++i)
            take(least.mapping[i], again.mapping[i]);
    }
    return least;
}

struct Row {
    const char *pipeline, *operation;
    std::vector<Operation> parts;  // that are added up
};
const std::vector<Row>& rows() {
    static const std::vector<Row> rows = {
        {"ROEVO", "edge detection", {kDetect}},
        {"ROEVO", "organizing edges", {kOrganize}},
        {"ROEVO", "coarse tracking", {kCoarse}},
        {"ROEVO", "registration", {kRegistration}},
        {"ROEVO", "sum", {kDetect, kOrganize, kCoarse, kRegistration}},
        {"distance field", "edge detection", {kDetect}},
        {"distance field", "building the field", {kField}},
        {"distance field", "coarse tracking", {kCoarseField}},
        {"distance field", "registration", {kRegistrationField}},
        {"distance field", "sum", {kDetect, kField, kCoarseField, kRegistrationField}},
        {"distance field", "building the field (5x5 approximation)", {kField5x5}},
        {"ROEVO", "whole frame", {kWhole}},
    };
    return rows;
}

std::vector<double> values(const Measured& measured, const std::vector<Operation>& parts) {
    std::vector<double> all;
    for (const FrameTimes& times : measured.frames) {
        double sum = 0;
        for (const Operation part : parts) sum += times[part];
        all.push_back(sum);
    }
    return all;
}
double middle(const Measured& measured, const std::vector<Operation>& parts) {
    return median(values(measured, parts)).value_or(0);
}

void addRows(CsvTable& table, const Measured& measured) {
    for (const Row& row : rows()) {
        const std::vector<double> ms = values(measured, row.parts);
        const ErrorStatistics statistics = errorStatistics(ms);
        table.add({measured.name, row.pipeline, row.operation, CsvTable::number(statistics.median, 4),
                   CsvTable::number(percentile(ms, 0.95), 4), CsvTable::number(statistics.mean, 4),
                   std::to_string(ms.size())});
    }
    const ErrorStatistics mapping = errorStatistics(measured.mapping);
    table.add({measured.name, "ROEVO local mapping", "per frame", "", "",
               CsvTable::number(measured.mappingPerFrame(), 4), std::to_string(measured.all_frames)});
    table.add({measured.name, "ROEVO local mapping", "per keyframe", CsvTable::number(mapping.median, 4),
               CsvTable::number(percentile(measured.mapping, 0.95), 4), CsvTable::number(mapping.mean, 4),
               std::to_string(mapping.count)});
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
        const auto ms = [&](Operation operation) { return middle(m, {operation}); };
        const double blocks[3][kBlocks] = {
            {ms(kDetect), ms(kOrganize), 0, ms(kCoarse), ms(kRegistration), 0},
            {ms(kDetect), 0, ms(kField), ms(kCoarseField), ms(kRegistrationField), 0},
            {0, 0, 0, 0, 0, m.mappingPerFrame()}};
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
        mapping += measured.mappingSum();
        together.all_frames += measured.all_frames;
        together.frames.insert(together.frames.end(), measured.frames.begin(), measured.frames.end());
        all.push_back(std::move(measured));
    }
    progress.finish();
    addTable(report, folder, "efficiency.csv", table);
    report.notes.push_back("efficiency: only frames that both tracked, the least of " +
                           std::to_string(kPasses) +
                           " runs; the field is exact (OpenCV, DIST_MASK_PRECISE); left out on both sides: "
                           "undistortion, image pyramid, lifting a keyframe's edges, the keyframe rule");
    if (all.empty()) {
        report.summary = "no frame was tracked by both methods";
        return report;
    }
    draw(report, folder, all);
    const auto ms = [&](const std::vector<Operation>& parts) { return middle(together, parts); };
    report.summary = format(
        "medians: organizing edges %.2f ms, distance field %.2f ms; registration %.2f ms, by the field %.2f "
        "ms; "
        "in all %.2f ms and %.2f ms; mapping %.2f ms per frame",
        ms({kOrganize}), ms({kField}), ms({kRegistration}), ms({kRegistrationField}),
        ms({kDetect, kOrganize, kCoarse, kRegistration}),
        ms({kDetect, kField, kCoarseField, kRegistrationField}),
        mapping / static_cast<double>(together.all_frames));
    return report;
}

}  // namespace roevo
