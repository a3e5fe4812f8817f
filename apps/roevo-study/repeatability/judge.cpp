#include "judge.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "edges/canny.h"

namespace roevo {
namespace {

constexpr double kDepthAgreement = 0.05;    // relative
constexpr int kPatchRadius = 2;             // px, around the place where depth is looked up
constexpr double kHalf = 0.5;               // share that decides
constexpr std::size_t kFewestVisible = 20;  // fewer make no share

bool surfaceSeen(const cv::Mat& depth, const Eigen::Vector2d& pixel, double z) {
    const int cu = static_cast<int>(std::lround(pixel.x())), cv = static_cast<int>(std::lround(pixel.y()));
    for (int y = std::max(0, cv - kPatchRadius); y <= std::min(depth.rows - 1, cv + kPatchRadius); ++y) {
        const float* row = depth.ptr<float>(y);
        for (int x = std::max(0, cu - kPatchRadius); x <= std::min(depth.cols - 1, cu + kPatchRadius); ++x)
            if (row[x] > 0 && std::abs(static_cast<double>(row[x]) - z) < kDepthAgreement * z) return true;
    }
    return false;
}

// Where the visible part of a reference edge truly runs.
class TrueCurve {
  public:
    TrueCurve(const OrganizedEdges& edges, const TrueView& view, std::size_t edge) : view_(view) {
        const IndexRange own = edges.pointsOf(edge);
        for (std::size_t i = own.first; i < own.end; ++i) {
            if (view.visible[i] == 0) continue;
            points_.push_back(i);
            const auto [before, end] = own.around(i, kTangentSpan);
            const float tx = view.u[end - 1] - view.u[before], ty = view.v[end - 1] - view.v[before];
            const float length = std::hypot(tx, ty);
            normals_.push_back(length > 0 ? cv::Point2f(-ty / length, tx / length) : cv::Point2f(0, 0));
            left_ = std::min(left_, view.u[i]);
            right_ = std::max(right_, view.u[i]);
            top_ = std::min(top_, view.v[i]);
            bottom_ = std::max(bottom_, view.v[i]);
        }
    }
    bool empty() const { return points_.empty(); }
    const std::vector<std::size_t>& points() const { return points_; }

    /// px from the tangent at the nearest point of the curve; none beyond kNeighbourhood.
    std::optional<float> normalDistance(float x, float y) const {
        if (x < left_ - kNeighbourhood || x > right_ + kNeighbourhood || y < top_ - kNeighbourhood ||
            y > bottom_ + kNeighbourhood)
            return std::nullopt;
        float best = kNeighbourhood * kNeighbourhood;
        std::optional<float> distance;
        for (std::size_t k = 0; k < points_.size(); ++k) {
            const float dx = x - view_.u[points_[k]], dy = y - view_.v[points_[k]];
            if (dx * dx + dy * dy >= best) continue;
            best = dx * dx + dy * dy;
            distance = std::abs(dx * normals_[k].x + dy * normals_[k].y);
        }
        return distance;
    }

  private:
    static constexpr int kTangentSpan = 4;  // points before and after

    const TrueView& view_;
    std::vector<std::size_t> points_;
    std::vector<cv::Point2f> normals_;
    float left_ = std::numeric_limits<float>::max(), right_ = -left_, top_ = left_, bottom_ = -left_;  // px
};

}  // namespace

TrueView trueView(const std::vector<Eigen::Vector3d>& points, const Pose& T_frame_reference,
                  const FeatureFrame& frame, const PinholeCamera& camera) {
    constexpr double kNearest = 0.05;  // m
    const double margin = EdgeMask::kBorder, right = camera.width - 1 - margin,
                 bottom = camera.height - 1 - margin;
    const bool distorted = camera.isDistorted();
    TrueView view;
    view.u.assign(points.size(), 0);
    view.v.assign(points.size(), 0);
    view.visible.assign(points.size(), 0);
    for (std::size_t i = 0; i < points.size(); ++i) {
        const Eigen::Vector3d point = T_frame_reference * points[i];
        if (!(point.z() > kNearest)) continue;
        Eigen::Vector2d pixel = camera.project(point);
        view.u[i] = static_cast<float>(pixel.x());
        view.v[i] = static_cast<float>(pixel.y());
        if (!(pixel.x() >= margin && pixel.y() >= margin && pixel.x() <= right && pixel.y() <= bottom))
            continue;
        if (distorted) pixel = camera.distortPixel(pixel);
        if (!surfaceSeen(frame.depth, pixel, point.z())) continue;
        view.visible[i] = 1;
        ++view.num_visible;
    }
    return view;
}

std::optional<double> Verdict::share() const {
    if (visible < kFewestVisible) return std::nullopt;
    return static_cast<double>(correct) / static_cast<double>(visible);
}

std::optional<double> Verdict::precision() const {
    if (associated == 0) return std::nullopt;
    return static_cast<double>(right) / static_cast<double>(associated);
}

Verdict judgePoints(const TrueView& view, const std::vector<std::optional<cv::Point2f>>& found) {
    Verdict verdict;
    verdict.visible = view.num_visible;
    for (std::size_t i = 0; i < found.size(); ++i) {
        if (view.visible[i] == 0 || !found[i]) continue;
        ++verdict.associated;
        verdict.right += std::hypot(found[i]->x - view.u[i], found[i]->y - view.v[i]) <= kTolerance;
    }
    verdict.correct = verdict.right;
    return verdict;
}

Verdict judgeEdges(const OrganizedEdges& reference, const TrueView& view, const EdgeLinks& links,
                   const OrganizedEdges& current, const EdgeGrid& grid) {
    Verdict verdict;
    verdict.visible = view.num_visible;
    for (std::size_t e = 0; e < links.size(); ++e) {
        if (links[e].empty()) continue;
        const TrueCurve curve(reference, view, e);
        if (curve.empty()) continue;
        std::size_t near = 0, right = 0;
        for (const int partner : links[e]) {
            const auto [first, end] = current.pointsOf(partner);
            for (std::size_t i = first; i < end; ++i) {
                const auto distance = curve.normalDistance(current.x[i], current.y[i]);
                if (!distance) continue;
                ++near;
                right += *distance <= kTolerance;
            }
        }
        verdict.associated += near;
        verdict.right += right;
        if (near == 0 || static_cast<double>(right) < kHalf * static_cast<double>(near)) continue;
        for (const std::size_t i : curve.points())
            verdict.correct += grid.any(view.u[i], view.v[i], kTolerance, [&](std::size_t point) {
                return std::binary_search(links[e].begin(), links[e].end(), current.edge_of[point]);
            });
    }
    return verdict;
}

}  // namespace roevo
