#pragma once
#include <opencv2/core/mat.hpp>
#include <optional>
#include <vector>

#include "frame.h"
#include "judge.h"
#include "mapping/covisibility.h"
#include "roevo/camera/pinhole_camera.h"
#include "tracking/edge_association.h"

namespace roevo {

/// Shi-Tomasi corners of a reference frame, carried from frame to frame by pyramidal Lucas-Kanade.
class CornerTracks {
  public:
    CornerTracks(const FeatureFrame& reference, const PinholeCamera& camera, const OdometryOptions& options);

    /// Follows the corners from the last frame into the next. A corner once lost stays lost.
    void advance(const FeatureFrame& previous, const FeatureFrame& current);

    const std::vector<Eigen::Vector3d>& points() const { return points_; }  ///< reference camera, m
    const std::vector<std::optional<cv::Point2f>>& positions() const { return positions_; }

  private:
    std::vector<Eigen::Vector3d> points_;
    std::vector<std::optional<cv::Point2f>> positions_;
};

/// kNormals: as the tracker does it (Sec. V-C), only points of a like normal, and a vote of an edge's points.
/// kNearest: every edge that is the nearest neighbour of some point.
enum class EdgeRule { kNearest, kNormals };

/// Edges of `current` (those with depth) associated with those of `from`, which are reprojected by
/// T_world_search and looked for within the last search radius.
EdgeLinks associateEdges(const FeatureFrame& from, const FeatureFrame& current, EdgeRule rule,
                         const PinholeCamera& camera, const OdometryOptions& options);

/// `first` then `second`: links from the edges of the one to those of the other.
EdgeLinks chain(const EdgeLinks& first, const EdgeLinks& second);

/// The disjoint sets of the co-visibility graph (Sec. VI-A, Algorithms 1 and 2) over a growing list of
/// keyframes, asked about frames that are not keyframes, too.
class DisjointSets {
  public:
    DisjointSets(const PinholeCamera& camera, const OdometryOptions& options);

    /// Inserts the frame; unless it is to stay as a keyframe it leaves at the next insert().
    void insert(const FeatureFrame& frame, bool keyframe);
    /// Edges of the frame inserted last that are in the set of each edge of an earlier keyframe.
    EdgeLinks links(std::size_t reference) const;
    /// Forgets keyframes before this frame.
    void forgetBefore(std::size_t number);

  private:
    PinholeCamera camera_;  // ideal
    OdometryOptions options_;
    CovisibilityGraph graph_;
    std::vector<MapKeyframe> keyframes_;      // in time order, the frame inserted last at the end
    std::vector<std::vector<int>> clusters_;  // of their edges
    bool last_stays_ = true;
};

}  // namespace roevo
