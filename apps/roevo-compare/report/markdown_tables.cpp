#include <algorithm>

#include "roevo-compare/report/metrics.h"
#include "roevo-compare/report/ranking.h"
#include "roevo-compare/report/tables.h"
#include "roevo-compare/report/text.h"

namespace roevo {
namespace {

// Footnotes of one document: a text that comes again gets the same number.
class Footnotes {
  public:
    std::string mark(const std::string& text) {
        auto at = std::find(texts_.begin(), texts_.end(), text);
        if (at == texts_.end()) at = texts_.insert(texts_.end(), text);
        return "[^" + std::to_string(at - texts_.begin() + 1) + "]";
    }
    std::string list() const {
        std::string all;
        for (std::size_t i = 0; i < texts_.size(); ++i)
            all += "[^" + std::to_string(i + 1) + "]: " + markdownText(texts_[i]) + "\n";
        return all.empty() ? all : all + "\n";
    }

  private:
    std::vector<std::string> texts_;
};

std::string head(const std::vector<std::string>& columns) {
    std::string names, rule;
    for (const std::string& column : columns) {
        names += "| " + column + " ";
        rule += rule.empty() ? "|---" : "|---:";
    }
    return names + "|\n" + rule + "|\n";
}

std::string reasonOf(const Metric& metric, const SequenceResults& results, std::size_t run) {
    const MethodRun& r = results.sequence->runs[run];
    if (metric.is_error || !r.ok()) {
        const std::string reason = whyNoErrors(*results.sequence, r, results.evaluated[run]);
        return reason.empty() ? "the sequence is too short for it" : reason;
    }
    return "not measured";
}

std::string cell(const Metric& metric, const SequenceResults& results, const std::vector<bool>& best,
                 const std::string& method, Footnotes& notes) {
    if (!results.sequence->failure.empty()) return "–" + notes.mark(results.sequence->failure);
    const auto run = findRun(*results.sequence, method);
    if (!run) return "–" + notes.mark("not run");
    const auto value = metricOf(metric, results, *run);
    if (!value) return "–" + notes.mark(reasonOf(metric, results, *run));
    std::string text = shownNumber(value, metric.decimals);
    if (best[*run]) text = "**" + text + "**";
    const MethodRun& r = results.sequence->runs[*run];
    if (metric.is_error && !isComplete(r))
        text += notes.mark("tracked " + shownNumber(trackedShare(r).value_or(0) * 100, 1) +
                           " % of the frames only; ranks behind those that tracked more");
    return text;
}

// Mean over all sequences, where there is a figure for each of them.
std::string average(const Metric& metric, const std::vector<SequenceResults>& results,
                    const std::string& method) {
    double sum = 0;
    for (const SequenceResults& result : results) {
        const auto run = findRun(*result.sequence, method);
        const auto value = run ? metricOf(metric, result, *run) : std::nullopt;
        if (!value) return "–";
        sum += *value;
    }
    return shownNumber(sum / static_cast<double>(results.size()), metric.decimals);
}

std::string metricTable(const Metric& metric, const std::vector<SequenceResults>& results,
                        const std::vector<TableMethod>& methods, bool paper, Footnotes& notes) {
    std::vector<std::string> columns{"Method"};
    std::vector<std::vector<bool>> best;
    for (const SequenceResults& result : results) {
        columns.push_back(markdownText(result.sequence->name));
        best.push_back(bestRuns(metric, result));
    }
    const bool averaged = results.size() > 1;
    if (averaged) columns.push_back("mean");
    std::string table = "### " + metric.title + " [" + metric.unit + "]\n\n" + head(columns);
    for (const TableMethod& method : methods) {
        table += "| " + markdownText(method.label) + " ";
        for (std::size_t s = 0; s < results.size(); ++s)
            table += "| " + cell(metric, results[s], best[s], method.name, notes) + " ";
        if (averaged) table += "| " + average(metric, results, method.name) + " ";
        table += "|\n";
    }
    if (paper) {
        table += "| *ROEVO-TR+BA as the paper states it, whole sequence* ";
        for (const SequenceResults& result : results)
            table += "| " + shownNumber(result.sequence->paper_ate_cm, 3) + " ";
        table += averaged ? "| |\n" : "|\n";
    }
    return table + "\n";
}

std::string rankingTable(const Metric& metric, const std::vector<SequenceResults>& results,
                         const std::vector<TableMethod>& methods) {
    std::string table = head({"By " + metric.title, "Top 1 seqs.", "Top 2 seqs.", "Top 3 seqs.", "mean rank",
                              "seqs.", "without result"});
    for (const RankRow& row : rankTable(metric, results, methods)) {
        table += "| " + markdownText(row.method.label);
        for (const int top : row.top) table += " | " + std::to_string(top);
        table += " | " + (row.sequences ? shownNumber(row.mean_rank, 2) : "–") + " | " +
                 std::to_string(row.sequences) + " | " + std::to_string(row.failures) + " |\n";
    }
    return table + "\n";
}

std::string rankingSection(const std::vector<SequenceResults>& results,
                           const std::vector<TableMethod>& methods) {
    const auto one = oneRoevo(methods);
    std::string text = "## Ranking\n\nNumber of sequences in which a method is among the first 1, 2, 3.\n\n";
    if (one.size() != methods.size())
        text += "As in the paper, one ROEVO (its last mode in these tables) against the others:\n\n";
    for (const Metric& metric : shownMetrics())
        if (metric.is_error) text += rankingTable(metric, results, one);
    if (one.size() != methods.size()) {
        text += "All methods, each of ROEVO's modes for itself:\n\n";
        for (const Metric& metric : shownMetrics())
            if (metric.is_error) text += rankingTable(metric, results, methods);
    }
    return text;
}

std::string code(const std::string& text) {
    // Four spaces make a block from which nothing can break out.
    return "    " + cleanText(text) + "\n";
}

}  // namespace

std::string markdownTables(const std::vector<SequenceResults>& results, const ComparisonInfo& info) {
    const auto methods = tableMethods(results);
    const bool paper = std::any_of(results.begin(), results.end(), [](const SequenceResults& r) {
        return r.sequence->paper_ate_cm.has_value();
    });
    Footnotes notes;
    std::string text = "# Comparison of RGB-D odometries\n\nThe best figure is bold.\n\n## Figures\n\n";
    for (const Metric& metric : shownMetrics())
        text += metricTable(metric, results, methods, paper && metric.title == "ATE RMSE", notes);
    text += notes.list() + rankingSection(results, methods);
    text += "## Methods\n\n";
    for (const TableMethod& method : methods)
        text += "- **" + markdownText(method.label) + "**: " + markdownText(method.note) + "\n";
    text += "\n## Protocol\n\n";
    for (const std::string& line : protocolLines()) text += "- " + line + "\n";
    text += "\n## Repeating it\n\n" + code(info.command) + "\n- Date: " + markdownText(info.date) +
            "\n- Machine: " + markdownText(info.machine) + "\n";
    for (const auto& [name, version] : info.versions)
        text += "- " + markdownText(name) + ": " + markdownText(version) + "\n";
    return text;
}

}  // namespace roevo
