#pragma once
#include <cstdint>
#include <functional>
#include <map>
#include <utility>
#include <vector>

#include "mapping/map_keyframe.h"
#include "tracking/edge_association.h"

namespace roevo {

/// Which edges of keyframes show the same edge of the world (Sec. VI-A, Algorithms 1 and 2). The graph keeps
/// the associations; clusters of any set of keyframes are the disjoint sets of the associations among them.
class CovisibilityGraph {
  public:
    CovisibilityGraph(const PinholeCamera& camera, const FineOptions& fine);

    /// Inserts a keyframe: associates its edges with those of `others`, in that order (the newest first); an
    /// edge once associated is not associated again, and one that finds several fragments joins them. May be
    /// called again with keyframes of another time: they are related on their own.
    void insert(const MapKeyframe& current, const std::vector<const MapKeyframe*>& others, double radius);

    /// For every edge of `keyframes`, the index of its cluster, counted from 0 in the order of first
    /// appearance.
    std::vector<std::vector<int>> clusters(const std::vector<const MapKeyframe*>& keyframes) const;

    /// Maps keep them for ever: images have fewer than 65,536 edges.
    struct Link {
        std::uint16_t edge = 0, other_edge = 0;
        std::uint16_t points = 0;  ///< at most 65,535
    };
    struct Links {
        int other = 0;  ///< keyframe, an older one
        std::vector<Link> links;
    };
    /// Of a keyframe's edges with those of older ones.
    std::vector<Links> linksOf(int keyframe) const;
    /// As linksOf() gave them.
    void setLinks(int keyframe, std::vector<Links> links) { links_[keyframe] = std::move(links); }

  private:
    PinholeCamera camera_;
    EdgeAssociator associator_;
    std::map<int, std::vector<Links>> links_;  // by the newer keyframe
    EdgeGrid grid_;
    EdgeMatches matches_;
    ProjectedPoints3 projected_;
};

/// For every edge of some keyframes, the index of its cluster, counted from 0 in the order of first
/// appearance.
/// @param keyframes  their ids, and how many edges each has
/// @param linksOf    of a keyframe, by its id; nullptr: none
std::vector<std::vector<int>> clustersOf(
    const std::vector<std::pair<int, int>>& keyframes,
    const std::function<const std::vector<CovisibilityGraph::Links>*(int)>& linksOf);

}  // namespace roevo
