#include "web_view.h"

#include <algorithm>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <utility>

#include "evaluation/evaluate.h"
#include "packed_cloud.h"
#include "programs/text.h"
#include "roevo_mrpt/pose_conversions.h"
#include "web_page.h"

namespace roevo {
namespace {

using Json = nlohmann::ordered_json;

constexpr double kMegabyte = 1e6;
constexpr char kLive[] = "live";

std::vector<float> positionsOf(const std::vector<StampedPose>& poses, const Pose& T_scene_world) {
    std::vector<float> values;
    for (const StampedPose& pose : poses) {
        const Eigen::Vector3d p = T_scene_world * pose.T_world_camera.translation();
        for (int axis = 0; axis < 3; ++axis) values.push_back(static_cast<float>(p[axis]));
    }
    return values;
}

std::vector<float> rotationsOf(const std::vector<StampedPose>& poses, const Pose& T_scene_world) {
    std::vector<float> values;
    for (const StampedPose& pose : poses) {
        const Eigen::Quaterniond q = (T_scene_world * pose.T_world_camera).rotation();
        for (const double value : {q.x(), q.y(), q.z(), q.w()}) values.push_back(static_cast<float>(value));
    }
    return values;
}

Json posesJson(const std::vector<StampedPose>& poses, const Pose& T_scene_world) {
    return {{"count", poses.size()},
            {"positions", packedFloats(positionsOf(poses, T_scene_world))},
            {"rotations", packedFloats(rotationsOf(poses, T_scene_world))}};
}

Json pathJson(const ViewPath& path, const std::string& role, const Pose& T_scene_world, double start) {
    Json json = posesJson(path.poses, T_scene_world);
    json["name"] = cleanText(path.name);
    json["role"] = role;
    std::vector<float> times;
    for (const StampedPose& pose : path.poses) times.push_back(static_cast<float>(pose.timestamp - start));
    json["times"] = packedFloats(times);
    json["errors"] = path.errors.empty() ? Json() : Json(packedFloats(path.errors));
    json["ate"] = path.ate ? Json(*path.ate) : Json();
    return json;
}

Json pathsJson(const ResultFolder& result, const WebViewSettings& settings, const Pose& T_scene_world) {
    std::vector<NamedPath> paths{{settings.name, result.trajectory}};
    if (!result.live.empty()) paths.push_back({kLive, result.live});
    const std::size_t foreign = paths.size();
    paths.insert(paths.end(), settings.others.begin(), settings.others.end());
    const std::vector<ViewPath> views = alignPaths(paths, foreign, settings.truth);
    Json json = Json::array();
    for (std::size_t i = 0; i < views.size(); ++i) {
        const char* role = i == 0 ? "final" : i < foreign ? "live" : i < paths.size() ? "other" : "truth";
        json.push_back(pathJson(views[i], role, T_scene_world, result.trajectory.front().timestamp));
    }
    return json;
}

// Directions to the corners of the image, around it, at depth 1.
Json cornersJson(const PinholeCamera& camera) {
    const double right = camera.width - 0.5, bottom = camera.height - 0.5;
    Json corners = Json::array();
    for (const auto& [u, v] : {std::pair(-0.5, -0.5), {right, -0.5}, {right, bottom}, {-0.5, bottom}}) {
        const Eigen::Vector3d ray = camera.backProject(u, v, 1);
        corners.push_back({ray.x(), ray.y(), ray.z()});
    }
    return corners;
}

// Leaves out as many points as it takes for a layer to have its room. @param room  bytes
Cloud fitted(const Cloud& cloud, double room, const char* name, std::vector<std::string>& notes) {
    const auto limit = static_cast<std::size_t>(std::max(room, 0.) / kBytesPerPoint);
    if (cloud.size() <= limit) return cloud;
    Cloud kept = cloud;
    // The ends of lines stay, so that a larger step may be needed than the ratio says
    for (std::size_t k = cloud.size() / (limit + 1) + 1; kept.size() > limit && k <= cloud.size();
         k += (k + 3) / 4)
        kept = thinned(cloud, k);
    if (kept.size() > limit) kept = {};
    notes.push_back(std::to_string(cloud.size() - kept.size()) + " of " + std::to_string(cloud.size()) +
                    " points of the " + name + " are left out to keep the size");
    return kept;
}

Json layerJson(const char* id, const char* title, bool shown, const Cloud& cloud) {
    Json json = packed(cloud);
    json["id"] = id;
    json["title"] = title;
    json["lines"] = cloud.lines;
    json["shown"] = shown;
    return json;
}

Json factsJson(const ResultFolder& result) {
    const double duration = result.trajectory.back().timestamp - result.trajectory.front().timestamp;
    Json facts = {
        counted(result.trajectory.size(), "pose"), shownNumber(duration, 1) + " s",
        "path " + shownNumber(result.path_length.value_or(pathLength(result.trajectory)), 2) + " m"};
    if (!result.keyframes.empty()) facts.push_back(counted(result.keyframes.size(), "keyframe"));
    if (!result.mode.empty()) facts.push_back("mode " + result.mode);
    return facts;
}

// For a <script> element: nothing in it looks like the end of one.
std::string scriptText(const Json& json) {
    return replaceAll(json.dump(-1, ' ', false, Json::error_handler_t::replace), "<", "\\u003c");
}

}  // namespace

WebView makeWebView(const ResultFolder& result, const WebViewSettings& settings) {
    const Pose T_scene_world = sensorFromOptical();
    WebView view;
    Json json = {{"title", cleanText(result.name)},
                 {"facts", factsJson(result)},
                 {"paths", pathsJson(result, settings, T_scene_world)},
                 {"keyframes", posesJson(result.keyframes, T_scene_world)},
                 {"corners", result.camera ? cornersJson(*result.camera) : Json()}};

    double room =
        settings.max_size_mb * kMegabyte - static_cast<double>(webPageSize() + json.dump().size() + 4096);
    if (room < 0)
        throw std::runtime_error("the page without any map would be larger than --max-size " +
                                 plainNumber(settings.max_size_mb) + " MB");
    const Cloud edges = fitted(lineCloud(result.edges, false, T_scene_world), room, "edges", view.notes);
    room -= kBytesPerPoint * static_cast<double>(edges.size());
    const Cloud pseudo =
        fitted(lineCloud(result.edges, true, T_scene_world), room, "pseudo-edges", view.notes);
    room -= kBytesPerPoint * static_cast<double>(pseudo.size());
    const Cloud surface = fitted(pointCloud(result.surface, T_scene_world), room, "surface", view.notes);
    json["layers"] = {layerJson("edges", "edges", true, edges),
                      layerJson("surface", "surface", false, surface),
                      layerJson("pseudo-edges", "pseudo-edges", false, pseudo)};
    view.edge_points = edges.size() + pseudo.size();
    view.surface_points = surface.size();
    json["notes"] = view.notes;
    view.html = webPage(htmlText(result.name), scriptText(json));
    return view;
}

}  // namespace roevo
