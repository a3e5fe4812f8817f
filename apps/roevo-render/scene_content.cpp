#include "scene_content.h"

#include <mrpt/poses/CPose3D.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <fstream>
#include <functional>
#include <stdexcept>

#include "input/regular_file.h"
#include "roevo_mrpt/scene_builder.h"
#include "roevo_mrpt/scene_objects.h"

namespace roevo {
namespace {

using namespace compat::scene;

struct LayerName {
    const char *user, *object;
};
constexpr LayerName kLayers[] = {{"edges", SceneNames::kEdges},
                                 {"covisibility", SceneNames::kCovisibility},
                                 {"semi-dense", SceneNames::kSemiDense},
                                 {"pseudo-edges", SceneNames::kPseudoEdges}};
constexpr float kLineDistance = 0.46f, kSurfaceDistance = 0.13f;  // in brightness, from the background
// Share of the way to the background, where all layers are shown and for the grid
constexpr float kFaintSurface = 0.55f, kFaintLines = 0.55f, kFaintPseudoEdges = 0.45f, kFaintGrid = 0.72f;
constexpr float kWiderEdges = 1.6f;  // where all layers are shown

// Calls visit(object, pose of its parent) for everything that is not a group.
template <class Container, class Visitor>
void visitObjects(const Container& objects, const mrpt::poses::CPose3D& parent, const Visitor& visit) {
    for (const compat::SceneObject::Ptr& object : objects) {
        if (!object || !object->isVisible()) continue;
        if (const auto* group = dynamic_cast<const CSetOfObjects*>(object.get()))
            visitObjects(*group, parent + mrpt::poses::CPose3D(group->getPose()), visit);
        else
            visit(*object, parent);
    }
}

template <class Visitor>
void visitObjects(const compat::Scene& scene, const Visitor& visit) {
    if (const auto viewport = scene.getViewport("main"))
        visitObjects(*viewport, mrpt::poses::CPose3D(), visit);
}

Eigen::Vector3f toEigen(const mrpt::math::TPoint3D& p) {
    return Eigen::Vector3d(p.x, p.y, p.z).cast<float>();
}

template <class Cloud>
void addCloud(const Cloud& cloud, const mrpt::poses::CPose3D& pose, std::vector<Eigen::Vector3f>& points) {
    for (std::size_t i = 0; i < cloud.size(); ++i) {
        const auto& p = cloud.getPoint3Df(i);
        points.push_back(toEigen(pose.composePoint(mrpt::math::TPoint3D(p.x, p.y, p.z))));
    }
}

bool isGrid(const compat::SceneObject& object) {
    return dynamic_cast<const CGridPlaneXY*>(&object) || dynamic_cast<const CGridPlaneXZ*>(&object);
}

void addCorners(const compat::SceneObject& object, const mrpt::poses::CPose3D& parent,
                std::vector<Eigen::Vector3f>& points) {
    const auto box = object.getBoundingBox();
    for (int corner = 0; corner < 8; ++corner)
        points.push_back(toEigen(parent.composePoint(
            mrpt::math::TPoint3D(corner & 1 ? box.max.x : box.min.x, corner & 2 ? box.max.y : box.min.y,
                                 corner & 4 ? box.max.z : box.min.z))));
}

// Of a layer that is shown below the edges.
float faintnessOf(const std::string& name) {
    if (name == SceneNames::kSemiDense) return kFaintSurface;
    if (name == SceneNames::kCovisibility) return kFaintLines;
    return name == SceneNames::kPseudoEdges ? kFaintPseudoEdges : 0;
}

}  // namespace

compat::Scene::Ptr loadScene(const std::string& path) {
    requireRegularInput(path);
    errno = 0;
    if (!std::ifstream(path)) throw std::runtime_error("cannot read " + path + ": " + std::strerror(errno));
    auto scene = compat::Scene::Create();
    bool loaded = false;
    try {
        loaded = scene->loadFromFile(path);
    } catch (const std::exception&) {  // MRPT's text is about its stream classes and tells the user nothing
    }
    if (!loaded || !scene->getViewport("main"))
        throw std::runtime_error(path + " is not a whole MRPT .3Dscene file");
    return scene;
}

std::vector<std::string> layerNames() {
    std::vector<std::string> names;
    for (const LayerName& layer : kLayers) names.emplace_back(layer.user);
    names.emplace_back(kAllLayers);
    return names;
}

void showLayer(compat::Scene& scene, const std::string& layer) {
    bool found = false;
    std::string held;
    for (const LayerName& each : kLayers) {
        const auto object = scene.getByName(each.object);
        if (!object) continue;
        const bool wanted = layer == each.user || layer == kAllLayers;
        object->setVisibility(wanted);
        found = found || wanted;
        held += (held.empty() ? "" : ", ") + std::string(each.user);
    }
    if (found) return;
    throw std::runtime_error("the scene has no layer '" + layer + "'; it has " +
                             (held.empty() ? "none" : held));
}

ViewContent sceneContent(const compat::Scene& scene) {
    ViewContent content;
    visitObjects(scene, [&](const compat::SceneObject& object, const mrpt::poses::CPose3D& parent) {
        const auto pose = parent + mrpt::poses::CPose3D(object.getPose());
        if (const auto* coloured = dynamic_cast<const CPointCloudColoured*>(&object))
            addCloud(*coloured, pose, content.cloud);
        else if (const auto* plain = dynamic_cast<const CPointCloud*>(&object))
            addCloud(*plain, pose, content.cloud);
        else if (!isGrid(object) && !dynamic_cast<const CAxis*>(&object))
            addCorners(object, parent, content.must_see);
    });
    return content;
}

std::vector<compat::SceneObject::Ptr> preparePoints(compat::Scene& scene, float factor,
                                                    const Background& background, bool all_layers) {
    std::vector<compat::SceneObject::Ptr> faint;
    visitObjects(scene, [&](compat::SceneObject& object, const mrpt::poses::CPose3D&) {
        auto* points = dynamic_cast<compat::ScenePoints*>(&object);
        if (!points) return;
        const std::string name = object.getName();
        if (all_layers && faintnessOf(name) > 0) faint.push_back(scene.getByName(name));
        points->enableVariablePointSize(false);
        points->setPointSize(points->getPointSize() * factor *
                             (all_layers && name == SceneNames::kEdges ? kWiderEdges : 1));
        auto* coloured = dynamic_cast<CPointCloudColoured*>(&object);
        for (std::size_t i = 0; coloured && i < coloured->size(); ++i) {
            Colour c;
            coloured->getPointColor_fast(i, c[0], c[1], c[2]);
            c = shownColour(c, name, background, all_layers);
            coloured->setPointColor_fast(i, c[0], c[1], c[2]);
        }
    });
    return faint;
}

void prepareGrid(compat::Scene& scene, const Background& background) {
    visitObjects(scene, [&](compat::SceneObject& object, const mrpt::poses::CPose3D&) {
        if (!isGrid(object)) return;
        const auto [r, g, b] = background.faded(background.ink(), kFaintGrid);
        object.setColor(r, g, b);
    });
}

void cropGrid(compat::Scene& scene, const Eigen::AlignedBox3f& box) {
    const auto grid = std::dynamic_pointer_cast<CGridPlaneXY>(scene.getByName(SceneNames::kGround));
    if (!grid) return;
    const float cell = grid->getGridFrequency();
    float low[2], high[2];
    grid->getPlaneLimits(low[0], high[0], low[1], high[1]);
    for (int axis = 0; axis < 2; ++axis) {
        low[axis] = std::max(low[axis], std::ceil(box.min()[axis] / cell) * cell);
        high[axis] = std::min(high[axis], std::floor(box.max()[axis] / cell) * cell);
    }
    if (low[0] < high[0] && low[1] < high[1])
        grid->setPlaneLimits(low[0], high[0], low[1], high[1]);
    else
        grid->setVisibility(false);  // the content is smaller than a cell
}

Colour shownColour(const Colour& colour, const std::string& layer, const Background& background,
                   bool all_layers) {
    // A surface is seen by its colours, a line by how it differs from the background
    const float distance = layer == SceneNames::kSemiDense ? kSurfaceDistance : kLineDistance;
    const Colour seen = background.standingOut(colour, distance);
    return all_layers ? background.faded(seen, faintnessOf(layer)) : seen;
}

}  // namespace roevo
