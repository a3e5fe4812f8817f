#include "mapping/pseudo_edges.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "tracking/robust.h"

namespace roevo {
namespace {

constexpr double kFarOff = 100;     ///< px, for a point that cannot be projected
constexpr double kLookShare = 0.7;  ///< a keyframe looks at an edge when this share of it is in its image
constexpr double kSeeShare = 0.3;   ///< and sees it when this share of that is observed
/// A look counts by the angle to the nearest view that the edge was seen from, one sigma: seen from the side,
/// a true edge is often missed, too.
constexpr double kSideways = 15 * kDegree;
constexpr std::size_t kMostLooks = 12;  ///< points of an edge that are looked for, evenly along it
/// An edge is in an image when this share of it has an edge point near it and about in its direction:
constexpr double kImageShare = 0.5;
constexpr float kLookRadius = 3;        ///< within this radius, px of a 640x480 Kinect
constexpr float kLookSine = 0.35F;      ///< and turned by no more than this, sine of the angle
constexpr std::size_t kChordReach = 3;  ///< points to each side that a tangent is taken between
constexpr double kFrameEvidence = 3;    ///< keyframes that all frames since a keyframe count as

/// Every so many of an edge's points are looked for.
std::size_t strideOf(std::size_t points) {
    return 1 + points / kMostLooks;
}

}  // namespace

double PseudoEdgeJudge::spreadOf(const std::vector<WindowKeyframe>& window, const FusedEdges& edges,
                                 std::size_t p) const {
    const auto [first, end] = edges.observationsOf(p);
    double sum = 0;
    for (std::size_t k = first; k < end; ++k) {
        const WindowKeyframe& view = at(window, edges.observations[k].slot);
        const auto i = static_cast<std::size_t>(edges.observations[k].point);
        const Eigen::Vector3d q =
            view.T_world_camera.linear().transpose() * (edges.points[p] - view.T_world_camera.translation());
        double residual = kFarOff;
        if (q.z() > kNearestInView) {
            const OrganizedEdges& image = view.keyframe->image;
            const Eigen::Vector2d normal(image.normal_x[i], image.normal_y[i]), seen(image.x[i], image.y[i]);
            residual = normal.dot(camera_.project(q) - seen);  // Eq. (7)
        }
        sum += residual * residual;
    }
    return std::sqrt(sum / static_cast<double>(end - first - 1));
}

PseudoEdgeJudge::View PseudoEdgeJudge::viewOf(const Pose& T_world_camera) const {
    constexpr double kMargin = 5;  // px
    View view;
    view.T_camera_world = T_world_camera.inverse();
    const double left = kMargin - camera_.cx, top = kMargin - camera_.cy,
                 right = camera_.width - 1 - kMargin - camera_.cx,
                 bottom = camera_.height - 1 - kMargin - camera_.cy;
    Eigen::Matrix<double, 5, 3> in_camera;
    in_camera << camera_.fx, 0, -left, -camera_.fx, 0, right, 0, camera_.fy, -top, 0, -camera_.fy, bottom, 0,
        0, 1;
    in_camera.rowwise().normalize();
    view.normals = in_camera * view.T_camera_world.linear();
    view.offsets = in_camera * view.T_camera_world.translation();
    view.offsets[4] -= sensor_.min_depth;
    return view;
}

void PseudoEdgeJudge::project(const View& view, const Eigen::Vector3d& point, Eigen::Vector2f& pixel) const {
    const Eigen::Vector3d q = view.T_camera_world * point;
    if (q.z() > sensor_.min_depth) pixel = camera_.project(q).cast<float>();
}

void PseudoEdgeJudge::findPoints(const FusedEdges& edges, std::size_t edge) {
    const auto [first, end] = edges.pointsOf(edge);
    const std::size_t stride = strideOf(end - first);
    inside_.assign(views_.size(), 0);
    observed_.assign(views_.size(), 0);
    const Eigen::Vector3d centre = edges.points[first + (end - first) / 2];
    double squared_radius = 0;
    std::uint32_t bit = 1;
    for (std::size_t p = first; p < end; p += stride, bit <<= 1) {
        squared_radius = std::max(squared_radius, (edges.points[p] - centre).squaredNorm());
        const IndexRange range = edges.observationsOf(p);
        for (std::size_t k = range.first; k < range.end; ++k)
            at(observed_, edges.observations[k].slot) |= bit;
    }
    const double radius = std::sqrt(squared_radius);
    for (std::size_t slot = 0; slot < views_.size(); ++slot) {
        const View& view = views_[slot];
        const double nearest = view.inside(centre);
        if (nearest > radius)
            inside_[slot] = bit - 1;  // all of them
        else if (nearest > -radius) {
            std::uint32_t own = 1;
            for (std::size_t p = first; p < end; p += stride, own <<= 1)
                if (view.inside(edges.points[p]) > 0) inside_[slot] |= own;
        }
        observed_[slot] &= inside_[slot];
    }
}

double PseudoEdgeJudge::weightOf(std::size_t slot) const {
    double nearest = -1;  // cosine
    for (std::size_t other = 0; other < views_.size(); ++other)
        if (other != slot && observed_[other] != 0)
            nearest = std::max(nearest, rays_[slot].dot(rays_[other]));
    return std::exp((nearest - 1) / (kSideways * kSideways));  // 2 - 2 cos(x) is about x^2
}

PseudoEdgeJudge::Looks PseudoEdgeJudge::looksAt(const std::vector<WindowKeyframe>& window,
                                                const FusedEdges& edges, std::size_t edge) {
    findPoints(edges, edge);
    const auto [first, end] = edges.pointsOf(edge);
    const std::size_t stride = strideOf(end - first), count = (end - first + stride - 1) / stride;
    rays_.clear();
    for (const WindowKeyframe& view : window)
        rays_.push_back((view.T_world_camera.translation() - edges.points[(first + end) / 2]).normalized());
    Looks looks;
    missing_.clear();
    bool is_first = true;
    for (std::size_t slot = 0; slot < window.size(); ++slot) {
        const int inside = __builtin_popcount(inside_[slot]), observed = __builtin_popcount(observed_[slot]);
        if (inside < kLookShare * static_cast<double>(count)) continue;
        // The keyframe in which an edge was found first proves nothing
        if (observed > 0 && std::exchange(is_first, false)) continue;
        if (observed >= kSeeShare * inside)
            looks.seen += weightOf(slot);
        else
            missing_.push_back(slot);
    }
    looks.looked = looks.seen + static_cast<double>(missing_.size());
    return looks;
}

bool PseudoEdgeJudge::isInImage(const View& view, const OrganizedEdges& image, const FusedEdges& edges,
                                std::size_t edge) const {
    const auto [first, end] = edges.pointsOf(edge);
    int inside = 0, found = 0;
    const std::size_t stride = strideOf(end - first);
    const double enough = kImageShare * static_cast<double>((end - first + stride - 1) / stride);
    const auto radius = std::max(1.0F, static_cast<float>(camera_.pixelScale())) * kLookRadius;
    Eigen::Vector2f pixel, before, after;
    for (std::size_t p = first; p < end && found < enough && inside - found <= enough; p += stride) {
        if (!(view.inside(edges.points[p]) > 0)) continue;
        ++inside;
        project(view, edges.points[p], pixel);
        before = after = pixel;  // where a neighbour is behind the camera
        project(view, edges.points[std::max(first + kChordReach, p) - kChordReach], before);
        project(view, edges.points[std::min(end - 1, p + kChordReach)], after);
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
    questions_.clear();
    views_.clear();
    for (const WindowKeyframe& view : window) views_.push_back(viewOf(view.T_world_camera));
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
        const double found = foundShare(window, edges, edge);
        Looks looks = looksAt(window, edges, edge);
        if (!isVanishing(looks, found)) continue;  // whatever the looks that missed it weigh
        looks.looked = looks.seen;
        const std::size_t asked = questions_.size();
        for (const std::size_t slot : missing_) {
            questions_.push_back({slot, suspects_.size(), weightOf(slot)});
            looks.looked += questions_.back().weight;
        }
        if (isVanishing(looks, found))
            suspects_.push_back({edge, looks, found, looks.looked - looks.seen});
        else
            questions_.resize(asked);
    }
    askImages(window, edges);
    for (const Suspect& suspect : suspects_) {
        if (isVanishing(suspect.looks, suspect.found)) edges.verdicts[suspect.edge] = EdgeVerdict::kVanishing;
    }
}

/// Associations miss edges that are in pieces: before an edge is called vanishing, the images themselves.
void PseudoEdgeJudge::askImages(const std::vector<WindowKeyframe>& window, const FusedEdges& edges) {
    std::stable_sort(questions_.begin(), questions_.end(),
                     [](const Question& a, const Question& b) { return a.slot < b.slot; });
    std::size_t built = window.size();  // slot of the image in the grid
    for (const auto& [slot, about, weight] : questions_) {
        Suspect& suspect = suspects_[about];
        const Looks at_best{suspect.looks.looked, suspect.looks.seen + suspect.open};
        suspect.open -= weight;
        if (!isVanishing(suspect.looks, suspect.found) || isVanishing(at_best, suspect.found)) continue;
        const OrganizedEdges& image = window[slot].keyframe->image;
        if (built != slot) grid_.build(image, camera_.width, camera_.height);
        built = slot;
        if (isInImage(views_[slot], image, edges, suspect.edge)) suspect.looks.seen += weight;
    }
}

bool PseudoEdgeJudge::isVanishing(const Looks& looks, double found) const {
    const double frames = found < 0 ? 0 : kFrameEvidence;
    const double evidence = looks.looked + frames;
    if (evidence < options_.min_looks - 1) return false;
    return looks.seen + frames * found < options_.min_seen * evidence;
}

double PseudoEdgeJudge::foundShare(const std::vector<WindowKeyframe>& window, const FusedEdges& edges,
                                   std::size_t edge) const {
    double sum = 0;
    int count = 0;
    const auto [first, end] = edges.observationsOfEdge(edge);
    for (std::size_t k = first; k < end; ++k) {
        const MapKeyframe& keyframe = *at(window, edges.observations[k].slot).keyframe;
        const float found = at(keyframe.found, at(keyframe.image.edge_of, edges.observations[k].point));
        if (found < 0) continue;
        sum += static_cast<double>(found);
        ++count;
    }
    return count > 0 ? sum / count : -1;
}

}  // namespace roevo
