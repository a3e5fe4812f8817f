#pragma once
#include <string>
#include <vector>

#include "roevo-compare/report/results.h"

namespace roevo {

/// How a method is drawn, the same in every plot of a report: colours that the colour-blind can tell apart,
/// dashed where they come again; ROEVO's own modes are blue and thicker.
struct LineStyle {
    std::string colour;  ///< "#rrggbb"
    double width = 1.6;  ///< px
    std::string dashes;  ///< lengths in units of 1 px, e.g. "6,3"; empty: solid
};

/// Index by index for the methods of a report.
std::vector<LineStyle> lineStyles(const std::vector<TableMethod>& methods);

/// `lc rgb '…' lw … dt (…)` for gnuplot.
std::string gnuplotStyle(const LineStyle& style);

/// The ground truth: a broad band beneath the other lines.
LineStyle groundTruthStyle();

/// In place of a stage: time that belongs to none.
constexpr std::size_t kNoStage = static_cast<std::size_t>(-1);

/// Fill of the n-th stage of a bar, 0xrrggbb; a light grey for kNoStage.
unsigned stageRgb(std::size_t index);

}  // namespace roevo
