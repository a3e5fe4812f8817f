#include "roevo-compare/report/tables.h"

#include <algorithm>
#include <set>

#include "roevo-compare/report/protocol.h"
#include "roevo-compare/report/ranking.h"
#include "roevo-compare/report/text.h"

namespace roevo {
namespace {

constexpr std::size_t kMaxSequenceColumns = 8;  // more do not fit a page beside each other
constexpr char kDash[] = "–";

std::string reasonOf(const Metric& metric, const SequenceResults& results, std::size_t index) {
    const MethodRun& run = results.sequence->runs[index];
    if (metric.is_error || !run.ok()) {
        const std::string reason = whyNoErrors(*results.sequence, run, results.evaluated[index]);
        return reason.empty() ? "the sequence is too short for it" : reason;
    }
    return "not measured";
}

TableCell makeCell(const Metric& metric, const SequenceResults& results, const std::vector<bool>& best,
                   std::optional<std::size_t> run) {
    const SequenceComparison& sequence = *results.sequence;
    if (!run) return {kDash, false, false, sequence.failure.empty() ? "not run" : sequence.failure};
    const auto value = metricOf(metric, results, *run);
    if (!value) return {kDash, false, false, reasonOf(metric, results, *run)};
    TableCell cell{shownNumber(value, metric.decimals), best[*run], false, {}};
    cell.weak = !isComplete(sequence.runs[*run]) && (metric.is_error || metric.is_share);
    if (metric.is_error && cell.weak) {
        cell.note = "tracked " + shownNumber(trackedShare(sequence.runs[*run]).value_or(0) * 100, 1) +
                    " % of the frames only; ranks behind those that tracked more";
    }
    return cell;
}

// Mean over all sequences, where there is a figure for each of them.
TableCell meanCell(const Metric& metric, const std::vector<SequenceResults>& results,
                   const std::string& method) {
    double sum = 0;
    bool weak = false;
    for (const SequenceResults& result : results) {
        const auto run = findRun(*result.sequence, method);
        const auto value = run ? metricOf(metric, result, *run) : std::nullopt;
        if (!value) return {kDash, false, false, "no mean where a sequence is missing"};
        sum += *value;
        weak = weak || (metric.is_error && !isComplete(result.sequence->runs[*run]));
    }
    return {shownNumber(sum / static_cast<double>(results.size()), metric.decimals), false, weak, {}};
}

Table transposed(const Table& table, const std::string& corner) {
    Table turned{table.title, corner, {}, {}, table.protocol};
    for (const Table::Row& row : table.rows) turned.columns.push_back(row.head);
    for (std::size_t c = 0; c < table.columns.size(); ++c) {
        turned.rows.push_back({table.columns[c], false, false, {}, {}});
        for (const Table::Row& row : table.rows) turned.rows.back().cells.push_back(row.cells[c]);
    }
    return turned;
}

std::string inUnit(const Metric& metric) {
    return metric.title + " [" + metric.unit + "]";
}

std::string protocolOf(const Metric& metric) {
    return metric.is_error ? errorProtocol() : costProtocol();
}

void addPaperRow(Table& table, const std::vector<SequenceResults>& results) {
    const auto known = [](const SequenceResults& r) { return r.sequence->paper_ate_cm.has_value(); };
    if (std::none_of(results.begin(), results.end(), known)) return;
    Table::Row row{"ROEVO-TR+BA as the paper states it, whole sequence", false, true, {}, {}};
    for (const SequenceResults& result : results)
        row.cells.push_back({shownNumber(result.sequence->paper_ate_cm, 3), false, false, {}});
    row.cells.resize(table.columns.size());
    table.rows.push_back(row);
}

}  // namespace

Table figureTable(const Metric& metric, const std::vector<SequenceResults>& results,
                  const std::vector<TableMethod>& methods) {
    Table table{inUnit(metric), "Method", {}, {}, protocolOf(metric)};
    std::vector<std::vector<bool>> best;
    for (const SequenceResults& result : results) {
        table.columns.push_back(result.sequence->name);
        best.push_back(bestRuns(metric, result));
    }
    const bool averaged = results.size() > 1;
    if (averaged) table.columns.push_back("mean");
    for (const TableMethod& method : methods) {
        Table::Row row{method.label, isOurs(method.name), false, {}, {}};
        for (std::size_t s = 0; s < results.size(); ++s)
            row.cells.push_back(
                makeCell(metric, results[s], best[s], findRun(*results[s].sequence, method.name)));
        if (averaged) row.cells.push_back(meanCell(metric, results, method.name));
        table.rows.push_back(row);
    }
    if (&metric == &shownMetrics().front()) addPaperRow(table, results);
    return results.size() > kMaxSequenceColumns ? transposed(table, "Sequence") : table;
}

Table sequenceTable(const SequenceResults& results) {
    Table table{"All figures", "Method", {}, {}, errorProtocol() + " " + costProtocol()};
    for (const MethodRun& run : results.sequence->runs)
        table.rows.push_back({labelOf(run), isOurs(run.method), false, {}, {}});
    for (const Metric& metric : shownMetrics()) {
        table.columns.push_back(inUnit(metric));
        const auto best = bestRuns(metric, results);
        for (std::size_t i = 0; i < table.rows.size(); ++i)
            table.rows[i].cells.push_back(makeCell(metric, results, best, i));
    }
    return table;
}

Table stageTable(const SequenceResults& results) {
    Table table{"Time per frame, median / 95th percentile [ms]",
                "Method",
                {"In all", "Decoding, apart", "By stage"},
                {},
                costProtocol(),
                true};
    const auto show = [](const StageStatistics& s) {
        return shownNumber(s.median, 2) + " / " + shownNumber(s.p95, 2);
    };
    for (const MethodRun& run : results.sequence->runs) {
        if (!run.ok() || run.tracked == 0) continue;
        std::string stages;
        for (const StageStatistics& stage : run.stages)
            stages += (stages.empty() ? "" : " · ") + stage.name + " " + show(stage);
        if (!run.background.empty())
            stages += (stages.empty() ? "" : " · ") + std::string("beside the frames: ") + run.background +
                      ", mean " + shownNumber(run.background_ms, 2);
        table.rows.push_back({labelOf(run),
                              isOurs(run.method),
                              false,
                              {},
                              {{show(run.total), false, false, {}},
                               {show(run.decode), false, false, {}},
                               {stages, false, false, {}}}});
    }
    return table;
}

Table rankingTable(const Metric& metric, const std::vector<SequenceResults>& results,
                   const std::vector<TableMethod>& methods) {
    Table table{"By " + metric.title,
                "Method",
                {"Top 1 seqs.", "Top 2 seqs.", "Top 3 seqs.", "Mean rank", "Ranked seqs.", "Without result"},
                {},
                errorProtocol()};
    const auto rows = rankTable(metric, results, methods);
    double best_rank = 0;
    for (const RankRow& row : rows)
        if (row.sequences > 0 && (best_rank <= 0 || row.mean_rank < best_rank)) best_rank = row.mean_rank;
    std::array<int, 3> most{};
    for (const RankRow& row : rows)
        for (std::size_t k = 0; k < most.size(); ++k) most[k] = std::max(most[k], row.top[k]);
    for (const RankRow& row : rows) {
        Table::Row shown{row.method.label, isOurs(row.method.name), false, {}, {}};
        for (std::size_t k = 0; k < most.size(); ++k)
            shown.cells.push_back(
                {std::to_string(row.top[k]), row.top[k] > 0 && row.top[k] == most[k], false, {}});
        shown.cells.push_back(
            row.sequences > 0
                ? TableCell{shownNumber(row.mean_rank, 2), row.mean_rank <= best_rank, false, {}}
                : TableCell{kDash, false, false, "ranked on no sequence"});
        shown.cells.push_back({std::to_string(row.sequences), false, false, {}});
        shown.cells.push_back({std::to_string(row.failures), false, false, {}});
        table.rows.push_back(shown);
    }
    return table;
}

std::vector<std::string> remarks(const std::vector<SequenceResults>& results) {
    std::vector<std::string> sentences;
    for (const SequenceResults& result : results) {
        const SequenceComparison& sequence = *result.sequence;
        const auto say = [&](const std::string& what) { sentences.push_back(sequence.name + ": " + what); };
        if (!sequence.failure.empty()) {
            say("nothing could be run on it: " + sequence.failure);
            continue;
        }
        if (!sequence.ground_truth_fault.empty())
            say("its ground truth could not be used: " + sequence.ground_truth_fault);
        else if (sequence.reference.empty())
            say("no ground truth, so no errors and no rank");
        std::set<std::size_t> counts;
        for (const MethodRun& run : sequence.runs)
            if (run.ok()) counts.insert(run.frames - std::min(run.rejected, run.frames));
        if (counts.size() > 1)
            say("the methods were given " + std::to_string(*counts.begin()) + " to " +
                std::to_string(*counts.rbegin()) + " frames, so their figures are not of the same frames");
    }
    return sentences;
}

std::string verdict(const std::vector<SequenceResults>& results) {
    const Metric& ate = shownMetrics().front();
    const auto rows = rankTable(ate, results, tableMethods(results));
    const auto first = std::max_element(
        rows.begin(), rows.end(), [](const RankRow& a, const RankRow& b) { return a.top[0] < b.top[0]; });
    if (first == rows.end() || first->top[0] == 0) return "No method could be ranked: see the notes for why.";
    int ranked = 0;
    for (const SequenceResults& result : results) {
        const auto ranks = rankRuns(ate, result, std::vector<bool>(result.evaluated.size(), true));
        ranked += std::any_of(ranks.begin(), ranks.end(), [](const auto& r) { return r.has_value(); });
    }
    return first->method.label + " has the smallest ATE on " + std::to_string(first->top[0]) + " of " +
           std::to_string(ranked) + " sequence" + (ranked == 1 ? "" : "s") + " with ground truth.";
}

}  // namespace roevo
