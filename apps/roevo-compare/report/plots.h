#pragma once
#include <string>
#include <utility>
#include <vector>

#include "roevo-compare/report/line_style.h"
#include "roevo-compare/report/results.h"

namespace roevo {

inline constexpr int kFigureWidth = 960;  ///< px, of what fills a page

/// A drawing and what has to be said of it. No drawing when there is nothing to draw; then `note` says why.
struct Figure {
    std::string svg;   ///< an <svg> element that can stand in a page with others
    std::string name;  ///< for those who cannot see it
    std::string note;  ///< in words: what left the picture, what could not be drawn; may be empty
    std::vector<std::pair<std::string, unsigned>> fills{};   ///< names and 0xrrggbb of areas, for a legend
    std::vector<std::pair<std::string, LineStyle>> lines{};  ///< names and looks of lines, likewise
    int width = 0, height = 0;                               ///< px
};

/// Methods of a report with their looks.
struct Legend {
    std::vector<TableMethod> methods;
    std::vector<LineStyle> styles;
    /// Position of a method in both lists. @throws std::out_of_range
    std::size_t indexOf(const std::string& method) const;
};

/// Trajectories from two sides, aligned with the ground truth; without one each from its own
/// first pose. Up is the axis of the world nearest to the mean of the cameras' up. @return two figures, or
/// one that says why there is none. @throws as drawFigure()
std::vector<Figure> trajectoryFigures(const SequenceResults& results, const Legend& legend);

/// Distance of the aligned camera centres from the ground truth over time. @throws as drawFigure()
Figure errorFigure(const SequenceResults& results, const Legend& legend);

/// Angle between the aligned cameras' attitudes and the ground truth's over time. @throws as drawFigure()
Figure angularErrorFigure(const SequenceResults& results, const Legend& legend);

/// What the aligned camera centres are off along x, y and z of the ground truth's world over time, one above
/// the other. @throws as drawFigure()
Figure axisErrorFigure(const SequenceResults& results, const Legend& legend);

/// Mean relative error by path length, see relativePoseErrorOverDistance(): translation in % and rotation in
/// deg/m over lengths from 0.1 m on. None where no run has enough pieces of any length. @throws as
/// drawFigure()
std::vector<Figure> relativeErrorFigures(const SequenceResults& results, const Legend& legend);

/// Share of the paired poses whose distance is at most so much. @throws as drawFigure()
Figure cumulativeErrorFigure(const SequenceResults& results, const Legend& legend);

/// Mean time per frame of each run as a bar of its stages. @param stages  names in the order of stageRgb();
/// new ones are added, so that a stage has one colour in all plots. @throws as drawFigure()
Figure stageFigure(const SequenceResults& results, std::vector<std::string>& stages);

/// Draws with gnuplot, see programs/gnuplot.h: an <svg> element whose names are its own, as wide as its
/// place. Where gnuplot cannot draw just this, there is no drawing and the note says why.
/// @throws NoGnuplot; Interrupted
Figure drawFigure(const std::string& script, int width, int height, const std::string& name,
                  const std::string& note);

/// A note that also says, where the lowest of what is drawn is the least that is drawn on a logarithmic axis,
/// that what is less stands there.
std::string withLeast(const std::string& note, double lowest, double least);

/// A document of its own, with a white ground and the figure's legend beneath it.
std::string standaloneSvg(const Figure& figure);

/// Poses brought into the ground truth's world.
std::vector<StampedPose> aligned(const std::vector<StampedPose>& trajectory, const Evaluation& evaluation);

/// Between poses that are farther apart in time than this nothing is known, and no line is drawn: 3.5 times
/// the median of the steps.
double largestStep(const std::vector<double>& times);

/// At most `limit` of so many, evenly, the last among them.
std::vector<std::size_t> evenly(std::size_t count, std::size_t limit);

}  // namespace roevo
