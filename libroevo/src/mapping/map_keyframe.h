#pragma once
#include <algorithm>
#include <vector>

#include "roevo/camera/pinhole_camera.h"
#include "roevo/edge_map.h"
#include "tracking/keyframe.h"

namespace roevo {

/// The edges of a keyframe with every n-th point, all moved to one moment of a rolling shutter.
struct KeyframeEdges {
    OrganizedEdges image;       ///< where the points would be seen at the reference row's time, ideal px;
                                ///< without gradients
    Points3 points;             ///< camera frame, m; padded
    std::vector<float> weight;  ///< w_s(depth), Eq. (20)
    std::vector<float> slope;   ///< of depth along the edge towards (-normal_y, normal_x), m/px
    std::vector<Rgb> colours;   ///< of each point

    std::size_t size() const { return image.size(); }
};

/// What the map keeps of a keyframe.
struct MapKeyframe : KeyframeEdges {
    int id = 0;
    Pose T_world_camera = Pose::Identity();
    int parent = -1;  ///< keyframe that it was tracked from, -1: none (the first, or re-anchored)
    Pose T_parent_camera = Pose::Identity();  ///< as tracked
    /// First keyframe of its track. Where tracks are relative to each other is a guess, so that the map
    /// relates no edges of one to those of another.
    int track = 0;
    /// Of T_parent_camera: position, then orientation, along the camera's axes
    Matrix6d parent_information = Matrix6d::Zero();
    std::vector<std::int32_t> clusters;  ///< of each edge, see Keyframe::clusters
    std::vector<float> found;  ///< of each edge: share of the frames after it that found it; < 0: not known
    std::vector<EdgeVerdict> verdicts;  ///< of each edge; empty: none yet
    double median_depth = 0;            ///< m
    RowMotion row_motion;               ///< that the points were moved with

    /// For what only needs an order of magnitude, m.
    double typicalDepth() const { return std::max(median_depth, 0.1); }
};

/// Fills slope: a line through the depths of the points up to 4 places before and after.
void computeSlopes(KeyframeEdges& edges);

/// Moves the points to where they are with another motion of the rows.
void setRowMotion(MapKeyframe& keyframe, const RowMotion& rows, const PinholeCamera& camera);

/// @param colours  one per point of the keyframe's edges
/// @param max_points  points are thinned evenly along the edges until there are no more than these
MapKeyframe toMapKeyframe(const Keyframe& keyframe, const std::vector<Rgb>& colours,
                          const PinholeCamera& camera, int max_points);

}  // namespace roevo
