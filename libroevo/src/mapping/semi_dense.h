#pragma once
#include <vector>

#include "edges/organized_edges.h"
#include "roevo/camera/pinhole_camera.h"
#include "roevo/camera/rgbd_frame.h"
#include "roevo/edge_map.h"

namespace roevo {

/// Of a pixel of a frame; grey where the frame has no colour.
Rgb colourAt(const RgbdFrame& frame, int u, int v);

/// The surface next to the edges: the pixels around edge points that have a depth, as coloured points.
/// @param edges  ideal px
/// @param frame  as the lens saw it; grey where it has no colour
/// @param camera  of the frame, with its distortion
/// @param radius_px  how far from an edge point pixels are taken; 0: the points' own pixels
/// @param max_points  where there are more, this many of them, evenly over the image
/// @return optical camera frame, m, row by row
std::vector<ColouredPoint> sampleSemiDense(const OrganizedEdges& edges, const RgbdFrame& frame,
                                           const PinholeCamera& camera, int radius_px, int max_points);

}  // namespace roevo
