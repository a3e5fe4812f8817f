#pragma once
#include <string>
#include <vector>

#include "evaluation/evaluate.h"

namespace roevo {

/// An estimate and what is wrong with it.
struct JudgedEstimate {
    std::string name, file;
    std::size_t poses = 0;
    Evaluation evaluation;
};

/// One row per estimate, for a terminal.
std::string terminalTable(const std::vector<JudgedEstimate>& estimates);

/// One row per estimate, every figure in SI units and degrees; empty where nothing could be measured.
std::string csvTable(const std::vector<JudgedEstimate>& estimates, const std::string& alignment);

/// A tabular of the figures that papers give, in cm and degrees; the best of each column is bold.
std::string latexTable(const std::vector<JudgedEstimate>& estimates);

}  // namespace roevo
