#include "judge.h"

#include <algorithm>
#include <cmath>

#include "roevo/edges/canny.h"

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
    std::vector<char> covered;
    for (std::size_t e = 0; e < links.size(); ++e) {
        const auto first = static_cast<std::size_t>(reference.begin[e]);
        const auto end = static_cast<std::size_t>(reference.begin[e + 1]);
        const auto visible = static_cast<std::size_t>(std::count(
            view.visible.begin() + reference.begin[e], view.visible.begin() + reference.begin[e + 1], 1));
        if (visible == 0) continue;
        covered.assign(end - first, 0);
        std::size_t length = 0, right_length = 0;  // of the partners, points
        for (const int partner : links[e]) {
            const auto other = static_cast<std::size_t>(partner);
            const auto size = static_cast<std::size_t>(current.begin[other + 1] - current.begin[other]);
            std::vector<std::size_t> near;
            for (std::size_t i = first; i < end; ++i) {
                if (view.visible[i] == 0) continue;
                if (grid.nearest(view.u[i], view.v[i], kTolerance,
                                 [&](std::size_t point) { return current.edge_of[point] == partner; }) >= 0)
                    near.push_back(i);
            }
            ++verdict.associated;
            length += size;
            if (static_cast<double>(near.size()) < kHalf * static_cast<double>(std::min(visible, size)))
                continue;
            ++verdict.right;
            right_length += size;
            for (const std::size_t i : near) covered[i - first] = 1;
        }
        if (static_cast<double>(right_length) >= kHalf * static_cast<double>(length))
            verdict.correct += static_cast<std::size_t>(std::count(covered.begin(), covered.end(), 1));
    }
    return verdict;
}

}  // namespace roevo
