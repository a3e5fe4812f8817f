#pragma once
#include <string>
#include <utility>
#include <vector>

#include "roevo-compare/report/metrics.h"

namespace roevo {

/// Stands where there is no figure.
constexpr char kDash[] = "–";

struct TableCell {
    std::string text;
    bool best = false;
    bool weak = false;  ///< of a run that tracked too few frames: not comparable
    std::string note;   ///< why there is a dash, or what is weak; empty when there is nothing to say
};

/// A table before it is set in Markdown or HTML. Texts are as they came, not escaped.
struct Table {
    struct Row {
        std::string head;
        bool ours = false;   ///< one of ROEVO's own modes
        bool aside = false;  ///< a figure from elsewhere: not one of those compared
        std::string link;    ///< relative address; may be empty
        std::vector<TableCell> cells{};
    };
    std::string title;   ///< with the unit
    std::string corner;  ///< head of the first column
    std::vector<std::string> columns;
    std::vector<Row> rows;
    std::string protocol;    ///< one sentence
    bool text_last = false;  ///< the last column holds words, not numbers
    /// What successive columns have in common, and how many they are; empty, or for all columns.
    std::vector<std::pair<std::string, std::size_t>> groups{};
};

/// A figure of every method (rows) on every sequence (columns), with the mean over the sequences where there
/// are several, and what the paper states where that is known. From many sequences on they are the rows.
Table figureTable(const Metric& metric, const std::vector<SequenceResults>& results,
                  const std::vector<TableMethod>& methods);

/// All figures (columns) of a sequence's runs (rows).
Table sequenceTable(const SequenceResults& results);

/// Times of a sequence's runs (rows), median and 95th percentile: in all, decoding, and the stages in words,
/// since each method has its own.
Table stageTable(const SequenceResults& results);

/// The paper's rank table, see rankTable(), by ATE and by RPE over 1 s.
Table rankingTable(const std::vector<SequenceResults>& results, const std::vector<TableMethod>& methods);

/// What stands out, in a sentence: the method with the smallest ATE on most sequences.
std::string verdict(const std::vector<SequenceResults>& results);

}  // namespace roevo
