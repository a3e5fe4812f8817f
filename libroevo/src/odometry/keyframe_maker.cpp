#include "keyframe_maker.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "roevo/tracking/se3.h"

namespace roevo {
namespace {

/// One value for each of an image's edge points from those of the points that the map keeps, every n-th
/// (`source`): points between take the nearest one's. All 1 where the map has none.
std::vector<float> ofAllPoints(const OrganizedEdges& image, const std::vector<std::int32_t>& source,
                               const std::vector<float>& values) {
    std::vector<float> all(image.size(), 1);
    if (values.empty()) return all;
    for (std::size_t k = 0; k < source.size(); ++k) {
        const auto edgeOf = [&](std::size_t other) {
            return image.edge_of[static_cast<std::size_t>(source[other])];
        };
        const std::int32_t edge = edgeOf(k);
        const bool has_before = k > 0 && edgeOf(k - 1) == edge;
        const bool has_after = k + 1 < source.size() && edgeOf(k + 1) == edge;
        const std::int32_t from =
            has_before ? (source[k - 1] + source[k] + 1) / 2 : image.begin[static_cast<std::size_t>(edge)];
        const std::int32_t to =
            has_after ? (source[k] + source[k + 1] + 1) / 2 : image.begin[static_cast<std::size_t>(edge) + 1];
        for (std::int32_t i = from; i < to; ++i) all[static_cast<std::size_t>(i)] = values[k];
    }
    return all;
}

/// To where the edge points that they were sampled from are now.
void movePhotometricPoints(Keyframe& keyframe) {
    PhotometricPoints& points = keyframe.photometric;
    for (std::size_t k = 0; k < points.source.size(); ++k) {
        const auto i = static_cast<std::size_t>(points.source[k]);
        points.x[k] = keyframe.edges.x[i];
        points.y[k] = keyframe.edges.y[i];
        points.z[k] = keyframe.edges.z[i];
    }
}

}  // namespace

void keepForKeyframe(const RgbdFrame& frame, const RowMotion& still, FrameData& data) {
    data.images.timestamp = frame.timestamp;
    frame.grey.copyTo(data.images.grey);
    frame.depth.copyTo(data.images.depth);
    frame.colour.copyTo(data.images.colour);
    data.row_motion = still;
    data.covariance.setZero();
    data.may_be_keyframe = false;
}

bool keyframeIsDue(const Keyframe& keyframe, const FrameResult& result, const KeyframeOptions& options) {
    const Pose T_keyframe_current = keyframe.T_world_camera.inverse() * result.T_world_camera;
    return result.matched_ratio < options.min_matched_ratio ||
           rotationAngle(T_keyframe_current) / kDegree > options.max_rotation_deg ||
           T_keyframe_current.translation().norm() > options.max_translation * keyframe.median_depth;
}

std::string makeKeyframe(const FrameData& data, int id, const PinholeCamera& camera,
                         const OdometryOptions& options, const OdometryStages& stages, Keyframe& keyframe) {
    if (data.images.depth.empty()) return "no depth image";
    keyframe.edges =
        liftEdges(data.edges, data.images.depth, camera, data.row_motion, options.edges, options.sensor);
    const auto needed = static_cast<std::size_t>(options.fine.min_inliers);
    if (keyframe.edges.size() < needed) {
        return "only " + std::to_string(keyframe.edges.size()) + " edge points with depth, " +
               std::to_string(needed) + " needed";
    }
    keyframe.id = id;
    keyframe.timestamp = data.images.timestamp;
    keyframe.T_world_camera = data.T_world_camera;
    keyframe.covariance = data.covariance;
    keyframe.row_motion = data.row_motion;
    keyframe.photometric =
        stages.photometric_points
            ? stages.photometric_points({keyframe.edges, data.pyramid, data.images.depth, data.row_motion})
            : samplePhotometricPoints(keyframe.edges, data.pyramid, options.coarse.max_points);
    keyframe.median_depth = static_cast<double>(keyframe.edges.medianDepth());
    return {};
}

std::vector<float> foundShares(const Keyframe& keyframe) {
    constexpr int kMinTrials = 10;  // of points and frames together
    const OrganizedEdges& image = keyframe.edges.image;
    std::vector<float> shares(static_cast<std::size_t>(image.numEdges()), -1);
    if (keyframe.trials.empty()) return shares;
    for (std::size_t e = 0; e < shares.size(); ++e) {
        int hits = 0, trials = 0;
        for (auto i = static_cast<std::size_t>(image.begin[e]);
             i < static_cast<std::size_t>(image.begin[e + 1]); ++i) {
            hits += keyframe.hits[i];
            trials += keyframe.trials[i];
        }
        if (trials >= kMinTrials) shares[e] = static_cast<float>(hits) / static_cast<float>(trials);
    }
    return shares;
}

RowMotion firstMotion(const Keyframe& keyframe, const Pose& T_next_keyframe, double next_timestamp) {
    constexpr double kLongest = 0.15;  // s
    const double dt = next_timestamp - keyframe.timestamp;
    RowMotion rows = keyframe.row_motion;
    if (!(dt > 0 && dt <= kLongest)) return rows;
    const Pose T_keyframe_next = T_next_keyframe.inverse();
    const Eigen::AngleAxisd turn(T_keyframe_next.linear());
    rows.turn = turn.angle() / dt * turn.axis();
    rows.velocity = T_keyframe_next.translation() / dt;
    return rows;
}

void setRowMotion(Keyframe& keyframe, const RowMotion& rows) {
    if (rows == keyframe.row_motion) return;
    EdgePoints3D& edges = keyframe.edges;
    exchangeMotion(keyframe.row_motion, rows, edges.image.y, edges.size(), edges.x, edges.y, edges.z);
    keyframe.row_motion = rows;
    movePhotometricPoints(keyframe);
}

void takeFromMap(Keyframe& keyframe, const MapUpdate& update) {
    EdgePoints3D& edges = keyframe.edges;
    const std::vector<float> ratio = ofAllPoints(edges.image, update.source, update.depth_ratio);
    const std::vector<float> weight = ofAllPoints(edges.image, update.source, update.weight);
    for (std::size_t i = 0; i < edges.size(); ++i) {
        edges.x[i] *= ratio[i];
        edges.y[i] *= ratio[i];
        edges.z[i] *= ratio[i];
        edges.weight[i] *= weight[i];
    }
    movePhotometricPoints(keyframe);
    PhotometricPoints& points = keyframe.photometric;
    for (std::size_t k = 0; k < points.source.size(); ++k)
        points.weight[k] *= weight[static_cast<std::size_t>(points.source[k])];
}

EdgeMap mapEdgesOf(const Keyframe& kf, const RgbdFrame& frame, const PinholeCamera& camera) {
    EdgeMap edges;
    const bool coloured = frame.colour.type() == CV_8UC3 && frame.colour.size() == frame.grey.size();
    for (int e = 0; e < kf.edges.image.numEdges(); ++e) {
        MapEdge edge;
        edge.keyframe_id = kf.id;
        const auto first = static_cast<std::size_t>(kf.edges.image.begin[static_cast<std::size_t>(e)]);
        const auto end = static_cast<std::size_t>(kf.edges.image.begin[static_cast<std::size_t>(e) + 1]);
        for (std::size_t i = first; i < end; ++i) {
            const Eigen::Vector3d p =
                kf.T_world_camera * Eigen::Vector3d(kf.edges.x[i], kf.edges.y[i], kf.edges.z[i]);
            edge.points.push_back(p.cast<float>());
            Eigen::Vector2d pixel(kf.edges.image.x[i], kf.edges.image.y[i]);
            if (camera.isDistorted()) pixel = camera.distortPixel(pixel);
            const int u = std::clamp(static_cast<int>(std::lround(pixel.x())), 0, camera.width - 1);
            const int v = std::clamp(static_cast<int>(std::lround(pixel.y())), 0, camera.height - 1);
            if (coloured) {
                const auto& bgr = frame.colour.at<cv::Vec3b>(v, u);
                edge.colours.push_back({bgr[2], bgr[1], bgr[0]});
            } else {
                const std::uint8_t level = frame.grey.at<std::uint8_t>(v, u);
                edge.colours.push_back({level, level, level});
            }
        }
        edges.push_back(std::move(edge));
    }
    return edges;
}

std::vector<Rgb> coloursOf(const EdgeMap& edges) {
    std::vector<Rgb> colours;
    for (const MapEdge& edge : edges) colours.insert(colours.end(), edge.colours.begin(), edge.colours.end());
    return colours;
}

}  // namespace roevo
