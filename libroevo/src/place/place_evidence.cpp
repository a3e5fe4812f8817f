#include "place/place_evidence.h"

#include <algorithm>

namespace roevo {
namespace {

// Measured at other doors of a corridor in which all doors are alike, without noise in the scene: 0.91 of the
// points in view looked as they did at most, and 0.75 of the edges were found both ways.
constexpr int kLeastInView = 50;
constexpr double kLeastLikeness = 0.93;
/// Of the edges, both ways; from elsewhere, surroundings look different at the right place, too.
constexpr double kMostlyMatched = 0.77;

}  // namespace

Evidence evidenceOf(const Verification& points, const EdgeRegistration& edges, const Likeness& likeness) {
    const double confidence = placeConfidence(points, edges);
    const bool alike = likeness.visible >= kLeastInView && likeness.share() >= kLeastLikeness;
    const bool fits = edges.accepted && confidence >= kUnambiguousConfidence;
    const bool fits_well = fits && std::min(edges.keyframe_matched, edges.frame_matched) >= kMostlyMatched;
    if (alike && fits) return Evidence::kConclusive;
    if (fits_well || (alike && edges.determined && points.inliers >= kLeastAgreeingPoints))
        return Evidence::kStrong;
    return confidence > 0 ? Evidence::kPlausible : Evidence::kNone;
}

}  // namespace roevo
