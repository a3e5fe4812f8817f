#pragma once
#include <cstdint>
#include <set>
#include <utility>
#include <vector>

#include "roevo/edge_map.h"

namespace roevo {

/// What the map found to belong to no surface, by clusters (Keyframe::clusters): so later keyframes' edges
/// inherit the verdict, also where it comes only after the keyframe was replaced.
class PseudoClusters {
  public:
    /// Takes what the map says of a keyframe's edges. A cluster with a true edge is a true one.
    void judge(const std::vector<EdgeVerdict>& verdicts, const std::vector<std::int32_t>& clusters) {
        for (std::size_t e = 0; e < verdicts.size(); ++e)
            if (isPseudo(verdicts[e])) pseudo_.insert(clusters[e]);
        for (std::size_t e = 0; e < verdicts.size(); ++e)
            if (verdicts[e] == EdgeVerdict::kTrue) pseudo_.erase(clusters[e]);
    }

    /// Whether they are pseudo-edges, for each edge of the reference. Forgets clusters that it does not have.
    std::vector<bool> among(const std::vector<std::int32_t>& clusters) {
        std::set<std::int32_t> seen;
        std::vector<bool> pseudo;
        for (const std::int32_t cluster : clusters) {
            pseudo.push_back(pseudo_.count(cluster) > 0);
            if (pseudo.back()) seen.insert(cluster);
        }
        pseudo_ = std::move(seen);
        return pseudo;
    }

  private:
    std::set<std::int32_t> pseudo_;
};

}  // namespace roevo
