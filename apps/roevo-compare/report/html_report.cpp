#include <set>

#include "programs/text.h"
#include "roevo-compare/report/documents.h"
#include "roevo-compare/report/html_parts.h"
#include "roevo-compare/report/html_sections.h"
#include "roevo-compare/report/html_sequence.h"
#include "roevo-compare/report/ranking.h"
#include "roevo-compare/report/remarks.h"

namespace roevo {
namespace {

// Of the figures in the summary of several sequences: the rest is with each sequence.
constexpr std::size_t kFewSequences = 2;  // so many let two tables stand side by side on a wide page
constexpr std::size_t kSummaryMetrics[] = {0, 1, 2, 5, 6, 8};

std::string header(const std::vector<SequenceResults>& results, const Legend& legend,
                   const ComparisonInfo& info) {
    std::string html = "<header>\n<h1>" + std::string(kReportTitle) + "</h1>\n<p class=\"subtitle\">" +
                       counted(legend.methods.size(), "method") + " on " +
                       counted(results.size(), "sequence") + " · " + htmlText(info.date) +
                       "</p>\n<p class=\"verdict\">" + htmlText(verdict(results)) + "</p>\n";
    for (const std::string& sentence : remarks(results)) html += remark(sentence);
    for (const std::string& note : info.notes) html += remark(note);
    html += "<nav>";
    for (std::size_t s = 0; s < results.size(); ++s)
        html += "<a href=\"#sequence" + std::to_string(s + 1) + "\">" + htmlText(results[s].sequence->name) +
                "</a> ";
    for (const char* part : {"Ranking", "Methods", "Protocol", "Repeating"})
        html += "<a href=\"#" + std::string(part) + "\">" + part + "</a> ";
    return html + "</nav>\n</header>\n";
}

// Where a table is nothing but dashes: why; else empty.
std::string whyEmpty(const Table& table) {
    std::set<std::string> reasons;
    for (const Table::Row& row : table.rows)
        for (const TableCell& cell : row.cells) {
            if (cell.text != kDash) return {};
            reasons.insert(cell.note);
        }
    std::string all;
    for (const std::string& reason : reasons) all += (all.empty() ? "" : "; ") + reason;
    return all;
}

std::string summary(const std::vector<SequenceResults>& results, const Legend& legend,
                    const std::string& folder) {
    std::string html =
        "<section>\n<h2>Summary</h2>\n<p>The best figure is bold on blue. A dash is explained beneath the "
        "table; figures in italics are of runs that tracked less than 90 % of the frames.</p>\n";
    if (results.size() == 1) return html + allFigures(results[0], "summary", folder) + "</section>\n";
    html += results.size() <= kFewSequences ? "<div class=\"few\">\n" : "<div>\n";
    std::string without;
    for (const std::size_t m : kSummaryMetrics) {
        const Table table = figureTable(shownMetrics()[m], results, legend.methods);
        if (const std::string reasons = whyEmpty(table); !reasons.empty())
            without += element("p", table.title + ": no figures (" + reasons + ")") + "\n";
        else
            html += setTable(table, "summary" + std::to_string(m));
    }
    return html + "</div>\n" + without + "</section>\n";
}

std::string ranking(const std::vector<SequenceResults>& results, const Legend& legend) {
    std::string html =
        "<section id=\"Ranking\">\n<h2>Ranking</h2>\n<p>Number of sequences, as they were run here, on "
        "which a method is among the first 1, 2 and 3, and its mean rank.</p>\n";
    const auto one = oneRoevo(legend.methods);
    if (one.size() != legend.methods.size())
        html +=
            "<div class=\"block\"><h3>One ROEVO against the others</h3>\n<p>As in the paper’s table: the "
            "fullest of its modes "
            "only, so that they do not take places from each other.</p>\n" +
            setTable(rankingTable(results, one), "rank_one", false) + "</div>\n<h3>All methods</h3>\n";
    return html + setTable(rankingTable(results, legend.methods), "rank_all", false) + "</section>\n";
}

}  // namespace

std::string htmlReport(const std::vector<SequenceResults>& results, const ComparisonInfo& info,
                       const std::string& folder, PageFiles& files,
                       const std::vector<SequenceResults>& baseline) {
    const auto methods = tableMethods(results);
    const Legend legend{methods, lineStyles(methods)};
    if (results.size() > kManySequences)
        return htmlReportOfMany(results, legend, info, folder, files, baseline);
    SequenceWriter writer(legend, folder, results.size() > 1, files);
    std::string sequences;
    for (std::size_t s = 0; s < results.size(); ++s) sequences += writer.write(results[s], s + 1);
    std::string html = pageHead() + header(results, legend, info);
    if (!writer.plotFault().empty()) html += remark("No plots: " + writer.plotFault());
    return html + "<main>\n" + summary(results, legend, folder) + changesSection(results, baseline) +
           sequences + ranking(results, legend) + methodList(legend) +
           protocolSection(conditionsOf(results)) + repeating(info) + "</main>\n</body>\n</html>\n";
}

}  // namespace roevo
