#pragma once
#include <string>

#include "roevo-compare/report/plots.h"
#include "roevo-compare/report/tables.h"

namespace roevo {

/// The look of the page, for its <style>.
const char* pageStyle();

/// A table with its title, its footnotes and its protocol, in a box that scrolls when it is too wide.
/// @param id  of its own in the page, e.g. "t3"
/// @param titled  with the title above it
std::string setTable(const Table& table, const std::string& id, bool titled = true);

/// The lines of the methods that have a result on this sequence.
/// @param in_space  for trajectories: with the ground truth, when there is one, and the start
std::string lineLegend(const SequenceResults& results, const Legend& legend, bool in_space);

/// A method's line as it is in the plots.
std::string lineSample(const LineStyle& style);

/// Colours and marks of the plot of stages.
std::string stageLegend(const Figure& figure);

/// Files that lie beside a page and that it links to.
class PageFiles {
  public:
    /// Takes a file in. @param name  in words, e.g. "fr1_xyz: position error over time"
    /// @return its address seen from the page, `folder/fr1_xyz_position_error_over_time.svg`, of its own
    std::string add(const std::string& folder, const std::string& name, const std::string& extension,
                    std::string bytes);
    /// Addresses and bytes.
    const std::vector<std::pair<std::string, std::string>>& all() const { return files_; }

  private:
    std::vector<std::pair<std::string, std::string>> files_;
};

/// A figure, or the words why there is none. @param files  where given, the figure is also one of these, with
/// a link to it
std::string setFigure(const Figure& figure, PageFiles* files = nullptr);

/// `<tag>text</tag>`, the text escaped.
std::string element(const std::string& tag, const std::string& text);

/// Address of a file or folder as seen from another folder, for an href; empty when there is none.
std::string relativeLink(const std::string& target, const std::string& from_folder);

/// A name with places where it may be broken, escaped.
std::string breakable(const std::string& name);

}  // namespace roevo
