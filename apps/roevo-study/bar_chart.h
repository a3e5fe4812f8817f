#pragma once
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "study.h"

namespace roevo {

/// Panels above each other, in each a group of bars for every recording.
struct BarChart {
    struct Series {
        std::string label;
        int colour = 1;  ///< line type, 1 to 8
    };
    struct Panel {
        std::string y_label;
        std::vector<std::vector<double>> bars;          ///< by group, then series; kMissing: none
        std::vector<std::pair<double, double>> dots{};  ///< x as barAt() has it, y
    };

    std::string title;
    std::vector<std::string> groups;
    std::vector<Series> series;
    std::vector<Panel> panels;
    std::string dots_label;  ///< empty: there are none
    /// A dashed line at 1, what the bars are relative to.
    std::string unit_label;
    /// Small texts that stand on the axis in the place of a bar: x as barAt() has it.
    std::vector<std::pair<double, std::string>> marks;

    double barAt(std::size_t group, std::size_t of_series) const;
};

/// Draws it as `folder`/`name`, see addPlot().
void addBarChart(StudyReport& report, const std::string& folder, const std::string& name,
                 const BarChart& chart);

}  // namespace roevo
