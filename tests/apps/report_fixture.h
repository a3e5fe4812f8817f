#pragma once
/// Runs with errors that are known by construction.

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <string>
#include <vector>

#include "roevo-compare/report/comparison.h"
#include "support/csv.h"
#include "support/run_program.h"

namespace roevo::test {

inline constexpr char kPython[] = "/usr/bin/python3";

/// A square of 2 m, a corner every half second, camera not turning. Corners alternately `d` too high and too
/// low cannot be aligned any better, so: ATE is d (RMSE, mean, median and maximum), RPE per frame 2 d, RPE
/// over 1 s zero, rotations zero.
inline std::vector<StampedPose> square(double d) {
    const double corners[4][2] = {{1, 1}, {-1, 1}, {-1, -1}, {1, -1}};
    std::vector<StampedPose> poses(4);
    for (std::size_t i = 0; i < 4; ++i) {
        poses[i].timestamp = 1000 + 0.5 * static_cast<double>(i);
        poses[i].T_world_camera.translation() = Eigen::Vector3d(corners[i][0], corners[i][1], i % 2 ? -d : d);
    }
    return poses;
}

inline MethodRun makeRun(const std::string& method, double d) {
    MethodRun run;
    run.method = method;
    run.label = "label of " + method;
    run.note = "note on " + method;
    run.frames = run.tracked = 4;
    run.stages = {{"edges", 2, 3, 2.25}, {"fine", 4, 6, 4.5}};
    run.total = {"total", 6.5, 9, 7};
    run.decode = {"decode", 5, 8, 5.5};
    run.cpu_ms_per_frame = 7.25;
    run.memory_peak_mb = 120;
    run.trajectory = square(d);
    return run;
}

inline MethodRun failedRun(const std::string& method, const std::string& why) {
    MethodRun run;
    run.method = run.label = method;
    run.failure = why;
    return run;
}

inline MethodRun skippedRun(const std::string& method, const std::string& why) {
    MethodRun run;
    run.method = run.label = method;
    run.skipped = why;
    return run;
}

inline SequenceComparison makeSequence(const std::string& name, std::vector<MethodRun> runs) {
    SequenceComparison sequence;
    sequence.name = name;
    sequence.input = "recordings/" + name;
    sequence.ground_truth = sequence.input + "/groundtruth.txt";
    sequence.reference = square(0);
    sequence.runs = std::move(runs);
    return sequence;
}

inline ComparisonInfo makeInfo() {
    ComparisonInfo info;
    info.command = "roevo-compare --input 'a b' --output out";
    info.date = "2026-01-02T03:04:05Z";
    info.machine = "a processor, 2 cores";
    info.versions = {{"roevo", "0.1.0"}};
    return info;
}

/// Writes a comparison into a folder of its own and reads it again.
class WrittenComparison {
  public:
    explicit WrittenComparison(const std::vector<SequenceComparison>& sequences,
                               const ComparisonInfo& info = makeInfo()) {
        writeComparison(folder_.path().string(), sequences, info);
        csv = readFile(folder_ / "table.csv");
        md = readFile(folder_ / "table.md");
        html = readFile(folder_ / "report.html");
        rows = parseCsv(csv);
    }

    /// A row of table.csv; a failure of the test when there is none.
    std::map<std::string, std::string> row(const std::string& sequence, const std::string& method) const {
        for (const auto& row : rows)
            if (row.at("sequence") == sequence && row.at("method") == method) return row;
        ADD_FAILURE() << "no row " << sequence << ", " << method << " in\n" << csv;
        return {};
    }

    std::string path(const std::string& name) const { return folder_ / name; }

    std::string csv, md, html;
    std::vector<std::map<std::string, std::string>> rows;

  private:
    TemporaryFolder folder_;
};

inline bool contains(const std::string& text, const std::string& part) {
    return text.find(part) != std::string::npos;
}

inline std::size_t count(const std::string& text, const std::string& part) {
    std::size_t found = 0;
    for (std::size_t at = 0; (at = text.find(part, at)) != std::string::npos; at += part.size()) ++found;
    return found;
}

}  // namespace roevo::test
