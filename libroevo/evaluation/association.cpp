#include "evaluation/association.h"

#include <algorithm>
#include <cmath>
#include <tuple>

namespace roevo {

std::vector<StampMatch> associateStamps(const std::vector<double>& first, const std::vector<double>& second,
                                        double max_difference) {
    std::vector<std::tuple<double, std::size_t, std::size_t>> candidates;
    for (std::size_t i = 0; i < first.size(); i++) {
        auto j = std::lower_bound(second.begin(), second.end(), first[i] - max_difference);
        for (; j != second.end() && *j <= first[i] + max_difference; ++j)
            candidates.emplace_back(std::abs(*j - first[i]), i, static_cast<std::size_t>(j - second.begin()));
    }
    std::sort(candidates.begin(), candidates.end());

    std::vector<bool> first_taken(first.size()), second_taken(second.size());
    std::vector<StampMatch> matches;
    for (const auto& [difference, i, j] : candidates) {
        if (first_taken[i] || second_taken[j]) continue;
        first_taken[i] = second_taken[j] = true;
        matches.push_back({i, j});
    }
    std::sort(matches.begin(), matches.end(),
              [](const StampMatch& a, const StampMatch& b) { return a.first < b.first; });
    return matches;
}

double smallestDifference(const std::vector<double>& a, const std::vector<double>& b) {
    double smallest = INFINITY;
    for (const double t : a) {
        const auto next = std::lower_bound(b.begin(), b.end(), t);
        if (next != b.end()) smallest = std::min(smallest, *next - t);
        if (next != b.begin()) smallest = std::min(smallest, t - *(next - 1));
    }
    return smallest;
}

std::vector<PosePair> associate(const std::vector<StampedPose>& reference,
                                const std::vector<StampedPose>& estimate, double max_dt) {
    std::vector<PosePair> pairs;
    for (const StampMatch& match : associateStamps(stampsOf(estimate), stampsOf(reference), max_dt))
        pairs.push_back({match.second, match.first});
    return pairs;
}

}  // namespace roevo
