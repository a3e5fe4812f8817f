#include "front_end.h"

namespace roevo {

void FrontEnd::process(Frame& frame) {
    const cv::Mat& grey = undistorter_.apply(frame.images.grey, frame.ideal_grey);
    extractor_.extract(grey, frame.edges, frame.mask);
    frame.grid.build(frame.edges, grey.cols, grey.rows);
    frame.pyramid.build(grey, levels_);
}

}  // namespace roevo
