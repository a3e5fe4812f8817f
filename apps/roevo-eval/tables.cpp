#include "tables.h"

#include <algorithm>
#include <cstdio>
#include <optional>

#include "programs/text.h"

namespace roevo {
namespace {

struct Column {
    const char *title, *unit, *latex;
    double scale;
    int decimals;
    double ErrorStatistics::*figure;
    const ErrorStatistics& (*errors)(const Evaluation&);
};

const ErrorStatistics& ate(const Evaluation& e) {
    return e.ate.translation;
}
const ErrorStatistics& drift(const Evaluation& e) {
    return e.rpe_second.translation;
}
const ErrorStatistics& turn(const Evaluation& e) {
    return e.rpe_second.rotation;
}

// What the tables for people show.
constexpr Column kColumns[] = {
    {"ATE rmse", "cm", "ATE RMSE [cm]", 100, 3, &ErrorStatistics::rmse, ate},
    {"mean", "cm", "mean [cm]", 100, 3, &ErrorStatistics::mean, ate},
    {"max", "cm", "max [cm]", 100, 3, &ErrorStatistics::max, ate},
    {"RPE rmse", "cm/s", "RPE [cm/s]", 100, 3, &ErrorStatistics::rmse, drift},
    {"RPE rmse", "deg/s", "RPE [deg/s]", 1, 3, &ErrorStatistics::rmse, turn},
};

std::optional<double> shownValue(const Column& column, const Evaluation& evaluation) {
    const ErrorStatistics& errors = column.errors(evaluation);
    if (errors.count == 0) return std::nullopt;
    return column.scale * errors.*column.figure;
}

std::string shownFigure(const Column& column, const Evaluation& evaluation) {
    const auto value = shownValue(column, evaluation);
    return value ? shownNumber(value, column.decimals) : "";
}

// Of several estimates of the same stretch. Those that look alike are alike.
bool isBest(const Column& column, const JudgedEstimate& estimate, const std::vector<JudgedEstimate>& all) {
    const auto value = shownValue(column, estimate.evaluation);
    return all.size() > 1 && value && isComparable(estimate, all) &&
           std::none_of(all.begin(), all.end(), [&](const JudgedEstimate& other) {
               const auto theirs = shownValue(column, other.evaluation);
               return theirs && isComparable(other, all) && *theirs < *value &&
                      shownFigure(column, other.evaluation) != shownFigure(column, estimate.evaluation);
           });
}

std::string latexText(const std::string& text) {
    std::string escaped;
    for (const char c : cleanText(text)) {
        if (c == '\\')
            escaped += "\\textbackslash{}";
        else if (c == '~' || c == '^')
            escaped += std::string("\\") + c + "{}";
        else
            escaped += (std::string("&%$#_{}").find(c) == std::string::npos ? "" : "\\") + std::string(1, c);
    }
    return escaped;
}

void appendFigures(const ErrorStatistics& s, std::string& row) {
    const auto value = [&](double figure) {
        return "," + exactNumber(s.count > 0 ? std::optional(figure) : std::nullopt);
    };
    row += value(s.rmse) + value(s.mean) + value(s.median) + value(s.std) + value(s.max);
}

}  // namespace

bool isComparable(const JudgedEstimate& estimate, const std::vector<JudgedEstimate>& all) {
    constexpr double kComparable = 0.9;  // what is judged by fewer is another stretch
    std::size_t most = 0;
    for (const JudgedEstimate& other : all) most = std::max(most, other.evaluation.pairs.size());
    return static_cast<double>(estimate.evaluation.pairs.size()) >= kComparable * static_cast<double>(most);
}

std::string terminalTable(const std::vector<JudgedEstimate>& estimates) {
    std::size_t width = 8;
    for (const JudgedEstimate& e : estimates) width = std::max(width, countCharacters(cleanText(e.name)));
    std::string head(width, ' '), units(width, ' '), rows;
    char cell[64];
    std::snprintf(cell, sizeof cell, " %9s %9s", "pairs", "scale");
    head += cell, units += std::string(20, ' ');
    for (const Column& column : kColumns) {
        std::snprintf(cell, sizeof cell, " %9s", column.title);
        head += cell;
        std::snprintf(cell, sizeof cell, " %9s", (std::string("[") + column.unit + "]").c_str());
        units += cell;
    }
    for (const JudgedEstimate& e : estimates) {
        const std::string name = cleanText(e.name);
        std::snprintf(cell, sizeof cell, " %9zu %9.4f", e.evaluation.pairs.size(), e.evaluation.scale);
        rows += name + std::string(width - countCharacters(name), ' ') + cell;
        for (const Column& column : kColumns) {
            const std::string shown = shownFigure(column, e.evaluation);
            std::snprintf(cell, sizeof cell, " %9s", shown.empty() ? "n/a" : shown.c_str());
            rows += cell;
        }
        rows += '\n';
    }
    return head + '\n' + units + '\n' + rows;
}

std::string csvTable(const std::vector<JudgedEstimate>& estimates, const std::string& alignment) {
    std::string csv = "name,file,alignment,scale,poses,pairs";
    for (const auto& [error, unit] : {std::pair("ate", "m"),
                                      {"rpe_second", "m_per_s"},
                                      {"rpe_second", "deg_per_s"},
                                      {"rpe_frame", "m"},
                                      {"rpe_frame", "deg"}})
        for (const char* figure : {"rmse", "mean", "median", "std", "max"})
            csv += std::string(",") + error + "_" + figure + "_" + unit;
    csv += '\n';
    for (const JudgedEstimate& e : estimates) {
        csv += csvField(e.name) + "," + csvField(e.file) + "," + alignment + "," +
               exactNumber(e.evaluation.scale) + "," + std::to_string(e.poses) + "," +
               std::to_string(e.evaluation.pairs.size());
        appendFigures(e.evaluation.ate.translation, csv);
        appendFigures(e.evaluation.rpe_second.translation, csv);
        appendFigures(e.evaluation.rpe_second.rotation, csv);
        appendFigures(e.evaluation.rpe_frame.translation, csv);
        appendFigures(e.evaluation.rpe_frame.rotation, csv);
        csv += '\n';
    }
    return csv;
}

Table pageTable(const std::vector<JudgedEstimate>& estimates) {
    Table table{"", "Estimate", {"pairs", "scale"}, {}, {}};
    for (const Column& column : kColumns)
        table.columns.push_back(std::string(column.title) + " [" + column.unit + "]");
    for (const JudgedEstimate& e : estimates) {
        table.rows.push_back({e.name, false, false, {}, {}});
        auto& cells = table.rows.back().cells;
        cells.push_back({std::to_string(e.evaluation.pairs.size()), false, false, {}});
        cells.push_back({shownNumber(e.evaluation.scale, 4), false, false, {}});
        for (const Column& column : kColumns) {
            const std::string shown = shownFigure(column, e.evaluation);
            cells.push_back({shown.empty() ? kDash : shown, isBest(column, e, estimates), false,
                             shown.empty() ? "no two poses are that far apart" : ""});
        }
    }
    return table;
}

std::string latexTable(const std::vector<JudgedEstimate>& estimates) {
    std::string columns = "l", head = "method", rows;
    for (const Column& column : kColumns) {
        columns += 'r';
        head += std::string(" & ") + column.latex;
    }
    for (const JudgedEstimate& e : estimates) {
        rows += latexText(e.name);
        for (const Column& column : kColumns) {
            const std::string shown = shownFigure(column, e.evaluation);
            rows += " & " + (isBest(column, e, estimates) ? "\\textbf{" + shown + "}"
                             : shown.empty()              ? "--"
                                                          : shown);
        }
        rows += " \\\\\n";
    }
    return "\\begin{tabular}{" + columns + "}\n\\hline\n" + head + " \\\\\n\\hline\n" + rows +
           "\\hline\n\\end{tabular}\n";
}

}  // namespace roevo
