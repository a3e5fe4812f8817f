#include "place/sampling_pattern.h"

#include <cmath>
#include <random>
#include <vector>

#include "roevo/types.h"

namespace roevo {
namespace {

constexpr int kSitesOfRing[] = {1, 6, 10, 14, 18};
constexpr int kRings = 4;  ///< beside the middle
// Half the width of a site's square, in radii: what noise needs; the result hardly depends on it
constexpr double kInnerHalfWidth = 0.08, kHalfWidthGrowth = 0.08;
constexpr std::uint32_t kSeed = 1;

SamplingPattern makePattern() {
    SamplingPattern pattern{};
    std::size_t site = 0;
    for (int ring = 0; ring <= kRings; ++ring) {
        const double radius = static_cast<double>(ring) / kRings;
        const double offset = ring % 2 == 0 ? 0 : 0.5;  // sites of neighbouring rings are not in line
        for (int k = 0; k < kSitesOfRing[ring]; ++k) {
            const double angle = 2 * kPi * (k + offset) / kSitesOfRing[ring];
            pattern.sites[site++] = {static_cast<float>(radius * std::cos(angle)),
                                     static_cast<float>(radius * std::sin(angle)),
                                     static_cast<float>(kInnerHalfWidth + kHalfWidthGrowth * radius)};
        }
    }
    // Different pairs, drawn from all of them. Only pairs along the edge, which depend less on where the
    // bright side is, were worse
    std::vector<SamplingPattern::Comparison> all;
    for (int a = 0; a < SamplingPattern::kSites; ++a)
        for (int b = a + 1; b < SamplingPattern::kSites; ++b)
            all.push_back({static_cast<std::uint8_t>(a), static_cast<std::uint8_t>(b)});
    std::mt19937 random(kSeed);
    for (std::size_t k = 0; k < pattern.comparisons.size(); ++k) {
        std::swap(all[k], all[k + random() % (all.size() - k)]);
        pattern.comparisons[k] = all[k];
    }
    return pattern;
}

}  // namespace

const SamplingPattern& samplingPattern() {
    static const SamplingPattern pattern = makePattern();
    return pattern;
}

}  // namespace roevo
