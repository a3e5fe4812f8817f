#include <algorithm>

#include "programs/text.h"
#include "roevo-compare/report/distributions.h"
#include "roevo-compare/report/documents.h"
#include "roevo-compare/report/protocol.h"
#include "roevo-compare/report/ranking.h"
#include "roevo-compare/report/remarks.h"
#include "roevo-compare/report/tables.h"

namespace roevo {
namespace {

// Footnotes of one document: a text that comes again gets the same number.
class Footnotes {
  public:
    std::string mark(const std::string& text) {
        if (text.empty()) return {};
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

std::string setTable(const Table& table, Footnotes& notes) {
    std::vector<std::string> columns = table.columns;
    std::size_t first = 0;  // Markdown has no heads over several columns
    for (const auto& [name, size] : table.groups) {
        for (std::size_t c = first; c < first + size; ++c) columns[c] = name + ": " + columns[c];
        first += size;
    }
    std::string text = table.title.empty() ? "" : "### " + markdownText(table.title) + "\n\n";
    text += "| " + table.corner + " |";
    for (const std::string& column : columns) text += " " + markdownText(column) + " |";
    text += "\n|---|";
    for (std::size_t c = 0; c < table.columns.size(); ++c)
        text += table.text_last && c + 1 == table.columns.size() ? "---|" : "---:|";
    for (const Table::Row& row : table.rows) {
        text += "\n| " + (row.aside ? "*" + markdownText(row.head) + "*" : markdownText(row.head)) + " |";
        for (const TableCell& cell : row.cells)
            text += " " + (cell.best ? "**" + markdownText(cell.text) + "**" : markdownText(cell.text)) +
                    notes.mark(cell.note) + " |";
    }
    return text + "\n\n" + table.protocol + "\n\n";
}

// Four spaces make a block from which nothing can break out.
std::string code(const std::string& text) {
    return "    " + cleanText(text) + "\n";
}

std::string recordings(const std::vector<SequenceResults>& results) {
    std::string text;
    for (const SequenceResults& result : results)
        for (const std::string& note : result.sequence->notes)
            text += "- " + markdownText(result.sequence->name + ": " + note) + "\n";
    return text.empty() ? text : "\n## Recordings\n\n" + text;
}

// What a reader must know, and the figures of each sequence.
std::string figures(const std::vector<SequenceResults>& results, const std::vector<TableMethod>& methods,
                    Footnotes& notes) {
    std::string text;
    const auto important = remarks(results);
    for (const std::string& remark : important) text += "- " + markdownText(remark) + "\n";
    if (!important.empty()) text += "\n";
    text += "## Figures\n\n";
    for (const Metric& metric : shownMetrics())
        text += setTable(figureTable(metric, results, methods), notes);

    for (const SequenceResults& result : results) {
        Table table = stageTable(result);
        if (table.rows.empty()) continue;
        table.title = result.sequence->name + ": " + table.title;
        text += setTable(table, notes);
    }
    return text;
}

}  // namespace

std::string markdownTables(const std::vector<SequenceResults>& results, const ComparisonInfo& info) {
    const auto methods = tableMethods(results);
    Footnotes notes;
    std::string text = std::string("# ") + kReportTitle + "\n\n" + markdownText(verdict(results)) +
                       " The best figures are bold.\n\n";
    text += results.size() > kManySequences ? setTable(distributionTable(results, methods), notes)
                                            : figures(results, methods, notes);
    text +=
        "## Ranking\n\nNumber of sequences, as they were run here, on which a method is among the first 1, "
        "2, 3.\n\n";
    const auto one = oneRoevo(methods);
    if (one.size() != methods.size())
        text += "As in the paper, one ROEVO (the last mode of these tables) against the others:\n\n" +
                setTable(rankingTable(results, one), notes) +
                "All methods, each of ROEVO's modes for itself:\n\n";
    text += setTable(rankingTable(results, methods), notes);
    text += notes.list() + "## Methods\n\n";
    for (const TableMethod& method : methods)
        text += "- **" + markdownText(method.label) + "**: " + markdownText(method.note) + "\n";
    text += (results.size() > kManySequences ? "" : recordings(results)) + "\n## Protocol\n\n";
    for (const std::string& line : protocolLines(conditionsOf(results))) text += "- " + line + "\n";
    for (const std::string& note : info.notes) text += "- " + markdownText(note) + "\n";
    text += "\n## Repeating it\n\n" + code(info.command) + "\n- Date: " + markdownText(info.date) +
            "\n- Machine: " + markdownText(info.machine) + "\n";
    for (const auto& [name, version] : info.versions)
        text += "- " + markdownText(name) + ": " + markdownText(version) + "\n";
    return text;
}

}  // namespace roevo
