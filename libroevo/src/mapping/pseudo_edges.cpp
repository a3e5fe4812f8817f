#include "mapping/pseudo_edges.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "tracking/robust.h"
#include "tracking/se3.h"

namespace roevo {
namespace {

constexpr double kNearest = 0.05;   ///< m; nearer points cannot be projected
constexpr double kFarOff = 100;     ///< px, for a point that cannot be projected
constexpr double kLookShare = 0.7;  ///< a keyframe looks at an edge when this share of it is in its image
constexpr double kSeeShare = 0.3;   ///< and sees it when this share of that is observed
/// A look counts by the angle to the nearest view that the edge was seen from, one sigma: seen from the side,
/// a true edge is often missed, too.
constexpr double kSideways = 15 * kDegree;
constexpr std::size_t kMostLooks = 12;  ///< points of an edge that are looked for, evenly along it
/// An edge is in an image when this share of it has an edge point near it and about in its direction:
constexpr double kImageShare = 0.5;
constexpr float kLookRadius = 3;         ///< within this radius, px of a 640x480 Kinect
constexpr float kLookSine = 0.35F;       ///< and turned by no more than this, sine of the angle
constexpr std::size_t kTangentSpan = 3;  ///< points to each side that a tangent is taken between
constexpr double kFrameEvidence = 3;     ///< keyframes that all frames since a keyframe count as

double tangentResidual(const PinholeCamera& camera, const MapKeyframe& keyframe, std::size_t i,
                       const Eigen::Vector3d& in_camera) {
    const Eigen::Vector2d normal(keyframe.image.normal_x[i], keyframe.image.normal_y[i]),
        seen(keyframe.image.x[i], keyframe.image.y[i]);
    return normal.dot(camera.project(in_camera) - seen);  // Eq. (7)
}

}  // namespace

PseudoEdgeJudge::PseudoEdgeJudge(const MappingOptions& mapping, const SensorOptions& sensor,
                                 const PinholeCamera& camera)
    : options_(mapping), sensor_(sensor), camera_(camera) {}

double PseudoEdgeJudge::spreadOf(const std::vector<WindowKeyframe>& window, const FusedEdges& edges,
                                 std::size_t p) const {
    const auto [first, end] = edges.observationsOf(p);
    double sum = 0;
    for (std::size_t k = first; k < end; ++k) {
        const WindowKeyframe& view = window[static_cast<std::size_t>(edges.observations[k].slot)];
        const auto i = static_cast<std::size_t>(edges.observations[k].point);
        const Eigen::Vector3d q =
            view.T_world_camera.linear().transpose() * (edges.points[p] - view.T_world_camera.translation());
        const double residual = q.z() > kNearest ? tangentResidual(camera_, *view.keyframe, i, q) : kFarOff;
        sum += residual * residual;
    }
    return std::sqrt(sum / static_cast<double>(end - first - 1));
}

bool PseudoEdgeJudge::isInside(const Eigen::Vector3d& in_camera) const {
    constexpr double kMargin = 5;  // px
    const double z = in_camera.z(), x = camera_.fx * in_camera.x(), y = camera_.fy * in_camera.y();
    return z > sensor_.min_depth && x >= (kMargin - camera_.cx) * z && y >= (kMargin - camera_.cy) * z &&
           x <= (camera_.width - 1 - kMargin - camera_.cx) * z &&
           y <= (camera_.height - 1 - kMargin - camera_.cy) * z;
}

bool PseudoEdgeJudge::project(std::size_t slot, const Eigen::Vector3d& point, Eigen::Vector2f& pixel) const {
    const Eigen::Vector3d q = T_camera_world_[slot] * point;
    if (!(q.z() > sensor_.min_depth)) return false;
    pixel = camera_.project(q).cast<float>();
    return isInside(q);
}

void PseudoEdgeJudge::countPoints(const FusedEdges& edges, std::size_t edge) {
    const auto [first, end] = edges.pointsOf(edge);
    const std::size_t slots = T_camera_world_.size(), stride = 1 + (end - first) / kMostLooks;
    inside_.assign(slots, 0);
    observed_.assign(slots, 0);
    for (std::size_t p = first; p < end; p += stride) {
        const IndexRange range = edges.observationsOf(p);
        for (std::size_t k = range.first; k < range.end; ++k)
            observer_of_[static_cast<std::size_t>(edges.observations[k].slot)] = p;
        for (std::size_t slot = 0; slot < slots; ++slot) {
            if (!isInside(T_camera_world_[slot] * edges.points[p])) continue;
            ++inside_[slot];
            observed_[slot] += observer_of_[slot] == p ? 1 : 0;
        }
    }
}

PseudoEdgeJudge::Looks PseudoEdgeJudge::looksAt(const std::vector<WindowKeyframe>& window,
                                                const FusedEdges& edges, std::size_t edge) {
    countPoints(edges, edge);
    const auto [first, end] = edges.pointsOf(edge);
    const std::size_t stride = 1 + (end - first) / kMostLooks;
    const double count = static_cast<double>((end - first + stride - 1) / stride);
    rays_.clear();
    for (const WindowKeyframe& view : window)
        rays_.push_back((view.T_world_camera.translation() - edges.points[(first + end) / 2]).normalized());
    Looks looks;
    bool is_first = true;
    for (std::size_t slot = 0; slot < window.size(); ++slot) {
        if (inside_[slot] < kLookShare * count) continue;
        // The keyframe in which an edge was found first proves nothing
        if (observed_[slot] > 0 && std::exchange(is_first, false)) continue;
        double nearest = -1;  // cosine
        for (std::size_t other = 0; other < window.size(); ++other)
            if (other != slot && observed_[other] > 0)
                nearest = std::max(nearest, rays_[slot].dot(rays_[other]));
        const double aside = std::acos(std::min(nearest, 1.0)) / kSideways;
        const double weight = std::exp(-aside * aside / 2);
        looks.looked += weight;
        if (observed_[slot] >= kSeeShare * inside_[slot])
            looks.seen += weight;
        else
            looks.missed.emplace_back(slot, weight);
    }
    return looks;
}

bool PseudoEdgeJudge::isInImage(std::size_t slot, const OrganizedEdges& image, const FusedEdges& edges,
                                std::size_t edge) const {
    const auto [first, end] = edges.pointsOf(edge);
    int inside = 0, found = 0;
    const std::size_t stride = 1 + (end - first) / kMostLooks;
    const double enough = kImageShare * static_cast<double>((end - first + stride - 1) / stride);
    const auto radius = std::max(1.0F, static_cast<float>(camera_.pixelScale())) * kLookRadius;
    Eigen::Vector2f pixel, before, after;
    for (std::size_t p = first; p < end && found < enough && inside - found <= enough; p += stride) {
        if (!project(slot, edges.points[p], pixel)) continue;
        ++inside;
        before = after = pixel;  // where a neighbour is behind the camera
        project(slot, edges.points[std::max(first + kTangentSpan, p) - kTangentSpan], before);
        project(slot, edges.points[std::min(end - 1, p + kTangentSpan)], after);
        const Eigen::Vector2f chord = after - before;
        const float limit = kLookSine * chord.norm();
        found += grid_.any(pixel.x(), pixel.y(), radius, [&](std::size_t i) {
            return std::abs(chord.x() * image.normal_x[i] + chord.y() * image.normal_y[i]) < limit;
        });
    }
    return found >= kImageShare * inside;
}

void PseudoEdgeJudge::judge(const std::vector<WindowKeyframe>& window, FusedEdges& edges, double scale) {
    suspects_.clear();
    T_camera_world_.clear();
    for (const WindowKeyframe& view : window) T_camera_world_.push_back(view.T_world_camera.inverse());
    observer_of_.assign(window.size(), edges.points.size());
    std::vector<double> spreads;
    for (std::size_t edge = 0; edge < edges.views.size(); ++edge) {
        EdgeVerdict& verdict = edges.verdicts[edge];
        verdict = edges.views[edge] > 1 ? EdgeVerdict::kTrue : EdgeVerdict::kUnconfirmed;
        spreads.clear();
        const auto [first, end] = edges.pointsOf(edge);
        for (std::size_t p = first; p < end; ++p) {
            if (edges.observationsOf(p).size() >= 2) spreads.push_back(spreadOf(window, edges, p));
        }
        if (!spreads.empty() && medianOf(spreads) > options_.max_spread * scale) {
            verdict = EdgeVerdict::kSpread;
            continue;
        }
        Suspect suspect{edge, looksAt(window, edges, edge), foundShare(window, edges, edge), 0};
        if (isVanishing(suspect)) suspects_.push_back(std::move(suspect));
    }
    askImages(window, edges);
    for (const Suspect& suspect : suspects_) {
        if (isVanishing(suspect)) edges.verdicts[suspect.edge] = EdgeVerdict::kVanishing;
    }
}

/// Associations miss edges that are in pieces: before an edge is called vanishing, the images themselves.
void PseudoEdgeJudge::askImages(const std::vector<WindowKeyframe>& window, const FusedEdges& edges) {
    for (std::size_t slot = 0; slot < window.size(); ++slot) {
        const OrganizedEdges& image = window[slot].keyframe->image;
        bool built = false;
        for (Suspect& suspect : suspects_) {
            const auto& missed = suspect.looks.missed;
            if (suspect.asked == missed.size() || missed[suspect.asked].first != slot) continue;
            const double weight = missed[suspect.asked++].second;
            Suspect at_best{suspect.edge, {suspect.looks.looked, suspect.looks.seen, {}}, suspect.found, 0};
            for (std::size_t k = suspect.asked - 1; k < missed.size(); ++k)
                at_best.looks.seen += missed[k].second;
            if (!isVanishing(suspect) || isVanishing(at_best)) continue;
            if (!built) grid_.build(image, camera_.width, camera_.height);
            built = true;
            if (isInImage(slot, image, edges, suspect.edge)) suspect.looks.seen += weight;
        }
    }
}

bool PseudoEdgeJudge::isVanishing(const Suspect& suspect) const {
    const double frames = suspect.found < 0 ? 0 : kFrameEvidence;
    const double evidence = suspect.looks.looked + frames;
    if (evidence < options_.min_looks - 1) return false;
    return suspect.looks.seen + frames * suspect.found < options_.min_seen * evidence;
}

double PseudoEdgeJudge::foundShare(const std::vector<WindowKeyframe>& window, const FusedEdges& edges,
                                   std::size_t edge) const {
    double sum = 0;
    int count = 0;
    const auto [first, end] = edges.observationsOfEdge(edge);
    for (std::size_t k = first; k < end; ++k) {
        const MapKeyframe& keyframe = *window[static_cast<std::size_t>(edges.observations[k].slot)].keyframe;
        const std::int32_t own =
            keyframe.image.edge_of[static_cast<std::size_t>(edges.observations[k].point)];
        const float found = keyframe.found[static_cast<std::size_t>(own)];
        if (found < 0) continue;
        sum += static_cast<double>(found);
        ++count;
    }
    return count > 0 ? sum / count : -1;
}

}  // namespace roevo
