#include "terminal_table.h"

#include <algorithm>
#include <cstdio>
#include <set>

#include "programs/text.h"
#include "report/metrics.h"
#include "report/remarks.h"
#include "report/results.h"

namespace roevo {
namespace {

// Of shownMetrics(); heads are shorter here.
struct Column {
    const char* head;
    std::size_t metric;
};
constexpr Column kColumns[] = {{"ATE cm", 0}, {"RPE cm/s", 1}, {"deg/s", 2},  {"tracked %", 5},
                               {"ms", 6},     {"ms 95 %", 7},  {"CPU ms", 8}, {"MB", 9}};
constexpr int kWidth = 11;  // of a column, the last character for the mark
constexpr char kBest[] = "*", kWeak[] = "!";

std::string padded(const std::string& text, std::size_t width) {
    return text + std::string(width - std::min(width, text.size()), ' ');
}

std::string rightAligned(const std::string& text, int width) {
    char out[64];
    std::snprintf(out, sizeof out, "%*s", width, text.c_str());
    return out;
}

// What all columns hold of a sequence's runs.
struct Figures {
    explicit Figures(const SequenceResults& results) : results_(results) {
        for (const Column& column : kColumns) best_.push_back(bestRuns(metric(column), results));
    }
    std::string row(std::size_t run) const {
        std::string text;
        for (std::size_t c = 0; c < std::size(kColumns); ++c) {
            const Metric& shown = metric(kColumns[c]);
            const auto value = metricOf(shown, results_, run);
            const bool weak = shown.is_share && !isComplete(results_.sequence->runs[run]);
            text += rightAligned(value ? shownNumber(value, shown.decimals) : "-", kWidth - 1) +
                    (best_[c][run] ? kBest
                     : weak        ? kWeak
                                   : " ");
        }
        return text.substr(0, text.find_last_not_of(' ') + 1) + '\n';
    }

  private:
    static const Metric& metric(const Column& column) { return shownMetrics()[column.metric]; }

    const SequenceResults& results_;
    std::vector<std::vector<bool>> best_;
};

std::string heads() {
    std::string text;
    for (const Column& column : kColumns) text += rightAligned(column.head, kWidth - 1) + ' ';
    return text.substr(0, text.find_last_not_of(' ') + 1) + '\n';
}

std::string runLines(const SequenceResults& results, std::size_t width) {
    const SequenceComparison& sequence = *results.sequence;
    const Figures figures(results);
    std::string text = heads();
    std::set<std::string> faults;  // mostly one for all methods
    for (std::size_t i = 0; i < sequence.runs.size(); ++i) {
        const MethodRun& run = sequence.runs[i];
        const std::string fault = whyNoErrors(sequence, run, results.evaluated[i]);
        text += padded("  " + labelOf(run), width) + (run.ok() ? figures.row(i) : " " + fault + "\n");
        if (run.ok() && !fault.empty()) faults.insert(fault);
    }
    for (const std::string& fault : faults) text += "  no errors: " + fault + "\n";
    for (const std::string& oddity : odditiesOf(results)) text += "  " + oddity + "\n";
    return text;
}

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
        text += sequence.runs.empty() ? " not run\n" : runLines(results, width);
        if (const std::string part = commonPart(sequence); !part.empty())
            text += "  only " + part + " of the recording\n";
        for (const std::string& note : sequence.notes) text += "  " + note + "\n";
    }
    std::string marks;
    if (text.find(kBest) != std::string::npos) marks += "* the best, as in the report\n";
    const auto has_weak = [](const SequenceComparison& sequence) {
        return std::any_of(sequence.runs.begin(), sequence.runs.end(),
                           [](const MethodRun& run) { return run.ok() && !isComplete(run); });
    };
    if (std::any_of(sequences.begin(), sequences.end(), has_weak))
        marks += "! tracked less than 90 % of the frames: ranks behind all that tracked more\n";
    if (!marks.empty()) text += "\n" + marks;
    if (const auto remark = optionsRemark(all)) text += "\n" + *remark + "\n";
    return text;
}

}  // namespace roevo
