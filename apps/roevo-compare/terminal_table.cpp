#include "terminal_table.h"

#include <algorithm>
#include <cstdio>
#include <optional>
#include <set>

#include "report/results.h"
#include "support/text.h"

namespace roevo {
namespace {

struct Column {
    const char* head;
    int decimals;
    std::optional<double> (*value)(const MethodRun& run, const EvaluatedRun& evaluated);
};

std::optional<double> rmse(const ErrorStatistics& statistics, double scale) {
    return statistics.count > 0 ? std::optional(statistics.rmse * scale) : std::nullopt;
}

const Column kColumns[] = {
    {"ATE cm", 3,
     [](const MethodRun&, const EvaluatedRun& e) {
         return e.evaluation ? rmse(e.evaluation->ate.translation, 100) : std::nullopt;
     }},
    {"RPE cm/s", 3,
     [](const MethodRun&, const EvaluatedRun& e) {
         return e.evaluation ? rmse(e.evaluation->rpe_second.translation, 100) : std::nullopt;
     }},
    {"deg/s", 3,
     [](const MethodRun&, const EvaluatedRun& e) {
         return e.evaluation ? rmse(e.evaluation->rpe_second.rotation, 1) : std::nullopt;
     }},
    {"tracked %", 1,
     [](const MethodRun& run, const EvaluatedRun&) {
         const auto share = trackedShare(run);
         return share ? std::optional(100 * *share) : std::nullopt;
     }},
    {"ms", 2, [](const MethodRun& run, const EvaluatedRun&) { return std::optional(run.total.median); }},
    {"ms 95 %", 2, [](const MethodRun& run, const EvaluatedRun&) { return std::optional(run.total.p95); }},
    {"CPU ms", 2,
     [](const MethodRun& run, const EvaluatedRun&) { return std::optional(run.cpu_ms_per_frame); }},
    {"MB", 0, [](const MethodRun& run, const EvaluatedRun&) { return std::optional(run.memory_peak_mb); }},
};

std::string padded(const std::string& text, std::size_t width) {
    return text + std::string(width - std::min(width, text.size()), ' ');
}

std::string rightAligned(const std::string& text, int width) {
    char out[64];
    std::snprintf(out, sizeof out, "%*s", width, text.c_str());
    return out;
}

constexpr int kWidth = 11;

}  // namespace

std::string terminalTable(const std::vector<SequenceComparison>& sequences) {
    const auto all = evaluateAll(sequences);
    std::size_t width = 0;
    for (const TableMethod& method : tableMethods(all)) width = std::max(width, method.label.size() + 2);
    for (const SequenceComparison& sequence : sequences) width = std::max(width, sequence.name.size());
    std::string text;
    for (const SequenceResults& results : all) {
        const SequenceComparison& sequence = *results.sequence;
        text += "\n" + padded(sequence.name, width);
        if (!sequence.failure.empty()) {
            text += " failed: " + sequence.failure + "\n";
            continue;
        }
        if (sequence.runs.empty()) {
            text += " not run\n";
            continue;
        }
        for (const Column& column : kColumns) text += rightAligned(column.head, kWidth);
        text += '\n';
        std::set<std::string> faults;  // mostly one for all methods
        for (std::size_t i = 0; i < sequence.runs.size(); ++i) {
            const MethodRun& run = sequence.runs[i];
            const EvaluatedRun& evaluated = results.evaluated[i];
            text += padded("  " + run.label, width);
            if (!run.ok()) {
                text += " " + whyNoErrors(sequence, run, evaluated) + "\n";
                continue;
            }
            for (const Column& column : kColumns) {
                const auto value = column.value(run, evaluated);
                text += rightAligned(value ? shownNumber(value, column.decimals) : "-", kWidth);
            }
            text += '\n';
            if (!evaluated.evaluation) faults.insert(whyNoErrors(sequence, run, evaluated));
        }
        for (const std::string& fault : faults) text += "  no errors: " + fault + "\n";
        if (!sequence.note.empty()) text += "  " + sequence.note + "\n";
    }
    return text;
}

}  // namespace roevo
