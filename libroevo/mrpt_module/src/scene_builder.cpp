#include "roevo_mrpt/scene_builder.h"

#include <algorithm>
#include <cmath>

#include "edge_layers.h"
#include "gz_file.h"
#include "roevo_mrpt/scene_objects.h"
#include "tubes.h"
#include "whole_file.h"

namespace roevo {
namespace {

constexpr float kDash = 12, kDashWidth = 1.5f;  // of the ground truth, in radii of the trajectory
constexpr float kMostPieces = 4000;             // dashes and gaps

using mrpt::img::TColor;
using Points = std::vector<Eigen::Vector3f>;

TColor toMrpt(const Rgb& colour) {
    return TColor(colour[0], colour[1], colour[2]);
}

/// The box that holds the bulk of the points: a few stray ones must not make everything else small.
struct Extent {
    Eigen::Vector3f low = Eigen::Vector3f::Constant(-1), high = Eigen::Vector3f::Constant(1);
    float diagonal() const { return (high - low).norm(); }
};

Extent extentOf(const Points& points) {
    constexpr double kStray = 0.02;
    Extent extent;
    if (points.empty()) return extent;
    std::vector<float> values(points.size());
    for (int axis = 0; axis < 3; axis++) {
        std::transform(points.begin(), points.end(), values.begin(),
                       [&](const Eigen::Vector3f& p) { return p[axis]; });
        const auto quantile = [&](double share) {
            const auto nth =
                values.begin() + static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size() - 1));
            std::nth_element(values.begin(), nth, values.end());
            return *nth;
        };
        extent.low[axis] = quantile(kStray);
        extent.high[axis] = quantile(1 - kStray);
    }
    return extent;
}

Points positions(const std::vector<StampedPose>& poses, const Pose& T_scene_world) {
    Points points;
    for (const StampedPose& pose : poses)
        points.push_back((T_scene_world * pose.T_world_camera.translation()).cast<float>());
    return points;
}

/// Every second piece of a line, each `length` long, or longer where there would be too many.
std::vector<Points> dashes(const Points& line, float length) {
    float whole = 0;
    for (std::size_t i = 1; i < line.size(); ++i) whole += (line[i] - line[i - 1]).norm();
    length = std::max(length, whole / kMostPieces);
    std::vector<Points> pieces{{line.front()}};
    bool is_drawn = true;
    float rest = length;  // of the piece
    for (std::size_t i = 1; i < line.size(); ++i) {
        Eigen::Vector3f at = line[i - 1];
        for (float way = (line[i] - at).norm(); way > rest; way -= rest, rest = length) {
            at += rest / way * (line[i] - at);
            if (is_drawn) pieces.back().push_back(at);
            is_drawn = !is_drawn;
            if (is_drawn) pieces.push_back({at});
        }
        rest -= (line[i] - at).norm();
        if (is_drawn) pieces.back().push_back(line[i]);
    }
    return pieces;
}

compat::scene::CSetOfTriangles::Ptr path(const char* name, const std::vector<Points>& pieces, float radius,
                                         const TColor& colour) {
    auto tube = compat::scene::CSetOfTriangles::Create();
    tube->setName(name);
    for (const Points& points : pieces) appendTube(*tube, points, radius, colour);
    return tube;
}

/// A camera's pyramid of view as one stroke that passes along every edge.
Points frustum(const PinholeCamera& camera, const Pose& T_scene_camera, double depth) {
    const auto corner = [&](double u, double v) -> Eigen::Vector3f {
        return (T_scene_camera * camera.backProject(u, v, depth)).cast<float>();
    };
    const double right = camera.width - 0.5, bottom = camera.height - 0.5;
    const Eigen::Vector3f apex = T_scene_camera.translation().cast<float>();
    const Eigen::Vector3f a = corner(-0.5, -0.5), b = corner(right, -0.5), c = corner(right, bottom),
                          d = corner(-0.5, bottom);
    return {apex, a, b, apex, c, d, apex, d, a, b, c};
}

void insertKeyframes(compat::Scene& scene, const SceneContent& content, float size) {
    if (content.keyframes.empty() || !content.camera.check().empty()) return;
    // Made inside MRPT's library: in code of ours, GCC's sanitizer takes its virtual bases for misaligned
    // when it dies.
    const auto lines =
        std::dynamic_pointer_cast<compat::scene::CSetOfLines>(compat::scene::CSetOfLines::CreateObject());
    auto tubes = compat::scene::CSetOfTriangles::Create();
    lines->setName(SceneNames::kKeyframeLines);
    tubes->setName(SceneNames::kKeyframes);
    lines->setColor_u8(toMrpt(SceneColours::kKeyframes));
    for (const KeyframeInfo& keyframe : content.keyframes) {
        const Points stroke = frustum(content.camera, content.T_scene_world * keyframe.T_world_camera, size);
        appendTube(*tubes, stroke, 0.02f * size, toMrpt(SceneColours::kKeyframes));
        for (std::size_t i = 1; i < stroke.size(); i++)
            lines->appendLine(stroke[i - 1].x(), stroke[i - 1].y(), stroke[i - 1].z(), stroke[i].x(),
                              stroke[i].y(), stroke[i].z());
    }
    scene.insert(lines);
    scene.insert(tubes);
}

void insertGround(compat::Scene& scene, const Extent& extent) {
    const float margin = 0.1f * extent.diagonal();
    const float cell = extent.diagonal() > 12 ? 1.f : extent.diagonal() > 3 ? 0.5f : 0.1f;
    const auto down = [&](float x) { return std::floor((x - margin) / cell) * cell; };
    const auto up = [&](float x) { return std::ceil((x + margin) / cell) * cell; };
    auto grid =
        compat::scene::CGridPlaneXY::Create(down(extent.low.x()), up(extent.high.x()), down(extent.low.y()),
                                            up(extent.high.y()), extent.low.z(), cell);
    grid->setName(SceneNames::kGround);
    grid->setColor_u8(TColor(128, 128, 128, 110));
    scene.insert(grid);
}

void aimCamera(compat::Scene& scene, const Extent& extent) {
    const Eigen::Vector3f centre = 0.5f * (extent.low + extent.high);
    auto view = scene.getViewport();
    view->setCustomBackgroundColor({0.97f, 0.97f, 0.97f});
    auto& camera = view->getCamera();
    camera.setPointingAt(centre.x(), centre.y(), centre.z());
    camera.setZoomDistance(1.5f * extent.diagonal());
    camera.setAzimuthDegrees(-150);  // from behind the first camera, which looks along +x
    camera.setElevationDegrees(35);
}

}  // namespace

compat::Scene::Ptr buildScene(const SceneContent& content) {
    Points all = positions(content.trajectory, content.T_scene_world);
    const Points trajectory = all, reference = positions(content.reference, content.T_scene_world);
    const Eigen::Isometry3f T = content.T_scene_world.cast<float>();
    for (const MapEdge& edge : content.map)
        for (const Eigen::Vector3f& point : edge.points) all.push_back(T * point);
    const Extent extent = extentOf(all);
    const float path_radius = std::clamp(0.0012f * extent.diagonal(), 0.002f, 0.03f);

    auto scene = compat::Scene::Create();
    insertGround(*scene, extent);
    insertEdgeLayers(*scene, content);
    // Dashes around the estimate, so that both are seen where they coincide
    if (!reference.empty())
        scene->insert(path(SceneNames::kReference, dashes(reference, kDash * path_radius),
                           kDashWidth * path_radius, toMrpt(SceneColours::kReference)));
    scene->insert(
        path(SceneNames::kTrajectory, {trajectory}, path_radius, toMrpt(SceneColours::kTrajectory)));
    insertKeyframes(*scene, content, std::clamp(0.03f * extent.diagonal(), 0.03f, 0.3f));
    aimCamera(*scene, extent);
    return scene;
}

void saveScene(const std::string& file, const compat::Scene& scene) {
    writeWholeFile(file, [&](const std::string& temporary) {
        constexpr int kLevel = 1;  // as scene.saveToFile(), which does not see that a disk is full
        GzFile out;
        return out.open(temporary, kLevel) && out.write(scene) && out.close();
    });
}

}  // namespace roevo
