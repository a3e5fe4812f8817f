#include "front_end.h"

namespace roevo {

void FrontEnd::process(const RgbdFrame& images, Frame& out) {
    out.images.timestamp = images.timestamp;
    images.grey.copyTo(out.images.grey);
    images.depth.copyTo(out.images.depth);
    images.colour.copyTo(out.images.colour);
    const cv::Mat& grey = undistorter_.apply(out.images.grey, out.ideal_grey);
    extractor_.extract(grey, out.edges, out.mask, kFrameRate * (images.timestamp - last_timestamp_));
    last_timestamp_ = images.timestamp;
    out.grid.build(out.edges, grey.cols, grey.rows);
    out.pyramid.build(grey, levels_);
}

}  // namespace roevo
