#pragma once
#include <string>
#include <vector>

#include "evaluation/evaluate.h"
#include "roevo-compare/report/tables.h"

namespace roevo {

/// An estimate and what is wrong with it.
struct JudgedEstimate {
    std::string name, file;
    std::size_t poses = 0;
    Evaluation evaluation;
    std::vector<StampedPose> trajectory;  ///< with the scale taken off
};

/// Whether it is judged by about as many poses as the others: errors of a part do not compare.
bool isComparable(const JudgedEstimate& estimate, const std::vector<JudgedEstimate>& all);

/// One row per estimate, for a terminal.
std::string terminalTable(const std::vector<JudgedEstimate>& estimates);

/// One row per estimate, every figure in SI units and degrees; empty where nothing could be measured.
std::string csvTable(const std::vector<JudgedEstimate>& estimates, const std::string& alignment);

/// The figures of terminalTable() for a page, the best of each column marked.
Table pageTable(const std::vector<JudgedEstimate>& estimates);

/// A tabular of the figures that papers give, in cm and degrees; the best of each column is bold.
std::string latexTable(const std::vector<JudgedEstimate>& estimates);

}  // namespace roevo
