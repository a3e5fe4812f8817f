#include "roevo-compare/report/tables.h"

#include <algorithm>

#include "programs/text.h"
#include "roevo-compare/report/protocol.h"
#include "roevo-compare/report/ranking.h"
#include "roevo-compare/report/remarks.h"

namespace roevo {
namespace {

constexpr std::size_t kMaxSequenceColumns = 8;  // more do not fit a page beside each other
constexpr std::size_t kRankedMetrics = 3;       // ATE, RPE over 1 s: the first ones

std::string reasonOf(const Metric& metric, const SequenceResults& results, std::size_t index) {
    const MethodRun& run = results.sequence->runs[index];
    if (metric.is_error || !run.ok()) {
        const std::string reason = whyNoErrors(*results.sequence, run, results.evaluated[index]);
        return reason.empty() ? "no two poses are that far apart" : reason;
    }
    return run.trajectory_file.empty() ? "not measured" : "made by another program, not run here";
}

TableCell makeCell(const Metric& metric, const SequenceResults& results, const std::vector<bool>& best,
                   std::optional<std::size_t> run) {
    const SequenceComparison& sequence = *results.sequence;
    if (!run) return {kDash, false, false, sequence.failure.empty() ? "not run" : sequence.failure};
    const auto value = metricOf(metric, results, *run);
    if (!value) return {kDash, false, false, reasonOf(metric, results, *run)};
    TableCell cell{shownNumber(value, metric.decimals), best[*run], false, {}};
    const double share = trackedShare(sequence.runs[*run]).value_or(0);
    cell.weak = !isComplete(sequence.runs[*run]) && (metric.is_error || metric.is_share);
    if (metric.is_error && share < 1)
        cell.note = "tracked " + shownNumber(share * 100, 1) + " % of the frames" +
                    (cell.weak ? " only; ranks behind those that tracked more" : "");
    return cell;
}

// Mean over sequences, where there is a figure for each of them.
struct Mean {
    std::optional<double> value;
    bool weak = false;  // some of it is of runs that tracked too few frames
};

Mean meanOf(const Metric& metric, const std::vector<const SequenceResults*>& results,
            const std::string& method) {
    double sum = 0;
    bool weak = false;
    for (const SequenceResults* result : results) {
        const auto run = findRun(*result->sequence, method);
        const auto value = run ? metricOf(metric, *result, *run) : std::nullopt;
        if (!value) return {};
        sum += *value;
        weak = weak || ((metric.is_error || metric.is_share) && !isComplete(result->sequence->runs[*run]));
    }
    return {sum / static_cast<double>(results.size()), weak};
}

// The column of means, over the sequences for which there is any figure.
void addMeans(Table& table, const Metric& metric, const std::vector<SequenceResults>& results,
              const std::vector<TableMethod>& methods) {
    std::vector<const SequenceResults*> measured;
    for (const SequenceResults& result : results)
        for (std::size_t i = 0; i < result.evaluated.size(); ++i)
            if (metricOf(metric, result, i)) {
                measured.push_back(&result);
                break;
            }
    if (measured.size() < 2) return;
    table.columns.push_back(measured.size() == results.size() ? "mean"
                                                              : "mean of " + std::to_string(measured.size()));
    std::vector<Mean> means;
    std::optional<double> least;
    std::size_t compared = 0;
    for (const TableMethod& method : methods) {
        means.push_back(meanOf(metric, measured, method.name));
        if (means.back().value && !means.back().weak) {
            least = std::min(least.value_or(*means.back().value), *means.back().value);
            ++compared;
        }
    }
    for (std::size_t i = 0; i < means.size(); ++i) {
        const std::string text = shownNumber(means[i].value, metric.decimals);
        const bool best = !metric.is_share && compared > 1 && !means[i].weak && means[i].value &&
                          text == shownNumber(least, metric.decimals);
        table.rows[i].cells.push_back(
            {text, best, means[i].weak, means[i].value ? "" : "no mean where a sequence is missing"});
    }
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

std::string protocolOf(const Metric& metric, const std::vector<SequenceResults>& results) {
    const Conditions conditions = conditionsOf(results);
    return metric.is_error   ? errorProtocol(conditions)
           : metric.is_share ? shareProtocol(conditions)
                             : costProtocol(conditions);
}

void addPaperRow(Table& table, const std::vector<SequenceResults>& results) {
    const auto known = [](const SequenceResults& r) { return r.sequence->paper_ate_cm.has_value(); };
    if (std::none_of(results.begin(), results.end(), known)) return;
    Table::Row row{"ROEVO-TR+BA in the paper", false, true, {}, {}};
    for (const SequenceResults& result : results)
        row.cells.push_back({shownNumber(result.sequence->paper_ate_cm, 3), false, false, {}});
    row.cells.resize(table.columns.size());
    table.rows.push_back(row);
    table.protocol += " The paper's figures are by its own protocol, of whole sequences";
    for (const SequenceResults& result : results)
        if (const std::string part = commonPart(*result.sequence); known(result) && !part.empty())
            table.protocol += "; that of " + result.sequence->name + ", as ours, of its " + part;
    table.protocol += ".";
}

// Appends the four columns of a rank table to the rows.
void addRanks(Table& table, const std::vector<RankRow>& rows) {
    std::array<int, 3> most{};
    double best_rank = 0;
    for (const RankRow& row : rows) {
        for (std::size_t k = 0; k < most.size(); ++k) most[k] = std::max(most[k], row.top[k]);
        if (row.sequences > 0 && (best_rank <= 0 || row.mean_rank < best_rank)) best_rank = row.mean_rank;
    }
    for (std::size_t i = 0; i < rows.size(); ++i) {
        auto& cells = table.rows[i].cells;
        for (std::size_t k = 0; k < most.size(); ++k)
            cells.push_back(
                {std::to_string(rows[i].top[k]), rows[i].top[k] > 0 && rows[i].top[k] == most[k], false, {}});
        if (rows[i].sequences > 0)
            cells.push_back({shownNumber(rows[i].mean_rank, 2), rows[i].mean_rank <= best_rank, false, {}});
        else
            cells.push_back({kDash, false, false, "ranked on no sequence"});
    }
}

}  // namespace

Table figureTable(const Metric& metric, const std::vector<SequenceResults>& results,
                  const std::vector<TableMethod>& methods) {
    Table table{inUnit(metric), "Method", {}, {}, protocolOf(metric, results)};
    std::vector<std::vector<bool>> best;
    for (const SequenceResults& result : results) {
        table.columns.push_back(result.sequence->name);
        best.push_back(bestRuns(metric, result));
    }
    for (const TableMethod& method : methods) {
        Table::Row row{method.label, isOurs(method.name), false, {}, {}};
        for (std::size_t s = 0; s < results.size(); ++s)
            row.cells.push_back(
                makeCell(metric, results[s], best[s], findRun(*results[s].sequence, method.name)));
        table.rows.push_back(row);
    }
    addMeans(table, metric, results, methods);
    if (&metric == &shownMetrics().front()) addPaperRow(table, results);
    return results.size() > kMaxSequenceColumns ? transposed(table, "Sequence") : table;
}

Table sequenceTable(const SequenceResults& results) {
    const Conditions conditions = conditionsOf({results});
    Table table{"All figures",
                "Method",
                {},
                {},
                "Errors and times per frame. " + errorProtocol(conditions) + " " + costProtocol(conditions)};
    for (const MethodRun& run : results.sequence->runs)
        table.rows.push_back({labelOf(run), isOurs(run.method), false, {}, {}});
    for (const Metric& metric : shownMetrics()) {
        table.columns.push_back(metric.brief + " [" + metric.unit + "]");
        const auto best = bestRuns(metric, results);
        for (std::size_t i = 0; i < table.rows.size(); ++i)
            table.rows[i].cells.push_back(makeCell(metric, results, best, i));
    }
    return table;
}

Table stageTable(const SequenceResults& results) {
    Table table{"Time per frame, median / 95th percentile [ms]", "Method",
                {"In all", "Decoding, apart", "By stage"},       {},
                costProtocol(conditionsOf({results})),           true};
    const auto show = [](const StageStatistics& s) {
        return shownNumber(s.median, 2) + " / " + shownNumber(s.p95, 2);
    };
    for (const MethodRun& run : results.sequence->runs) {
        if (!run.ok() || run.tracked == 0 || !run.trajectory_file.empty()) continue;
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

Table rankingTable(const std::vector<SequenceResults>& results, const std::vector<TableMethod>& methods) {
    Table table{"", "Method", {}, {}, errorProtocol(conditionsOf(results))};
    for (const TableMethod& method : methods)
        table.rows.push_back({method.label, isOurs(method.name), false, {}, {}});
    for (std::size_t m = 0; m < kRankedMetrics; ++m) {
        const Metric& metric = shownMetrics()[m];
        table.columns.insert(table.columns.end(), {"Top 1", "Top 2", "Top 3", "Mean rank"});
        table.groups.emplace_back(metric.title, 4);
        addRanks(table, rankTable(metric, results, methods));
    }
    table.columns.insert(table.columns.end(), {"Ranked", "Without result"});
    table.groups.emplace_back("Sequences", 2);
    const auto rows = rankTable(shownMetrics().front(), results, methods);
    for (std::size_t i = 0; i < rows.size(); ++i)
        for (const int count : {rows[i].sequences, rows[i].failures})
            table.rows[i].cells.push_back({std::to_string(count), false, false, {}});
    return table;
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
    std::vector<std::string> best;
    for (const RankRow& row : rows)
        if (row.top[0] == first->top[0]) best.push_back(row.method.label);
    std::string names;
    for (std::size_t i = 0; i < best.size(); ++i)
        names += (i == 0 ? "" : i + 1 < best.size() ? ", " : " and ") + best[i];
    return names + (best.size() > 1 ? " each have" : " has") + " the smallest ATE on " +
           std::to_string(first->top[0]) + " of " + std::to_string(ranked) + " sequence" +
           (ranked == 1 ? "" : "s") + " that could be ranked.";
}

}  // namespace roevo
