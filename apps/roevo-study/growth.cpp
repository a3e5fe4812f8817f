// What time and memory grow with: the size of the images, the number of edges, the length of the recording.
#include <malloc.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <stdexcept>

#include "evaluation/error_statistics.h"
#include "programs/gnuplot.h"
#include "programs/progress.h"
#include "programs/text.h"
#include "stopwatch.h"
#include "study.h"
#include "study_source.h"

namespace roevo {
namespace {

constexpr double kSizeFactors[] = {0.5, 0.75, 1, 1.5, 2, 3};  // of the images' width and height
constexpr std::size_t kFramesOfSizes = 150;                   // at each of these sizes
constexpr std::size_t kFewestOfPiece = 25;                    // frames that a point of a curve stands for
constexpr std::size_t kMostPieces = 40;                       // of a curve

/// Held by this process's allocator, images included, MB.
double memoryInUseMb() {
    const struct mallinfo2 info = mallinfo2();
    return static_cast<double>(info.uordblks + info.hblkhd) / 1e6;
}

struct FrameCost {
    double points = 0, ms = 0;  ///< on edges; processor time of the thread that tracks
    double mapping_ms = 0;      ///< processor time, where a map took effect with this frame, else 0
    double memory_mb = 0;       ///< since before the first frame
    std::size_t keyframes = 0;  ///< so far
};

struct SizedRun {
    PinholeCamera camera;
    std::vector<FrameCost> frames;
    StudyRun run;

    std::vector<double> values(double FrameCost::*member) const {
        std::vector<double> all;
        for (const FrameCost& frame : frames) all.push_back(frame.*member);
        return all;
    }
    double megapixels() const { return 1e-6 * camera.width * camera.height; }
    double medianMs() const { return median(values(&FrameCost::ms)).value_or(0); }
    /// ms that 95 % of the frames stay below.
    double slowMs() const { return percentile(values(&FrameCost::ms), 0.95); }
    double mappingMs() const {  ///< of a keyframe, mean
        double sum = 0, keyframes = 0;
        for (const FrameCost& frame : frames) {
            sum += frame.mapping_ms;
            keyframes += frame.mapping_ms > 0;
        }
        return keyframes > 0 ? sum / keyframes : 0;
    }
    std::optional<double> ate() const {
        return run.evaluation ? std::make_optional(run.evaluation->ate.translation.rmse) : std::nullopt;
    }
};

SizedRun measure(const StudyInput& recording, double factor, std::size_t frames) {
    StudyInput input = recording;
    input.open = [&recording, factor, frames] {
        auto source = firstFrames(recording.open(), frames);
        return factor == 1 ? std::move(source) : prefetch(resized(std::move(source), factor));
    };
    input.camera = input.open()->camera();
    SizedRun result;
    result.camera = input.camera;
    const double memory_before = memoryInUseMb();
    CpuStopwatch stopwatch;
    std::size_t keyframes = 0;
    result.run = trackRecording(input, input.options, [&](const FrameResult& frame, const Odometry&) {
        const double ms = stopwatch.milliseconds();
        keyframes += frame.new_keyframe;
        result.frames.push_back({static_cast<double>(frame.num_points), ms, frame.ms.mapping_cpu,
                                 memoryInUseMb() - memory_before, keyframes});
        stopwatch = CpuStopwatch();
    });
    return result;
}

/// Medians of pieces of the frames, as many in each: rows of `x`, `y`, in the order that the frames are in.
std::vector<std::vector<double>> curve(const std::vector<FrameCost>& frames,
                                       const std::function<double(std::size_t)>& x, double FrameCost::*y) {
    const std::size_t pieces = std::clamp<std::size_t>(frames.size() / kFewestOfPiece, 1, kMostPieces);
    std::vector<std::vector<double>> rows;
    for (std::size_t piece = 0; piece < pieces; ++piece) {
        std::vector<double> of_x, of_y;
        const std::size_t end = (piece + 1) * frames.size() / pieces;
        for (std::size_t i = piece * frames.size() / pieces; i < end; ++i) {
            of_x.push_back(x(i));
            of_y.push_back(frames[i].*y);
        }
        rows.push_back({median(of_x).value_or(0), median(of_y).value_or(0)});
    }
    return rows;
}

/// One line for each recording. @param rows  by recording: x, y
struct GrowthPanel {
    std::string x_label, y_label;
    std::vector<std::vector<std::vector<double>>> rows;
};

/// Between labels that have room beside each other, up to five digits each.
double ticStep(const GrowthPanel& panel) {
    constexpr double kMostSteps = 5.5;
    double largest = 1e-9;
    for (const auto& rows : panel.rows)
        for (const auto& row : rows) largest = std::max(largest, row[0]);
    const double least = largest / kMostSteps, decade = std::pow(10, std::floor(std::log10(least)));
    for (const double digit : {1, 2, 5})
        if (digit * decade >= least) return digit * decade;
    return 10 * decade;
}

void draw(StudyReport& report, const std::string& folder, const std::string& name, const std::string& title,
          const std::vector<std::string>& recordings, const std::vector<GrowthPanel>& panels) {
    std::string script = "set multiplot layout 1," + std::to_string(panels.size()) + " title " +
                         gnuplotText(title) + "\nset yrange [0:*]\nset xrange [0:*]\nset key top left\n" +
                         "set offsets 0, 0, graph 0.35, 0\n";
    for (std::size_t p = 0; p < panels.size(); ++p) {
        std::string plot;
        for (std::size_t i = 0; i < recordings.size(); ++i) {
            const std::string block = "p" + std::to_string(p) + "r" + std::to_string(i);
            script += gnuplotData(block, panels[p].rows[i]);
            plot += (i > 0 ? ", " : "plot ") + ("$" + block) + " with linespoints pt 7 ps 0.5 lt " +
                    std::to_string(i % 8 + 1) + " title " + gnuplotText(recordings[i]);
        }
        script += "set xlabel " + gnuplotText(panels[p].x_label) + "\nset ylabel " +
                  gnuplotText(panels[p].y_label) + "\nset xtics 0, " + format("%g", ticStep(panels[p])) +
                  '\n' + plot + "\nset key off\n";
    }
    addPlot(report, folder, name, script + "unset multiplot\n", 980, 440);
}

void addSize(const std::string& recording, const SizedRun& run, CsvTable& table,
             std::vector<std::vector<std::string>>& shown) {
    const FrameCost& last = run.frames.back();
    const auto ate = run.ate();
    table.add({recording, std::to_string(run.camera.width), std::to_string(run.camera.height),
               std::to_string(run.frames.size()), std::to_string(run.run.tracked),
               std::to_string(last.keyframes), CsvTable::number(run.run.points),
               CsvTable::number(run.medianMs(), 4), CsvTable::number(run.slowMs(), 4),
               CsvTable::number(run.mappingMs(), 4), CsvTable::number(last.memory_mb, 4),
               CsvTable::number(ate)});
    shown.push_back({recording, format("%d x %d", run.camera.width, run.camera.height),
                     format("%.0f", run.run.points), format("%.1f", run.medianMs()),
                     format("%.1f", run.slowMs()), format("%.1f", run.mappingMs()),
                     format("%.0f", last.memory_mb), ate ? format("%.2f", 100 * *ate) : "-"});
}

void addFrames(const std::string& recording, const std::vector<FrameCost>& frames, CsvTable& table) {
    for (std::size_t i = 0; i < frames.size(); ++i)
        table.add({recording, std::to_string(i), CsvTable::number(frames[i].points),
                   std::to_string(frames[i].keyframes), CsvTable::number(frames[i].ms, 4),
                   CsvTable::number(frames[i].mapping_ms, 4), CsvTable::number(frames[i].memory_mb, 5)});
}

struct OfRecording {
    std::vector<SizedRun> sizes;  ///< of its first frames, by factor
    SizedRun whole;               ///< as recorded
};

void drawAll(StudyReport& report, const std::string& folder, const std::vector<std::string>& names,
             const std::vector<OfRecording>& recordings) {
    GrowthPanel time{"megapixels", "time per frame (ms), median", {}},
        memory{"megapixels", "memory (MB)", {}}, edges{"points on edges", "time per frame (ms), median", {}},
        late{"frame", "time per frame (ms), median", {}}, held{"frame", "memory (MB)", {}};
    for (const OfRecording& runs : recordings) {
        for (GrowthPanel* panel : {&time, &memory}) panel->rows.emplace_back();
        for (const SizedRun& run : runs.sizes) {
            time.rows.back().push_back({run.megapixels(), run.medianMs()});
            memory.rows.back().push_back({run.megapixels(), run.frames.back().memory_mb});
        }
        std::vector<FrameCost> frames = runs.whole.frames;
        const auto number = [](std::size_t i) { return static_cast<double>(i); };
        late.rows.push_back(curve(frames, number, &FrameCost::ms));
        held.rows.push_back(curve(frames, number, &FrameCost::memory_mb));
        std::sort(frames.begin(), frames.end(),
                  [](const FrameCost& a, const FrameCost& b) { return a.points < b.points; });
        edges.rows.push_back(curve(
            frames, [&](std::size_t i) { return frames[i].points; }, &FrameCost::ms));
    }
    draw(report, folder, "growth_size.svg", "Size of the images", names, {time, memory});
    draw(report, folder, "growth_edges.svg", "Number of edge points, as recorded", names, {edges});
    draw(report, folder, "growth_length.svg", "Length of the recording, as recorded", names, {late, held});
}

}  // namespace

StudyReport studyGrowth(const std::vector<StudyInput>& inputs, const std::string& folder) {
    StudyReport report;
    CsvTable sizes({"recording", "width", "height", "frames", "tracked", "keyframes", "points", "ms_median",
                    "ms_95", "mapping_ms", "memory_mb", "ate_m"});
    CsvTable of_frames({"recording", "frame", "points", "keyframes", "ms", "mapping_ms", "memory_mb"});
    std::vector<std::vector<std::string>> shown{
        {"recording", "size", "points on edges", "ms per frame: median", "95 % below",
         "ms per keyframe, mapping", "memory at the end, MB", "ATE, cm"}};
    std::vector<std::string> names;
    std::vector<OfRecording> recordings;
    Progress progress("growth", inputs.size() * std::size(kSizeFactors));
    std::size_t done = 0;
    forEachInput(inputs, report, [&](const StudyInput& input) {
        OfRecording runs;
        runs.whole = measure(input, 1, std::numeric_limits<std::size_t>::max());
        for (const double factor : kSizeFactors) {
            runs.sizes.push_back(measure(input, factor, kFramesOfSizes));
            if (runs.sizes.back().frames.empty()) throw std::runtime_error("no frame could be read");
            progress.update(++done);
        }
        for (const SizedRun& run : runs.sizes) addSize(input.name, run, sizes, shown);
        addFrames(input.name, runs.whole.frames, of_frames);
        names.push_back(input.name);
        recordings.push_back(std::move(runs));
    });
    progress.finish();
    addTable(report, folder, "growth_sizes.csv", sizes);
    addTable(report, folder, "growth_frames.csv", of_frames);
    drawAll(report, folder, names, recordings);
    report.summary =
        counted(recordings.size(), "recording") + " at " + std::to_string(std::size(kSizeFactors)) + " sizes";
    report.table = markdownTable(shown);
    report.notes.push_back(
        "Times are processor time, without decoding: of the thread that tracks, and of mapping beside it. "
        "Memory is what the program holds at the end of the recording, over what it held before. Images are "
        "shrunk by averaging and enlarged by cubic interpolation, depth by its nearest pixel.");
    return report;
}

}  // namespace roevo
