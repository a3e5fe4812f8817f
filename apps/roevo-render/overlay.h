#pragma once
#include <opencv2/core/mat.hpp>
#include <vector>

#include "background.h"
#include "legend.h"
#include "view.h"

namespace roevo {

/// A strip below a picture with its legend and a scale bar of a round length.
class Overlay {
  public:
    /// @param size  of the whole picture, pixels
    Overlay(std::vector<LegendEntry> entries, const Background& background, cv::Size size);

    /// Height of the strip, pixels; 0 where the picture has no room for one.
    int height() const { return height_; }
    /// The strip. @param pixels_per_metre  of the bar; where not `exact`, it says that it holds in the middle
    cv::Mat draw(double pixels_per_metre, bool exact) const;

  private:
    struct Place {
        int x, line;
    };
    std::vector<LegendEntry> entries_;
    std::vector<Place> places_;
    const Background background_;
    int width_, unit_, bar_line_ = 0, height_ = 0;
};

}  // namespace roevo
