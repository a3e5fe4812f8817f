// Time of every operation, ours against registration by a distance field (the paper's "Efficiency Analysis").
#include "efficiency.h"

#include <algorithm>
#include <stdexcept>

#include "efficiency_registration.h"
#include "evaluation/error_statistics.h"
#include "programs/gnuplot.h"

namespace roevo {
namespace {

struct OperationRow {
    const char *pipeline, *operation;
    std::vector<Operation> parts;  // that are added up
};
const std::vector<OperationRow>& rows() {
    static const std::vector<OperationRow> rows = {
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
    for (const OperationRow& row : rows()) {
        const std::vector<double> ms = values(measured, row.parts);
        const ErrorStatistics statistics = errorStatistics(ms);
        table.add({measured.name, row.pipeline, row.operation, CsvTable::number(statistics.median, 4),
                   CsvTable::number(percentile(ms, 0.95), 4), CsvTable::number(statistics.mean, 4),
                   std::to_string(ms.size())});
    }
    table.add({measured.name, "ROEVO local mapping", "per frame", "", "",
               CsvTable::number(measured.mappingPerFrame(), 4), std::to_string(measured.all_frames)});
    if (measured.mapping.empty()) return;
    const ErrorStatistics mapping = errorStatistics(measured.mapping);
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
            {0, 0, 0, 0, 0, m.mappingPerFrame().value_or(0)}};
        constexpr std::array<const char*, 3> kShort = {"ROEVO", "DF", "map"};
        for (std::size_t b = 0; b < 3; ++b) {
            std::vector<double> bar{at + static_cast<double>(b)};
            double sum = 0;
            for (const double block : blocks[b]) bar.push_back(sum += block);
            bars.push_back(bar);
            tics += (tics.empty() ? "" : ", ") + gnuplotText(kShort[b]) + format(" %g", bar[0]);
        }
        labels += format("set label %zu ", r + 1) + plotLabel(m.name) +
                  format(" at first %g, graph -0.14 center\n", at + 1);
    }
    std::string script =
        gnuplotData("bars", bars) + labels +
        "set title 'Processor time per frame (medians)'\nset ylabel "
        "'ms'\n"
        "set yrange [0:*]\nset xtics scale 0 (" +
        tics + ")\n" + format("set xrange [-0.8:%g]\n", 4.0 * static_cast<double>(all.size()) - 1.2) +
        "set boxwidth 0.8\nset style fill solid 1.0 noborder\nset grid noxtics\nset bmargin 6\n"
        "set key outside right center Left reverse invert title 'DF: distance field instead'\nplot ";
    for (int block = kBlocks; block-- > 0;)  // the higher ones first, the lower ones over them
        script += format("$bars using 1:%d with boxes lt %d title ", block + 2,
                         kColours[static_cast<std::size_t>(block)]) +
                  gnuplotText(kNames[static_cast<std::size_t>(block)]) + (block > 0 ? ", " : "\n");
    addPlot(report, folder, "efficiency.svg", script, plotWidth(all.size(), 480), 480);
}

}  // namespace

StudyReport studyEfficiency(const std::vector<StudyInput>& inputs, const std::string& folder) {
    StudyReport report;
    CsvTable table({"recording", "pipeline", "operation", "median_ms", "p95_ms", "mean_ms", "count"});
    std::vector<Measured> all;
    Measured together;
    together.name = "all";
    Progress progress("efficiency", 0);
    std::size_t done = 0;
    forEachInput(inputs, report, [&](const StudyInput& input) {
        Measured measured = measureEfficiency(input, progress, done);
        if (measured.frames.empty()) throw std::runtime_error("no frame was tracked by both methods");
        addRows(table, measured);
        together.mapping.insert(together.mapping.end(), measured.mapping.begin(), measured.mapping.end());
        together.all_frames += measured.all_frames;
        together.work.insert(together.work.end(), measured.work.begin(), measured.work.end());
        together.frames.insert(together.frames.end(), measured.frames.begin(), measured.frames.end());
        all.push_back(std::move(measured));
    });
    progress.finish();
    addTable(report, folder, "efficiency.csv", table);
    report.notes.push_back(
        "Only frames that both tracked; of " + std::to_string(kEfficiencyPasses) +
        " runs the least time of every frame and operation. Processor time of the tracking thread, one core; "
        "mapping by the clock, in a thread of its own. The field is exact (OpenCV, DIST_MASK_PRECISE). Left "
        "out on both sides: undistortion, image pyramid, lifting a keyframe's edges, the keyframe rule.");
    draw(report, folder, all);
    const auto ms = [&](const std::vector<Operation>& parts) { return middle(together, parts); };
    report.summary = format(
        "medians: organizing edges %.2f ms, distance field %.2f ms; registration %.2f ms, by the field %.2f "
        "ms; in all %.2f ms and %.2f ms",
        ms({kOrganize}), ms({kField}), ms({kRegistration}), ms({kRegistrationField}),
        ms({kDetect, kOrganize, kCoarse, kRegistration}),
        ms({kDetect, kField, kCoarseField, kRegistrationField}));
    report.summary += "; " + reportRegistrations(report, folder, all, together, inputs.front().options.fine);
    const std::optional<double> mapping = together.mappingPerFrame();
    report.summary += mapping ? format("; mapping %.2f ms per frame", *mapping) : "; no map was made in time";
    return report;
}

}  // namespace roevo
