#include "keyframe_maker.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <sstream>

#include "mapping/semi_dense.h"
#include "nearest.h"
#include "tracking/robust.h"
#include "tracking/se3.h"

namespace roevo {
namespace {

/// Whether the depths as a whole are of another unit, in words to go on with; empty: no.
std::string wrongUnit(const cv::Mat& depth, const SensorOptions& sensor) {
    constexpr double kFarOff = 10;  // times
    std::vector<float> known;
    for (int v = 0; v < depth.rows; v += 4)
        for (int u = 0; u < depth.cols; u += 4)
            if (const float z = depth.at<float>(v, u); std::isfinite(z) && z > 0) known.push_back(z);
    if (known.empty()) return "";
    const double median = medianOf(known);
    if (median >= sensor.min_depth / kFarOff && median <= sensor.depth_limit * kFarOff) return "";
    std::ostringstream text;
    text << "; its depths are about " << median << " m: are they in metres?";
    return text.str();
}

}  // namespace

double changeOfView(double median_depth, const Pose& T_keyframe_camera, const KeyframeOptions& options) {
    return std::max(rotationAngle(T_keyframe_camera) / kDegree / options.max_rotation_deg,
                    T_keyframe_camera.translation().norm() / options.max_translation / median_depth);
}

bool keyframeIsDue(const Keyframe& reference, const Tracking& tracking, const KeyframeOptions& options) {
    return tracking.matchedRatio() < options.min_overlap ||
           changeOfView(reference.median_depth, tracking.pose.T_keyframe_camera, options) > 1;
}

Fault makeKeyframe(const Frame& frame, const RowMotion& rows, int needed, const PinholeCamera& camera,
                   const OdometryOptions& options, const Tracker& tracker, Keyframe& keyframe) {
    if (frame.images.depth.empty()) return {"no depth image"};
    keyframe.edges = liftEdges(frame.edges, frame.images.depth, camera, rows, options.edges, options.sensor);
    const int found = static_cast<int>(keyframe.edges.size());
    if (found < needed)
        return {"only " + std::to_string(found) + " edge points with depth, " + std::to_string(needed) +
                " needed" + wrongUnit(frame.images.depth, options.sensor)};
    keyframe.timestamp = frame.timestamp();
    keyframe.row_motion = rows;
    keyframe.photometric = tracker.choosePoints(keyframe.edges, frame, rows);
    keyframe.median_depth = keyframe.edges.medianDepth();
    return {};
}

void numberEdges(Keyframe& keyframe, const Keyframe* before, const EdgeMatches& matches, std::int32_t& next) {
    const EdgePoints3D& edges = keyframe.edges;
    // Of each of the frame's points: the reference's edge that it was matched with
    std::vector<std::int32_t> matched;
    for (std::size_t k = 0; before != nullptr && k < matches.size(); ++k) {
        const auto point = static_cast<std::size_t>(matches.current[k]);
        if (point >= matched.size()) matched.resize(point + 1, -1);
        matched[point] = at(before->edges.image.edge_of, matches.reference[k]);
    }
    std::map<std::int32_t, int> votes;
    keyframe.clusters.clear();
    for (int e = 0; e < edges.image.numEdges(); ++e) {
        votes.clear();
        const IndexRange own = edges.image.pointsOf(e);
        for (std::size_t i = own.first; i < own.end; ++i) {
            const auto source = static_cast<std::size_t>(edges.source[i]);
            if (source < matched.size() && matched[source] >= 0) ++votes[matched[source]];
        }
        const auto most = std::max_element(votes.begin(), votes.end(),
                                           [](const auto& a, const auto& b) { return a.second < b.second; });
        keyframe.clusters.push_back(most == votes.end() ? next++ : at(before->clusters, most->first));
    }
}

std::vector<Rgb> coloursOf(const OrganizedEdges& edges, const RgbdFrame& frame, const PinholeCamera& camera) {
    std::vector<Rgb> colours;
    const auto nearest = [](double coordinate, int size) {
        return std::clamp(nearestInteger(coordinate), 0, size - 1);
    };
    for (std::size_t i = 0; i < edges.size(); ++i) {
        const Eigen::Vector2d pixel = camera.distortPixel({edges.x[i], edges.y[i]});
        colours.push_back(
            colourAt(frame, nearest(pixel.x(), camera.width), nearest(pixel.y(), camera.height)));
    }
    return colours;
}

}  // namespace roevo
