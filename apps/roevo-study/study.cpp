#include "study.h"

#include <algorithm>
#include <cmath>
#include <cstdarg>
#include <cstdio>
#include <filesystem>
#include <stdexcept>

#include "programs/atomic_file.h"
#include "programs/gnuplot.h"
#include "programs/program.h"
#include "programs/text.h"

namespace roevo {

StudyRun trackRecording(const StudyInput& input, const OdometryOptions& options,
                        const FrameObserver& observe) {
    Odometry odometry(input.camera, options);
    StudyRun run;
    std::size_t processed = 0;
    bool begun = false;
    const auto source = input.open();
    for (SourceFrame frame; source->next(frame);) {
        ++run.frames;
        if (!frame.fault.empty()) continue;
        const FrameResult result = odometry.processFrame(frame.frame);
        const bool first = result.status == FrameStatus::kInitialised && !begun;  // later ones: lost before
        begun = begun || first;
        run.tracked += result.status == FrameStatus::kOk || first;
        run.points += result.num_points;
        if (observe) observe(result, odometry);
        ++processed;
    }
    if (processed > 0) run.points /= static_cast<double>(processed);
    odometry.refineAll();
    run.trajectory = odometry.trajectory();
    run.live = odometry.liveTrajectory();
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

void forEachInput(const std::vector<StudyInput>& inputs, StudyReport& report,
                  const std::function<void(const StudyInput&)>& measure) {
    for (const StudyInput& input : inputs) {
        try {
            measure(input);
        } catch (const std::exception& e) {
            report.left_out.push_back({input.name, firstLine(e.what())});
        }
    }
    if (!inputs.empty() && report.left_out.size() == inputs.size())
        throw std::runtime_error(report.left_out.front().name + ": " + report.left_out.front().reason +
                                 (inputs.size() > 1 ? "; nor could any other recording be used" : ""));
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
        text_ += csvField(fields[i]);
    }
    text_ += '\n';
}

void CsvTable::write(const std::string& path) const {
    writeTextAtomically(path, text_);
}

std::string CsvTable::number(std::optional<double> value, int digits) {
    return value && std::isfinite(*value) ? format("%.*g", digits, *value) : "";
}

std::string markdownTable(const std::vector<std::vector<std::string>>& rows) {
    std::string text;
    for (std::size_t r = 0; r < rows.size(); ++r) {
        text += '|';
        for (const std::string& field : rows[r]) {
            text += ' ';
            for (const char c : field) text += c == '|' ? "\\|" : std::string(1, c);  // would end the cell
            text += field.empty() ? "|" : " |";
        }
        text += '\n';
        if (r > 0) continue;
        text += '|';
        for (std::size_t i = 0; i < rows[r].size(); ++i) text += "---|";
        text += '\n';
    }
    return text;
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

std::string plotLabel(const std::string& name) {
    constexpr std::size_t kLongest = 19;  // characters in a line
    std::vector<std::string> lines(1);
    std::string word;
    const auto takeWord = [&] {
        if (!lines.back().empty() && lines.back().size() + word.size() > kLongest) lines.emplace_back();
        lines.back() += word;
        word.clear();
    };
    for (const char c : name) {
        word += c;
        if (c == '_' || c == '-' || c == ' ') takeWord();
    }
    takeWord();
    std::string text;
    for (const std::string& line : lines) text += (text.empty() ? "" : ".\"\\n\".") + gnuplotText(line);
    return text;
}

std::string plotTics(const std::vector<std::string>& names) {
    std::string text;
    for (std::size_t i = 0; i < names.size(); ++i)
        text += (i > 0 ? ", " : "(") + plotLabel(names[i]) + ' ' + std::to_string(i);
    return text + ")";
}

int plotWidth(std::size_t names, int rest) {
    return std::clamp(rest + 170 * static_cast<int>(names), 760, 2000);
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

std::string format(const char* pattern, ...) {
    char text[2048];
    va_list arguments;
    va_start(arguments, pattern);
    std::vsnprintf(text, sizeof text, pattern, arguments);
    va_end(arguments);
    return text;
}

}  // namespace roevo
