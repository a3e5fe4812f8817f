#include "roevo-compare/report/baseline.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <tuple>

#include "evaluation/error_statistics.h"
#include "programs/text.h"
#include "roevo-compare/report/ranking.h"

namespace roevo {
namespace {

constexpr double kSigmas = 3, kMinChange = 1.05;
constexpr double kMadToSigma = 1.4826;  // of a normal distribution
constexpr double kQuantile95 = 1.96;

struct PartError {
    std::optional<double> error;  // cm
    std::string part;             // empty where there is no error: it may not be known
};
using Errors = std::map<std::string, PartError>;  // by recording

Errors errorsOf(const std::vector<SequenceResults>& results, const std::string& method) {
    Errors errors;
    for (const SequenceResults& result : results)
        if (const auto run = findRun(*result.sequence, method))
            errors[result.sequence->name] = {metricOf(shownMetrics().front(), result, *run),
                                             result.sequence->runs[*run].part};
    return errors;
}

// Ranks between which the median of so many lies in 95 of 100 cases (binomial, normal approximation).
void setInterval(MethodChange& change) {
    const auto n = static_cast<double>(change.pairs.size());
    const double half = kQuantile95 * std::sqrt(n) / 2;
    const auto at = [&](double rank) {
        const double index = std::clamp(rank, 0.0, n - 1);
        return change.pairs[static_cast<std::size_t>(index)].ratio();
    };
    change.low = at(std::floor((n - 1) / 2 - half));
    change.high = at(std::ceil((n - 1) / 2 + half));
}

void judge(MethodChange& change) {
    if (change.pairs.empty()) return;
    std::sort(change.pairs.begin(), change.pairs.end(),
              [](const ErrorPair& a, const ErrorPair& b) { return a.ratio() < b.ratio(); });
    std::vector<double> logs, deviations;
    for (const ErrorPair& pair : change.pairs) logs.push_back(std::log(pair.ratio()));
    const double median = percentile(logs, 0.5);
    for (const double value : logs) deviations.push_back(std::abs(value - median));
    const double noise = kSigmas * kMadToSigma * percentile(deviations, 0.5);
    change.median = std::exp(median);
    setInterval(change);
    for (const ErrorPair& pair : change.pairs) {
        if (std::abs(std::log(pair.ratio()) - median) <= noise) continue;
        if (pair.ratio() > kMinChange) change.worse.insert(change.worse.begin(), pair);
        if (pair.ratio() < 1 / kMinChange) change.better.push_back(pair);
    }
}

std::string percent(double ratio) {
    const std::string text = shownNumber(100 * (ratio - 1), 1);
    return (text[0] == '-' ? "" : "+") + text + " %";
}

TableCell cell(const std::string& text) {
    return {text, false, false, {}};
}

}  // namespace

const char* MethodChange::verdict() const {
    if (pairs.size() < 6) return "too few to tell";  // their interval of 95 % has no bounds
    return high < 1 ? "better" : low > 1 ? "worse" : "no difference";
}

std::vector<MethodChange> changesSince(const std::vector<SequenceResults>& before,
                                       const std::vector<SequenceResults>& now) {
    std::vector<MethodChange> changes;
    for (const TableMethod& method : tableMethods(now)) {
        const Errors old_errors = errorsOf(before, method.name);
        MethodChange change;
        change.method = method;
        std::size_t common = 0;
        for (const auto& [sequence, of_now] : errorsOf(now, method.name)) {
            const auto found = old_errors.find(sequence);
            if (found == old_errors.end()) continue;
            const auto& [error, part] = of_now;
            const auto& [old_error, old_part] = found->second;
            if (error && old_error && part != old_part) continue;
            ++common;
            if (error && old_error && *error > 0 && *old_error > 0)
                change.pairs.push_back({sequence, *old_error, *error});
            else if (old_error && !error)
                change.lost.push_back(sequence);
            else if (error && !old_error)
                change.gained.push_back(sequence);
        }
        judge(change);
        if (common > 0) changes.push_back(change);
    }
    return changes;
}

Table changeTable(const std::vector<MethodChange>& changes) {
    Table table{
        "ATE RMSE against the earlier comparison",
        "Method",
        {"Recordings", "Median change (95 % interval)", "Better", "Worse", "Mended", "Broken", "Verdict"},
        {},
        "Change: the ratio of a recording's errors, now by before, less 1. Better and worse: recordings "
        "whose ratio is more than 3 robust standard deviations of all ratios away from their median, and "
        "more than 5 % from 1. Mended and broken: those that failed before, or fail now. Verdict: whether "
        "the interval of the median leaves 1 out.",
        true};
    for (const MethodChange& change : changes) {
        Table::Row row{change.method.label, isOurs(change.method.name), false, {}, {}};
        const std::string median =
            percent(change.median) + " (" + percent(change.low) + " to " + percent(change.high) + ")";
        for (const std::string& text :
             {std::to_string(change.pairs.size()), change.pairs.empty() ? kDash : median,
              std::to_string(change.better.size()), std::to_string(change.worse.size()),
              std::to_string(change.gained.size()), std::to_string(change.lost.size()),
              std::string(change.verdict())})
            row.cells.push_back(cell(text));
        table.rows.push_back(row);
    }
    return table;
}

std::vector<std::string> changeSentences(const std::vector<MethodChange>& changes) {
    if (changes.empty())
        return {
            "Against the earlier comparison: no method was run on the same recording, or the same part of "
            "one, in both of them."};
    std::vector<std::string> sentences;
    for (const Table::Row& row : changeTable(changes).rows) {
        const auto text = [&](std::size_t column) { return row.cells[column].text; };
        sentences.push_back("Against the earlier comparison, " + row.head + ": median change of the ATE " +
                            text(1) + " over " + text(0) + " recording" + (text(0) == "1" ? "" : "s") + "; " +
                            text(2) + " better, " + text(3) + " worse, " + text(4) + " mended, " + text(5) +
                            " broken: " + text(6) + ".");
    }
    return sentences;
}

Table changedRecordings(const MethodChange& change, std::size_t most) {
    Table table{change.method.label + ": recordings that changed",
                "Recording",
                {"Before [cm]", "Now [cm]", "Change"},
                {},
                "ATE RMSE. The largest changes in each direction, at most " + std::to_string(most) + "."};
    for (const auto* list : {&change.worse, &change.better})
        for (std::size_t i = 0; i < std::min(list->size(), most); ++i) {
            const ErrorPair& pair = (*list)[i];
            table.rows.push_back({pair.sequence,
                                  false,
                                  false,
                                  {},
                                  {cell(shownNumber(pair.before, 3)), cell(shownNumber(pair.now, 3)),
                                   cell(percent(pair.ratio()))}});
        }
    for (const auto& [list, before, now] :
         {std::tuple(&change.lost, "", "fails"), {&change.gained, "failed", ""}})
        for (std::size_t i = 0; i < std::min(list->size(), most); ++i)
            table.rows.push_back({(*list)[i], false, false, {}, {cell(before), cell(now), cell(kDash)}});
    return table;
}

}  // namespace roevo
