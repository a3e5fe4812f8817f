#include "frame.h"

namespace roevo {

std::shared_ptr<FeatureFrame> FeatureExtractor::extract(const RgbdFrame& frame, std::size_t number) {
    auto out = std::make_shared<FeatureFrame>();
    out->number = number;
    out->timestamp = frame.timestamp;
    cv::Mat buffer;
    out->grey = undistorter_.apply(frame.grey, buffer).clone();
    out->depth = frame.depth.clone();
    EdgeMask mask;
    extractor_.extract(out->grey, out->edges, mask);
    out->lifted = liftEdges(out->edges, out->depth, camera_, RowMotion(), options_.edges, options_.sensor);
    out->grid.build(out->edges, camera_.width, camera_.height);
    out->lifted_grid.build(out->lifted.image, camera_.width, camera_.height);
    return out;
}

}  // namespace roevo
