#pragma once
#include <vector>

#include "edges/organized_edges.h"
#include "roevo/camera/pinhole_camera.h"
#include "roevo/camera/rgbd_frame.h"
#include "roevo/edge_map.h"

namespace roevo {

/// Of a pixel of a frame; grey where the frame has no colour.
Rgb colourAt(const RgbdFrame& frame, int u, int v);

/// What is a surface in a depth image.
struct SurfaceLimits {
    double min_depth, max_depth;  ///< m, of depths that can be trusted
    double jump;  ///< relative; where depth changes more to the next pixel, sensors average over both sides
};

/// The surface next to the edges: pixels around edge points, as coloured points.
/// @param edges  ideal px
/// @param frame  as the lens saw it; grey where it has no colour
/// @param camera  of the frame, with its distortion
/// @param radius_px  how far from an edge point pixels are taken; 0: the points' own pixels
/// @param max_points  where there are more, this many of them, evenly along the edges
/// @return optical camera frame, m
std::vector<ColouredPoint> sampleSemiDense(const OrganizedEdges& edges, const RgbdFrame& frame,
                                           const PinholeCamera& camera, int radius_px,
                                           const SurfaceLimits& limits, int max_points);

}  // namespace roevo
