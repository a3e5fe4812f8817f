#pragma once
#include <opencv2/core/mat.hpp>

#include "edges/canny.h"
#include "edges/edge_grid.h"
#include "edges/organized_edges.h"
#include "roevo/camera/rgbd_frame.h"
#include "tracking/image_pyramid.h"

namespace roevo {

/// All that an image pair becomes before it is tracked. Its buffers are used again for later images.
struct Frame {
    Frame() = default;
    Frame(const Frame&) = delete;  // images would be shared
    Frame& operator=(const Frame&) = delete;

    RgbdFrame images;      ///< that nobody else writes to
    cv::Mat ideal_grey;    ///< without the lens's distortion
    OrganizedEdges edges;  ///< ideal px
    EdgeMask mask;         ///< pixels that the edges were made of
    EdgeGrid grid;         ///< of the edges
    ImagePyramid pyramid;  ///< of the ideal image

    double timestamp() const { return images.timestamp; }
};

}  // namespace roevo
