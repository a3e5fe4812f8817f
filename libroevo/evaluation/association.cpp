#include "evaluation/association.h"

#include <algorithm>
#include <cmath>
#include <tuple>

namespace roevo {

std::vector<PosePair> associate(const std::vector<StampedPose>& reference,
                                const std::vector<StampedPose>& estimate, double max_dt) {
    std::vector<std::tuple<double, std::size_t, std::size_t>> candidates;
    std::size_t first = 0;
    for (std::size_t e = 0; e < estimate.size(); ++e) {
        const double t = estimate[e].timestamp;
        while (first < reference.size() && reference[first].timestamp < t - max_dt) ++first;
        for (std::size_t r = first; r < reference.size() && reference[r].timestamp <= t + max_dt; ++r)
            candidates.emplace_back(std::abs(reference[r].timestamp - t), e, r);
    }
    std::sort(candidates.begin(), candidates.end());

    std::vector<char> reference_used(reference.size(), 0), estimate_used(estimate.size(), 0);
    std::vector<PosePair> pairs;
    for (const auto& [dt, e, r] : candidates) {
        if (estimate_used[e] || reference_used[r]) continue;
        estimate_used[e] = reference_used[r] = 1;
        pairs.push_back({r, e});
    }
    std::sort(pairs.begin(), pairs.end(),
              [](const PosePair& a, const PosePair& b) { return a.estimate < b.estimate; });
    return pairs;
}

}  // namespace roevo
