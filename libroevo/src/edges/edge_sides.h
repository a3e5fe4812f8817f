#pragma once
#include <Eigen/Core>
#include <cstddef>
#include <opencv2/core/mat.hpp>
#include <vector>

#include "edges/organized_edges.h"

namespace roevo {

/// Corrects the depths of an edge's points by the surfaces on its two sides. A patch around an edge lies on
/// both, and a plane through it misses the edge: by half the step where a frame stands out from a wall by
/// less than the noise lets a single patch tell, by the bend's depth at the edge of a box. The points before
/// and after on the same edge see the same two surfaces, and together they can tell: on each side a line is
/// fitted to the inverse depths along the normals and continued to the edge. Where the two ends meet, the
/// edge is there; where they differ by more than they err, it belongs to the nearer side. Where one side is
/// mostly background, only the other one counts: sensors smear what is near over the border, with depths from
/// further inside, and a surface that recedes towards its border came out too near. One side alone is also
/// followed further, where the longer line agrees with the shorter one.
/// @param edges   with normals
/// @param first   the edge's first point
/// @param positions  of the edge's points in `depth`, px; a lens that distorts hardly turns normals
/// @param depth   CV_32FC1, m, 0 where unknown
/// @param jump    relative step of depth beyond which is what the edge does not belong to
/// @param scale   PinholeCamera::pixelScale()
/// @param z       depths of the points, m, 0 where unknown (those stay); corrected in place
void correctBySides(const OrganizedEdges& edges, std::size_t first,
                    const std::vector<Eigen::Vector2d>& positions, const cv::Mat& depth, float jump,
                    double scale, std::vector<float>& z);

}  // namespace roevo
