#pragma once
/// What the benchmarks work on: simulated frames held in memory, and the pieces made of the first of them.

#include <vector>

#include "edges/canny.h"
#include "edges/gradient.h"
#include "edges/organized_edges.h"
#include "roevo/camera/rgbd_frame.h"
#include "roevo/options.h"
#include "tracking/edge_points.h"
#include "tracking/photometric.h"

namespace roevo::bench {

/// The simulated living room, 640x480, with the noise of a Kinect.
struct Room {
    PinholeCamera camera;
    std::vector<RgbdFrame> frames;

    // Of the first frame, with the default options:
    Gradient gradient;
    CannyThresholds thresholds;
    EdgeMask raw_mask;  ///< before the adjustment of adjacency
    OrganizedEdges edges;
    ImagePyramid pyramid;
    EdgePoints3D points;
    PhotometricPoints photometric;
};

/// Made at the first call; takes some seconds.
const Room& room();

}  // namespace roevo::bench
