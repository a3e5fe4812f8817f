#include "methods.h"

#include <algorithm>
#include <limits>
#include <map>
#include <opencv2/imgproc.hpp>
#include <opencv2/video/tracking.hpp>

#include "edges/edge_depth.h"

namespace roevo {
namespace {

constexpr int kCorners = 500;
constexpr double kQuality = 0.01, kApart = 8;  // of the best corner's score; px

constexpr double kAnyDirection = 180;  // degrees between normals: no test

void sortUnique(std::vector<int>& values) {
    std::sort(values.begin(), values.end());
    values.erase(std::unique(values.begin(), values.end()), values.end());
}

}  // namespace

CornerTracks::CornerTracks(const FeatureFrame& reference, const PinholeCamera& camera,
                           const OdometryOptions& options) {
    std::vector<cv::Point2f> corners;
    cv::goodFeaturesToTrack(reference.grey, corners, kCorners, kQuality, kApart);
    const ForegroundDepth foreground(reference.depth, options.edges, options.sensor);
    for (const cv::Point2f& corner : corners) {
        Eigen::Vector2d pixel(corner.x, corner.y);
        if (camera.isDistorted()) pixel = camera.distortPixel(pixel);
        const float depth = foreground.at(static_cast<float>(pixel.x()), static_cast<float>(pixel.y()));
        if (!(depth > 0)) continue;
        points_.push_back(camera.backProject(corner.x, corner.y, depth));
        positions_.emplace_back(corner);
    }
}

void CornerTracks::advance(const FeatureFrame& previous, const FeatureFrame& current) {
    std::vector<cv::Point2f> from, to;
    std::vector<std::size_t> which;
    for (std::size_t i = 0; i < positions_.size(); ++i) {
        if (!positions_[i]) continue;
        which.push_back(i);
        from.push_back(*positions_[i]);
    }
    if (from.empty()) return;
    std::vector<unsigned char> found;
    std::vector<float> error;
    cv::calcOpticalFlowPyrLK(previous.grey, current.grey, from, to, found, error);  // 21 x 21 px, 4 levels
    const cv::Rect2f image(0, 0, static_cast<float>(current.grey.cols - 1),
                           static_cast<float>(current.grey.rows - 1));
    for (std::size_t k = 0; k < which.size(); ++k) {
        if (found[k] != 0 && image.contains(to[k]))
            positions_[which[k]] = to[k];
        else
            positions_[which[k]].reset();
    }
}

EdgeLinks associateEdges(const FeatureFrame& from, const FeatureFrame& current, EdgeRule rule,
                         const PinholeCamera& camera, const OdometryOptions& options) {
    const EdgePoints3D& edges = from.lifted;
    const Pose T_current_from = current.T_world_search.inverse() * from.T_world_search;
    ProjectedPoints3 projected;
    project(edges.points, T_current_from, camera.undistorted(), RowMotion(), projected);
    FineOptions fine = options.fine;
    if (rule == EdgeRule::kNearest) {
        fine.normal_angle_deg = kAnyDirection;
        fine.vote_ratio = 0;
        fine.min_votes = 1;
    }
    EdgeAssociator associator(camera, fine, options.edges.tangent_span);
    EdgeMatches matches;
    associator.associate(edges.image, projected, T_current_from, current.lifted.image, current.lifted_grid,
                         fine.final_radius, matches);
    EdgeLinks links(static_cast<std::size_t>(edges.image.numEdges()));
    for (std::size_t k = 0; k < matches.size(); ++k)
        links[static_cast<std::size_t>(edges.image.edge_of[static_cast<std::size_t>(matches.reference[k])])]
            .push_back(current.lifted.image.edge_of[static_cast<std::size_t>(matches.current[k])]);
    for (std::vector<int>& partners : links) sortUnique(partners);
    return links;
}

EdgeLinks chain(const EdgeLinks& first, const EdgeLinks& second) {
    EdgeLinks links(first.size());
    for (std::size_t e = 0; e < first.size(); ++e) {
        for (const int between : first[e]) {
            const auto& ends = second[static_cast<std::size_t>(between)];
            links[e].insert(links[e].end(), ends.begin(), ends.end());
        }
        sortUnique(links[e]);
    }
    return links;
}

DisjointSets::DisjointSets(const PinholeCamera& camera, const OdometryOptions& options)
    : camera_(camera.undistorted()), options_(options), graph_(camera_, options.fine) {}

void DisjointSets::insert(const FeatureFrame& frame, bool keyframe) {
    if (!last_stays_) {
        graph_.setLinks(keyframes_.back().id, {});
        keyframes_.pop_back();
    }
    last_stays_ = keyframe;
    Keyframe tracked;
    tracked.id = static_cast<int>(frame.number);
    tracked.timestamp = frame.timestamp;
    tracked.edges = frame.lifted;
    tracked.median_depth = static_cast<double>(frame.lifted.medianDepth());
    keyframes_.push_back(
        toMapKeyframe(tracked, std::vector<Rgb>(frame.lifted.size()), camera_, options_.mapping.max_points));
    keyframes_.back().T_world_camera = frame.T_world_search;
    std::vector<const MapKeyframe*> others;  // the newest first
    const auto window = static_cast<std::size_t>(options_.mapping.window);
    for (std::size_t i = keyframes_.size() - 1; i > 0 && others.size() + 1 < window; --i)
        others.push_back(&keyframes_[i - 1]);
    graph_.insert(keyframes_.back(), others, options_.fine.final_radius);
    std::vector<const MapKeyframe*> all;
    for (const MapKeyframe& member : keyframes_) all.push_back(&member);
    clusters_ = graph_.clusters(all);
}

EdgeLinks DisjointSets::links(std::size_t reference) const {
    const auto found = std::find_if(keyframes_.begin(), keyframes_.end(), [&](const MapKeyframe& keyframe) {
        return keyframe.id == static_cast<int>(reference);
    });
    if (found == keyframes_.end()) return {};
    std::map<int, std::vector<int>> of_cluster;
    const std::vector<int>& newest = clusters_.back();
    for (std::size_t e = 0; e < newest.size(); ++e) of_cluster[newest[e]].push_back(static_cast<int>(e));
    EdgeLinks links;
    for (const int cluster : clusters_[static_cast<std::size_t>(found - keyframes_.begin())]) {
        const auto members = of_cluster.find(cluster);
        links.push_back(members == of_cluster.end() ? std::vector<int>() : members->second);
    }
    return links;
}

void DisjointSets::forgetBefore(std::size_t number) {
    // The window is needed to relate new keyframes
    const auto window = static_cast<std::size_t>(options_.mapping.window);
    while (keyframes_.size() > window && keyframes_.front().id < static_cast<int>(number)) {
        graph_.setLinks(keyframes_.front().id, {});
        keyframes_.erase(keyframes_.begin());
    }
}

}  // namespace roevo
