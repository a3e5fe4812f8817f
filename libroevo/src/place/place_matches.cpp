#include "place/place_matches.h"

#include <algorithm>
#include <array>
#include <tuple>

// Counting bits is most of the work, and the processor's own instruction for it makes that several times
// faster; it is no part of the oldest processors of this architecture.
#if defined(__x86_64__) && defined(__GNUC__)
#define ROEVO_POPCNT_CHOICE
#endif

namespace roevo {
namespace {

constexpr int kMostBits = 80;                                 ///< that may differ
constexpr float kElsewhere = 0.1F;                            ///< m; nearer points of an edge look alike
constexpr int kRatioNumerator = 95, kRatioDenominator = 100;  ///< of the distances of the best and of others
constexpr int kNone = Descriptor::kBits + 1;

std::size_t lookedAt(const PlacePoints& points) {
    return std::min(points.size(), kMaxPlacePoints);
}

/// The most similar point of the other keyframe, for each point of both; the first of equal ones.
struct Nearest {
    std::array<std::int32_t, kMaxPlacePoints> of_query, of_candidate;
    std::array<std::int32_t, kMaxPlacePoints> query_distance, candidate_distance;
};

__attribute__((always_inline)) inline void searchAll(const PlacePoints& query, const PlacePoints& candidate,
                                                     Nearest& out) {
    out.query_distance.fill(kNone);
    out.candidate_distance.fill(kNone);
    const std::size_t candidates = lookedAt(candidate);
    for (std::size_t i = 0; i < lookedAt(query); ++i) {
        for (std::size_t j = 0; j < candidates; ++j) {
            const int distance = hammingDistance(query[i].descriptor, candidate[j].descriptor);
            if (distance < out.query_distance[i]) {
                out.query_distance[i] = distance;
                out.of_query[i] = static_cast<std::int32_t>(j);
            }
            if (distance < out.candidate_distance[j]) {
                out.candidate_distance[j] = distance;
                out.of_candidate[j] = static_cast<std::int32_t>(i);
            }
        }
    }
}

/// Distance of the most similar point that is somewhere else than `best`.
__attribute__((always_inline)) inline int nearestElsewhere(const PlacePoint& point, const PlacePoints& others,
                                                           const PlacePoint& best) {
    int nearest = kNone;
    for (const PlacePoint& other : others) {
        const float dx = other.x - best.x, dy = other.y - best.y, dz = other.z - best.z;
        if (dx * dx + dy * dy + dz * dz < kElsewhere * kElsewhere) continue;
        nearest = std::min(nearest, hammingDistance(point.descriptor, other.descriptor));
    }
    return nearest;
}

__attribute__((always_inline)) inline std::vector<PlaceMatch> match(const PlacePoints& query,
                                                                    const PlacePoints& candidate) {
    std::vector<PlaceMatch> out;
    Nearest nearest;
    searchAll(query, candidate, nearest);
    for (std::size_t i = 0; i < lookedAt(query); ++i) {
        const int distance = nearest.query_distance[i];
        if (distance > kMostBits) continue;
        const auto j = static_cast<std::size_t>(nearest.of_query[i]);
        if (nearest.of_candidate[j] != static_cast<std::int32_t>(i)) continue;
        const int elsewhere = nearestElsewhere(query[i], candidate, candidate[j]);
        if (kRatioDenominator * distance > kRatioNumerator * elsewhere) continue;
        out.push_back({static_cast<std::int32_t>(i), static_cast<std::int32_t>(j), distance});
    }
    return out;
}

std::vector<PlaceMatch> matchPortably(const PlacePoints& query, const PlacePoints& candidate) {
    return match(query, candidate);
}
#ifdef ROEVO_POPCNT_CHOICE
__attribute__((target("popcnt"))) std::vector<PlaceMatch> matchByPopcnt(const PlacePoints& query,
                                                                        const PlacePoints& candidate) {
    return match(query, candidate);
}
#endif

}  // namespace

std::vector<PlaceMatch> matchPlaces(const PlacePoints& query, const PlacePoints& candidate) {
    auto* matched = matchPortably;
#ifdef ROEVO_POPCNT_CHOICE
    if (__builtin_cpu_supports("popcnt")) matched = matchByPopcnt;
#endif
    std::vector<PlaceMatch> out = matched(query, candidate);
    std::sort(out.begin(), out.end(), [](const PlaceMatch& a, const PlaceMatch& b) {
        return std::tie(a.distance, a.query) < std::tie(b.distance, b.query);
    });
    return out;
}

}  // namespace roevo
