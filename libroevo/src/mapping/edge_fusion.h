#pragma once
#include <cstddef>
#include <cstdint>
#include <vector>

#include "mapping/map_keyframe.h"
#include "roevo/options.h"

namespace roevo {

constexpr double kNearestInView = 0.05;  ///< m; nearer points cannot be projected

/// A keyframe with its place among those that are refined together.
struct WindowKeyframe {
    const MapKeyframe* keyframe = nullptr;
    Pose T_world_camera = Pose::Identity();  ///< current estimate
    bool fixed = false;                      ///< fixes the gauge: not refined
};

/// Point `point` of window keyframe `slot` shows a fused point.
struct Observation {
    std::int32_t slot = 0, point = 0;
};

/// Edges of the world, each fused from keyframe edges of one cluster. Points of an edge are consecutive and
/// in order; observations of a point are consecutive, that of the edge which the point is of last.
struct FusedEdges {
    std::vector<Eigen::Vector3d> points;             ///< world, m
    std::vector<std::int32_t> begin{0};              ///< first point of each edge, plus one past the end
    std::vector<std::int32_t> observation_begin{0};  ///< of each point, plus one past the end
    std::vector<Observation> observations;
    std::vector<std::int32_t> clusters;  ///< of each edge
    std::vector<std::int32_t> views;     ///< of each edge: keyframes that see it
    std::vector<EdgeVerdict> verdicts;   ///< of each edge

    int numEdges() const { return static_cast<int>(begin.size()) - 1; }
    IndexRange pointsOf(std::size_t edge) const { return rangeOf(begin, edge); }
    IndexRange observationsOf(std::size_t point) const { return rangeOf(observation_begin, point); }
    /// Of all its points.
    IndexRange observationsOfEdge(std::size_t edge) const {
        const IndexRange own = pointsOf(edge);
        return {static_cast<std::size_t>(observation_begin[own.first]),
                static_cast<std::size_t>(observation_begin[own.end])};
    }
};

/// Fitting and stitching (Sec. VI-B): the longest edge of a cluster is the reference; a point of another edge
/// whose perpendicular foot falls between a reference point's neighbours (0 < k < 1, Eqs. (14), (15)) becomes
/// an observation of the nearest reference point, and a run of points beyond an end is stitched to it and
/// goes on merging.
class EdgeFuser {
  public:
    explicit EdgeFuser(const SensorOptions& sensor) : sensor_(sensor) {}

    /// @param clusters  of every edge of every window keyframe (see CovisibilityGraph)
    FusedEdges fuse(const std::vector<WindowKeyframe>& window, const std::vector<std::vector<int>>& clusters);

  private:
    /// Consecutive points of one edge of a window keyframe.
    struct Member {
        std::int32_t slot = 0, first = 0, length = 0;
    };
    struct Node {
        Eigen::Vector3d position;
        std::int32_t first_observation = -1;
    };
    struct Chained {
        Observation observation;
        std::int32_t next = -1;
    };
    /// Of the members in `rest_`.
    void fuseCluster(const std::vector<WindowKeyframe>& window, int cluster, FusedEdges& out);
    void observe(std::size_t node, Observation observation);
    void keepChain(std::size_t slots, int cluster, FusedEdges& out);
    void merge(const std::vector<WindowKeyframe>& window, const Member& member);
    bool stitch(const Member& member, std::size_t from, std::size_t to);
    std::int32_t fit(const Eigen::Vector3d& p, std::size_t near) const;
    bool isNear(const Eigen::Vector3d& p, const Eigen::Vector3d& reference,
                const Eigen::Vector3d& centre) const;
    bool atEnd(std::size_t node) const { return node == 0 || node + 1 == chain_.size(); }
    std::size_t nearest(const Eigen::Vector3d& p, std::size_t from, bool search_all) const;

    SensorOptions sensor_;
    std::vector<Member> apart_, rest_;
    std::vector<char> seen_;  ///< of each slot
    std::vector<Node> chain_, run_;
    std::vector<Chained> observations_;
    std::vector<Eigen::Vector3d> points_;
    std::vector<std::int32_t> assigned_;
};

}  // namespace roevo
