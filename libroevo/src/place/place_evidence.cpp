#include "place/place_evidence.h"

#include <algorithm>

namespace roevo {
namespace {

// Of 28,000 pairs of views of different doors and rooms that are alike (simulated, with and without noise; 8
// points or more agree and edges hold the pose) one is conclusive, 11 more are strong and 8 more fit; of such
// pairs of one place in real recordings 38 and 45 of a hundred are the first and the first two, and one in a
// hundred is below kLeastAlike. Shares of points and of edges that agree tell less, but where less than half
// is in view of both: seen from so far elsewhere, surroundings look different at the right place, too.
constexpr int kLeastInView = 30;
constexpr double kDepths = 0.7;                                     ///< of them, those that agree
constexpr double kSame = 0.99, kSimilar = 0.98, kLeastAlike = 0.8;  ///< shares of what surrounds the points
constexpr double kSeenFromElsewhere = 0.5;                          ///< share in view
constexpr double kMatched = 0.8;                                    ///< of the edges, both ways
constexpr double kFit = 0.7;  ///< mean of these shares and that of the points
/// Points that agree: symmetric furniture, seen from its other side, had up to 15.
constexpr int kManyPoints = 20, kSomePoints = 16;

// Of 296 poses that tracking found after a gap or by a search (simulated, with gaps; clips; around a cabinet
// with a view in 0.67 s) and that edges held, those right to 5 cm have depths of 0.64 and more, edges of
// 0.44, surroundings of 0.8; wrong ones lack one of these (at best 0.57, 0.34, 0.62), but for two of a fast
// turn, 6 cm off
constexpr double kConfirmingDepths = 0.6, kConfirmingEdges = 0.4, kConfirmingSurroundings = 0.7;

}  // namespace

Evidence evidenceOf(const Verification& points, const EdgeRegistration& edges, const Likeness& likeness) {
    if (!edges.held || edges.depth_agreement < kDepths || likeness.visible < kLeastInView)
        return Evidence::kNone;
    const double alike = likeness.share();
    const bool some = points.inliers >= kSomePoints, many = points.inliers >= kManyPoints;
    if (some && alike >= kSame) return Evidence::kConclusive;
    if (some && alike >= kSimilar) return Evidence::kStrong;
    const bool from_elsewhere = edges.visible < kSeenFromElsewhere;
    const double agreed = static_cast<double>(points.inliers) / points.matches;
    const double fit = (agreed + edges.keyframe_matched + edges.frame_matched) / 3;
    if (many && from_elsewhere && fit >= kFit &&
        std::min(edges.keyframe_matched, edges.frame_matched) >= kMatched)
        return Evidence::kFitting;
    if (alike < kLeastAlike) return Evidence::kNone;
    return many ? Evidence::kPlausible : Evidence::kWeak;
}

bool confirms(const EdgeRegistration& edges, const Likeness& likeness) {
    return edges.held && edges.depth_agreement >= kConfirmingDepths &&
           std::min(edges.keyframe_matched, edges.frame_matched) >= kConfirmingEdges &&
           (likeness.visible < kLeastInView || likeness.share() >= kConfirmingSurroundings);
}

}  // namespace roevo
