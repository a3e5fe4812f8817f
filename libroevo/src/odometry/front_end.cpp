#include "front_end.h"

#include <cmath>
#include <opencv2/imgproc.hpp>

namespace roevo {

cv::Mat FrontEnd::sceneOf(RgbdFrame& images) const {
    if (images.mask.empty()) return {};
    // The outline of what is masked is an edge, too, and takes its depth from some pixels beside it.
    const int margin = static_cast<int>(std::lround(0.01 * images.mask.cols));
    const cv::Size around(2 * margin + 1, 2 * margin + 1);
    cv::Mat scene, ideal;
    cv::erode(images.mask, scene, cv::getStructuringElement(cv::MORPH_RECT, around));
    if (!images.depth.empty()) {
        cv::Mat depth;  // the images may be somebody else's, too
        images.depth.copyTo(depth, scene);
        images.depth = depth;
    }
    return undistorter_.apply(scene, ideal);
}

void FrontEnd::process(Frame& frame) {
    const cv::Mat& grey = undistorter_.apply(frame.images.grey, frame.ideal_grey);
    extractor_.extract(grey, frame.edges, frame.mask, sceneOf(frame.images));
    frame.grid.build(frame.edges, grey.cols, grey.rows);
    frame.pyramid.build(grey, levels_);
}

}  // namespace roevo
