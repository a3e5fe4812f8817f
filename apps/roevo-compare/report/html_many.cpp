#include <algorithm>
#include <filesystem>

#include "programs/gnuplot.h"
#include "programs/text.h"
#include "roevo-compare/report/distributions.h"
#include "roevo-compare/report/html_parts.h"
#include "roevo-compare/report/html_sections.h"
#include "roevo-compare/report/ranking.h"
#include "roevo-compare/report/remarks.h"

namespace roevo {
namespace {

constexpr std::size_t kMostReasons = 20;
constexpr std::size_t kDrawnMetrics[] = {0, 1};  // ATE, RPE over 1 s

// What single recordings have to say, counted: hundreds of sentences would be read by nobody.
std::vector<std::string> countedRemarks(const std::vector<SequenceResults>& results) {
    std::size_t odd = 0, parts = 0;
    std::string first_odd, first_oddity;
    for (const SequenceResults& result : results) {
        const auto oddities = odditiesOf(result);
        if (!oddities.empty() && odd++ == 0) first_odd = result.sequence->name, first_oddity = oddities[0];
        parts += !commonPart(*result.sequence).empty();
    }
    std::vector<std::string> sentences;
    if (const auto remark = optionsRemark(results)) sentences.push_back(*remark);
    if (odd > 0)
        sentences.push_back(counted(odd, "recording") + " with something odd (table.csv: warning), e.g. " +
                            first_odd + ": " + first_oddity);
    if (parts > 0)
        sentences.push_back("Of " + counted(parts, "recording") +
                            " only a part was run (table.csv: sequence_part).");
    return sentences;
}

// @param sections  the page's others, to which it has links
std::string header(const std::vector<SequenceResults>& results, const Legend& legend,
                   const ComparisonInfo& info, const std::string& sections) {
    std::string html = "<header>\n<h1>" + std::string(kReportTitle) + "</h1>\n<p class=\"subtitle\">" +
                       counted(legend.methods.size(), "method") + " on " +
                       counted(results.size(), "recording") + " · " + htmlText(info.date) +
                       "</p>\n<p class=\"verdict\">" + htmlText(verdict(results)) + "</p>\n";
    for (const std::string& sentence : countedRemarks(results)) html += remark(sentence);
    for (const std::string& note : info.notes) html += remark(note);
    html += "<nav>";
    for (const char* part :
         {"Changes", "Distributions", "Failures", "Worst", "Ranking", "Methods", "Protocol", "Repeating"})
        if (sections.find(" id=\"" + std::string(part) + "\"") != std::string::npos)
            html += "<a href=\"#" + std::string(part) + "\">" + part + "</a> ";
    return html + "<a href=\"table.csv\">All figures of all recordings</a></nav>\n</header>\n";
}

bool anyHas(const Metric& metric, const std::vector<SequenceResults>& results) {
    for (const SequenceResults& result : results)
        for (std::size_t i = 0; i < result.evaluated.size(); ++i)
            if (metricOf(metric, result, i)) return true;
    return false;
}

// The methods' lines; they are the same in all plots.
std::string legendOf(const Legend& legend) {
    std::string items;
    for (std::size_t m = 0; m < legend.methods.size(); ++m)
        items += "<li>" + lineSample(legend.styles[m]) + htmlText(legend.methods[m].label) + "</li>";
    return "<ul class=\"legend\">" + items + "</ul>\n";
}

std::string distributions(const std::vector<SequenceResults>& results, const Legend& legend,
                          PageFiles& files) {
    std::string html = "<section id=\"Distributions\">\n<h2>Distributions</h2>\n" +
                       setTable(distributionTable(results, legend.methods), "distribution");
    try {
        for (const std::size_t m : kDrawnMetrics) {
            const Metric& metric = shownMetrics()[m];
            if (!anyHas(metric, results)) continue;  // of recordings shorter than 1 s
            html += "<div class=\"block\"><h3>" + htmlText(metric.title) + "</h3>\n" +
                    setFigure(boxFigure(metric, results, legend), &files) + legendOf(legend) +
                    setFigure(cumulativeFigure(metric, results, legend), &files) + "</div>\n";
        }
    } catch (const NoGnuplot& e) {
        html += remark(std::string("No plots: ") + e.what());
    }
    return html + "</section>\n";
}

std::string failures(const std::vector<SequenceResults>& results) {
    const Table table = reasonTable(results, kMostReasons);
    return "<section id=\"Failures\">\n<h2>Failures</h2>\n" +
           (table.rows.empty() ? "<p>Every run has errors to show.</p>\n"
                               : setTable(table, "reasons", false)) +
           "</section>\n";
}

std::string worst(const std::vector<SequenceResults>& results, const Legend& legend,
                  const std::string& folder) {
    std::vector<SequenceResults> chosen;
    for (const std::size_t s : worstRecordings(results, kWorstSequences)) chosen.push_back(results[s]);
    if (chosen.empty()) return {};
    const Metric& ate = shownMetrics().front();
    Table table{"",
                "Recording",
                {},
                {},
                "ATE RMSE [" + ate.unit + "], by that of " + leadingMethod(legend.methods).label +
                    ". A recording's page has its trajectories, errors over time, times and maps."};
    for (const TableMethod& method : legend.methods) table.columns.push_back(method.label);
    for (const SequenceResults& result : chosen) {
        const std::string page = pageFile(folder, *result.sequence);
        std::error_code ignored;
        Table::Row row{result.sequence->name,
                       false,
                       false,
                       hasTrajectories(*result.sequence) ? relativeLink(page, folder) : "",
                       {}};
        const auto best = bestRuns(ate, result);
        for (const TableMethod& method : legend.methods) {
            const auto run = findRun(*result.sequence, method.name);
            const auto value = run ? metricOf(ate, result, *run) : std::nullopt;
            const std::string why =
                run ? whyNoErrors(*result.sequence, result.sequence->runs[*run], result.evaluated[*run])
                    : "not run";
            row.cells.push_back({value ? shownNumber(value, ate.decimals) : kDash, run && best[*run], false,
                                 value ? "" : why});
        }
        table.rows.push_back(row);
    }
    return "<section id=\"Worst\">\n<h2>The worst " + std::to_string(chosen.size()) + " recordings</h2>\n" +
           setTable(table, "worst", false) + "</section>\n";
}

std::string rankingOfMany(const std::vector<SequenceResults>& results, const Legend& legend) {
    return "<section id=\"Ranking\">\n<h2>Ranking</h2>\n<p>Number of recordings on which a method is among "
           "the "
           "first 1, 2 and 3, and its mean rank.</p>\n" +
           setTable(rankingTable(results, legend.methods), "rank_all", false) + "</section>\n";
}

}  // namespace

std::string pageFile(const std::string& folder, const SequenceComparison& sequence) {
    return (std::filesystem::path(folder) / "pages" / (sequence.name + ".html")).string();
}

bool hasTrajectories(const SequenceComparison& sequence) {
    return std::any_of(sequence.runs.begin(), sequence.runs.end(),
                       [](const MethodRun& run) { return !run.trajectory.empty(); });
}

std::string htmlReportOfMany(const std::vector<SequenceResults>& results, const Legend& legend,
                             const ComparisonInfo& info, const std::string& folder, PageFiles& files,
                             const std::vector<SequenceResults>& baseline) {
    const std::string sections = changesSection(results, baseline) + distributions(results, legend, files) +
                                 failures(results) + worst(results, legend, folder) +
                                 rankingOfMany(results, legend) + methodList(legend) +
                                 protocolSection(conditionsOf(results)) + repeating(info);
    return pageHead() + header(results, legend, info, sections) + "<main>\n" + sections +
           "</main>\n</body>\n</html>\n";
}

}  // namespace roevo
