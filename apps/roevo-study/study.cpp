#include "study.h"

#include <algorithm>
#include <cmath>
#include <cstdarg>
#include <cstdio>
#include <filesystem>
#include <stdexcept>

#include "roevo/odometry.h"
#include "support/atomic_file.h"
#include "support/gnuplot.h"

namespace roevo {

StudyRun trackRecording(const StudyInput& input, const OdometryOptions& options) {
    Odometry odometry(input.camera, options);
    StudyRun run;
    std::size_t processed = 0;
    const auto source = input.open();
    for (SourceFrame frame; source->next(frame);) {
        ++run.frames;
        if (!frame.fault.empty()) continue;
        const FrameResult result = odometry.processFrame(frame.frame);
        run.tracked += result.status == FrameStatus::kOk || result.status == FrameStatus::kInitialised;
        run.points += result.num_points;
        ++processed;
    }
    if (processed > 0) run.points /= static_cast<double>(processed);
    run.trajectory = odometry.trajectory();
    for (const KeyframeInfo& keyframe : odometry.keyframes())
        run.keyframe_times.push_back(keyframe.timestamp);
    if (input.ground_truth.empty()) {
        run.fault = input.ground_truth_note;
        return run;
    }
    try {
        run.evaluation = evaluate(input.ground_truth, run.trajectory);
    } catch (const std::exception& e) {
        run.fault = e.what();
    }
    return run;
}

CsvTable::CsvTable(std::vector<std::string> head) : columns_(head.size()) {
    add(head);
}

void CsvTable::add(const std::vector<std::string>& fields) {
    if (fields.size() != columns_)
        throw std::logic_error("a row of " + std::to_string(fields.size()) + " fields in a table of " +
                               std::to_string(columns_));
    for (std::size_t i = 0; i < fields.size(); ++i) {
        if (i > 0) text_ += ',';
        if (fields[i].find_first_of(",\"\n") == std::string::npos) {
            text_ += fields[i];
            continue;
        }
        text_ += '"';
        for (const char c : fields[i]) text_ += c == '"' ? "\"\"" : std::string(1, c);
        text_ += '"';
    }
    text_ += '\n';
}

void CsvTable::write(const std::string& path) const {
    writeTextAtomically(path, text_);
}

std::string CsvTable::number(std::optional<double> value, int digits) {
    return value && std::isfinite(*value) ? format("%.*g", digits, *value) : "";
}

void addPlot(StudyReport& report, const std::string& folder, const std::string& name,
             const std::string& script, int width, int height) {
    try {
        drawSvg((std::filesystem::path(folder) / name).string(), script, width, height);
        report.files.push_back(name);
    } catch (const std::exception& e) {
        if (report.plot_fault.empty()) report.plot_fault = e.what();
    }
}

void addTable(StudyReport& report, const std::string& folder, const std::string& name,
              const CsvTable& table) {
    table.write((std::filesystem::path(folder) / name).string());
    report.files.push_back(name);
}

std::optional<double> median(std::vector<double> values) {
    if (values.empty()) return std::nullopt;
    std::sort(values.begin(), values.end());
    const std::size_t middle = values.size() / 2;
    return values.size() % 2 == 1 ? values[middle] : (values[middle - 1] + values[middle]) / 2;
}

std::string counted(std::size_t count, const std::string& noun) {
    return std::to_string(count) + ' ' + noun + (count == 1 ? "" : "s");
}

std::string format(const char* pattern, ...) {
    char text[1024];
    va_list arguments;
    va_start(arguments, pattern);
    std::vsnprintf(text, sizeof text, pattern, arguments);
    va_end(arguments);
    return text;
}

}  // namespace roevo
