#pragma once
#include <cstdint>
#include <opencv2/core/mat.hpp>
#include <vector>

#include "edges/organized_edges.h"
#include "roevo/camera/pinhole_camera.h"
#include "roevo/options.h"
#include "tracking/rolling_shutter.h"

namespace roevo {

/// Organized edges with depth: 2-D points as OrganizedEdges has them, plus their position in the camera
/// frame. Only points with depth are kept, and an edge is split where consecutive points jump in depth.
struct EdgePoints3D {
    OrganizedEdges image;              ///< 2-D side; points without depth are gone
    Points3 points;                    ///< camera frame, m; padded
    std::vector<float> correction;     ///< m that correctBySides() added to the depth of the patch
    std::vector<float> weight;         ///< w_s(depth), Eq. (20)
    std::vector<std::int32_t> source;  ///< index of the point among those of the image

    std::size_t size() const { return image.size(); }
    float medianDepth() const;  ///< m; 0 when empty
};

/// w_s(d) of Eq. (20).
double depthWeight(double depth, const SensorOptions& sensor);

/// Whether a point may have both depths, m: what is expected, and what is seen.
bool depthsAgree(double expected, double seen, const SensorOptions& sensor);

/// Looks up the foreground depth of every edge point (`depth` is the raw image of the possibly distorted
/// `camera`, the edges are in ideal pixels), corrects it by the edge's two sides (correctBySides()), splits
/// edges at depth jumps and drops pieces of fewer than five points.
/// @param rows  motion of the camera over the image rows; points are moved to where they are at the reference
/// row's time
EdgePoints3D liftEdges(const OrganizedEdges& edges, const cv::Mat& depth, const PinholeCamera& camera,
                       const RowMotion& rows, const EdgeOptions& edge_options, const SensorOptions& sensor);

}  // namespace roevo
