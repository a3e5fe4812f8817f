#pragma once
#include <algorithm>
#include <cstdint>
#include <vector>

#include "roevo/edge_map.h"
#include "tracking/edge_points.h"
#include "tracking/photometric.h"

namespace roevo {

/// The reference that frames are tracked against, in its own frame: where it is in the world is up to
/// Trajectory.
struct Keyframe {
    int id = 0;
    double timestamp = 0;
    EdgePoints3D edges;
    PhotometricPoints photometric;
    RowMotion row_motion;     ///< that `edges` were lifted with
    double median_depth = 0;  ///< m
    /// Of each edge: a number that it shares with the edges of earlier keyframes that it was tracked as.
    std::vector<std::int32_t> clusters;
    /// Of each edge: points of it that frames found, and that they looked for.
    std::vector<std::int32_t> hits, trials;

    /// For what only needs an order of magnitude, m.
    double typicalDepth() const { return std::max(median_depth, 0.1); }
    /// Brings the points to where they are with another motion of the rows.
    void setRowMotion(const RowMotion& rows);
    /// Adds what a frame looked for of each edge, and found.
    void count(const std::vector<std::int32_t>& looked_for, const std::vector<std::int32_t>& found);
    /// Share of the looked-up points of each edge that frames found; negative where too few were looked up.
    std::vector<float> foundShares() const;
    /// Counts the points of pseudo-edges for less, in all residuals; to be called once.
    /// @param verdicts  of each edge
    void weaken(const std::vector<EdgeVerdict>& verdicts, double weight);
};

}  // namespace roevo
