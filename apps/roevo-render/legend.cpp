#include "legend.h"

#include "programs/text.h"
#include "roevo_mrpt/scene_builder.h"
#include "roevo_mrpt/scene_objects.h"
#include "scene_content.h"

namespace roevo {
namespace {

constexpr std::size_t kSamples = 6;  // colours of an entry for what has the image's

Colour levels(const Rgb& rgb) {
    return {static_cast<float>(rgb[0]) / 255, static_cast<float>(rgb[1]) / 255,
            static_cast<float>(rgb[2]) / 255};
}

// Colours of points evenly spaced in the cloud's order.
std::vector<Colour> samples(const compat::SceneObject& object) {
    std::vector<Colour> colours;
    const auto* cloud = dynamic_cast<const compat::scene::CPointCloudColoured*>(&object);
    for (std::size_t k = 0; cloud && cloud->size() > 0 && k < kSamples; ++k) {
        Colour c;
        cloud->getPointColor_fast((2 * k + 1) * cloud->size() / (2 * kSamples), c[0], c[1], c[2]);
        colours.push_back(c);
    }
    return colours;
}

}  // namespace

std::vector<LegendEntry> legendOf(compat::Scene& scene, const Background& background, bool all_layers) {
    std::vector<LegendEntry> entries;
    const auto visible = [&](const char* name) {
        const auto object = scene.getByName(name);
        return object && object->isVisible() ? object : nullptr;
    };
    const auto addObject = [&](const char* name, const char* text, const Rgb& colour) {
        if (visible(name)) entries.push_back({text, {levels(colour)}});
    };
    const auto addLayer = [&](const char* name, const char* text) {
        const auto object = visible(name);
        if (!object) return;
        auto colours = samples(*object);
        if (!colours.empty()) entries.push_back({text, std::move(colours)});
    };
    addObject(SceneNames::kTrajectory, "estimated trajectory", SceneColours::kTrajectory);
    addObject(SceneNames::kReference, "ground truth", SceneColours::kReference);
    addObject(SceneNames::kKeyframes, "keyframes", SceneColours::kKeyframes);
    addLayer(SceneNames::kEdges, "edges");
    addLayer(SceneNames::kSemiDense, "surface");
    addLayer(SceneNames::kCovisibility, "edges of keyframes, equal where the same");
    const auto addPseudo = [&](const char* text, EdgeVerdict verdict) {
        const Colour shown =
            shownColour(levels(pseudoEdgeColour(verdict)), SceneNames::kPseudoEdges, background, all_layers);
        if (visible(SceneNames::kPseudoEdges)) entries.push_back({text, {shown}});
    };
    addPseudo("pseudo-edges: spread", EdgeVerdict::kSpread);
    addPseudo("vanishing", EdgeVerdict::kVanishing);
    const auto grid =
        std::dynamic_pointer_cast<compat::scene::CGridPlaneXY>(scene.getByName(SceneNames::kGround));
    if (grid && grid->isVisible()) {
        const auto c = grid->getColor();
        entries.push_back(
            {"grid " + plainNumber(std::round(1000 * static_cast<double>(grid->getGridFrequency())) / 1000) +
                 " m",
             {{static_cast<float>(c.R), static_cast<float>(c.G), static_cast<float>(c.B)}}});
    }
    return entries;
}

}  // namespace roevo
