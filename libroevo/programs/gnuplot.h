#pragma once
#include <stdexcept>
#include <string>
#include <vector>

namespace roevo {

/// There is no gnuplot on this machine: other plots need not be tried.
struct NoGnuplot : std::runtime_error {
    using std::runtime_error::runtime_error;
};

/// Draws one figure with gnuplot: a common look (typeface, grid, colours that the colour-blind can tell apart
/// as line types 1 to 8), then `script`.
/// @param script  gnuplot commands without `set terminal` and `set output`, `plot` or `multiplot` among them
/// @param width, height  px
/// @return the SVG
/// @throws NoGnuplot; std::runtime_error in one line when gnuplot complains, draws nothing or comes to no
/// end; Interrupted after a signal (needs an InterruptGuard)
std::string drawSvgText(const std::string& script, int width, int height);

/// The same into a file, which appears when whole.
void drawSvg(const std::string& path, const std::string& script, int width = 860, int height = 480);

/// A text as gnuplot writes it, in quotes, every character as it is (no sub- and superscripts).
std::string gnuplotText(const std::string& text);

/// A data block `$name` for a script. Numbers that are not finite leave a gap in a line.
std::string gnuplotData(const std::string& name, const std::vector<std::vector<double>>& rows);

}  // namespace roevo
