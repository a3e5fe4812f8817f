#include "edge_layers.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "roevo_mrpt/scene_objects.h"
#include "tracking/robust.h"

namespace roevo {
namespace {

using Cloud = compat::scene::CPointCloudColoured;

constexpr float kSpacing = 0.005f;  // m between the points of a drawn edge
// A gap is filled unless it is much larger than those of the edge are (far away they are wide)
constexpr float kFilled = 0.05f, kNeverFilled = 0.25f, kUsualGaps = 3;  // m, m, times the median
constexpr float kFaintest = 0.35f;     // opacity of an edge with confidence 0
constexpr float kSurfacePoint = 1.5f;  // times the size of an edge's: they are farther apart
constexpr Rgb kSpreadColour{240, 140, 30}, kVanishingColour{225, 60, 200}, kSingleColour{205, 205, 205};

float medianGap(const std::vector<Eigen::Vector3f>& points) {
    std::vector<float> gaps;
    for (std::size_t i = 1; i < points.size(); i++) gaps.push_back((points[i] - points[i - 1]).norm());
    return gaps.empty() ? 0 : medianOf(gaps);
}

Rgb between(const Rgb& a, const Rgb& b, float share) {
    Rgb colour;
    for (std::size_t c = 0; c < 3; c++) {
        const float from = a[c], to = b[c];
        colour[c] = static_cast<std::uint8_t>(std::lround(from + share * (to - from)));
    }
    return colour;
}

/// A layer being filled: a cloud of the scene's frame.
class Layer {
  public:
    Layer(const char* name, const SceneContent& content, float larger = 1)
        : cloud_(Cloud::Create()), T_scene_world_(content.T_scene_world.cast<float>()) {
        cloud_->setName(name);
        cloud_->setPointSize(larger * content.point_size);
    }

    void add(const Eigen::Vector3f& in_world, const Rgb& colour, float opacity = 1) {
        const Eigen::Vector3f p = T_scene_world_ * in_world;
        const auto alpha = static_cast<std::uint8_t>(std::lround(255 * opacity));
        cloud_->insertPoint({p.x(), p.y(), p.z(), colour[0], colour[1], colour[2], alpha});
    }

    /// The edge as a line of points. `colourOf` gives the colour of its i-th point.
    template <class ColourOf>
    void addLine(const std::vector<Eigen::Vector3f>& points, const ColourOf& colourOf, float opacity = 1) {
        const float largest_gap = largestDrawnGap(points);
        for (std::size_t i = 0; i < points.size(); i++) {
            if (i > 0 && (points[i] - points[i - 1]).norm() < largest_gap)
                fill(points[i - 1], points[i], colourOf(i - 1), colourOf(i), opacity);
            add(points[i], colourOf(i), opacity);
        }
    }

    bool empty() const { return cloud_->size() == 0; }
    void insertInto(compat::Scene& scene, bool visible) {
        cloud_->setVisibility(visible);
        scene.insert(cloud_);
    }

  private:
    void fill(const Eigen::Vector3f& a, const Eigen::Vector3f& b, const Rgb& colour_a, const Rgb& colour_b,
              float opacity) {
        const int steps = static_cast<int>(std::ceil((b - a).norm() / kSpacing));
        for (int k = 1; k < steps; k++) {
            const float share = static_cast<float>(k) / static_cast<float>(steps);
            add(a + share * (b - a), between(colour_a, colour_b, share), opacity);
        }
    }

    Cloud::Ptr cloud_;
    Eigen::Isometry3f T_scene_world_;
};

/// Fully different hues for neighbouring numbers: the golden ratio spreads them evenly, however many there
/// are.
Rgb clusterColour(int cluster) {
    const double hue = 6 * std::fmod(0.61803398875 * (1 + std::abs(cluster)), 1.0);
    const double darkest = 0.15, brightness = cluster % 2 == 0 ? 1.0 : 0.8;
    Rgb colour;
    for (std::size_t c = 0; c < 3; c++) {
        const double k = std::fmod(5 - 2 * static_cast<double>(c) + hue, 6.0);  // red, green, blue: 5, 3, 1
        const double level = 1 - (1 - darkest) * std::clamp(std::min(k, 4 - k), 0.0, 1.0);
        colour[c] = static_cast<std::uint8_t>(std::lround(255 * brightness * level));
    }
    return colour;
}

void insertEdges(compat::Scene& scene, const SceneContent& content) {
    Layer edges(SceneNames::kEdges, content), pseudo(SceneNames::kPseudoEdges, content);
    for (const MapEdge& edge : content.map) {
        if (!isPseudo(edge.verdict)) {
            const float opacity = kFaintest + (1 - kFaintest) * std::clamp(edge.confidence, 0.f, 1.f);
            edges.addLine(
                edge.points, [&](std::size_t i) { return edge.colours.at(i); }, opacity);
            continue;
        }
        const Rgb colour = pseudoEdgeColour(edge.verdict);
        pseudo.addLine(edge.points, [&](std::size_t) { return colour; });
    }
    edges.insertInto(scene, true);
    if (!pseudo.empty()) pseudo.insertInto(scene, false);
}

void insertCovisibility(compat::Scene& scene, const SceneContent& content) {
    // Of each cluster: a keyframe in it, and whether there is another
    std::map<int, std::pair<int, bool>> shared;
    for (const MapEdge& edge : content.keyframe_edges) {
        const auto [at, is_new] = shared.try_emplace(edge.cluster, edge.keyframe_id, false);
        if (!is_new && at->second.first != edge.keyframe_id) at->second.second = true;
    }
    Layer layer(SceneNames::kCovisibility, content);
    for (const bool now_shared : {false, true})  // shared ones come last, on top of the others
        for (const MapEdge& edge : content.keyframe_edges) {
            if (shared.at(edge.cluster).second != now_shared) continue;
            const Rgb colour = now_shared ? clusterColour(edge.cluster) : kSingleColour;
            layer.addLine(edge.points, [&](std::size_t) { return colour; });
        }
    if (!layer.empty()) layer.insertInto(scene, false);
}

void insertSemiDense(compat::Scene& scene, const SceneContent& content) {
    Layer layer(SceneNames::kSemiDense, content, kSurfacePoint);
    for (const ColouredPoint& point : content.semi_dense) layer.add(point.position, point.colour);
    if (!layer.empty()) layer.insertInto(scene, false);
}

}  // namespace

float largestDrawnGap(const std::vector<Eigen::Vector3f>& edge) {
    return std::clamp(kUsualGaps * medianGap(edge), kFilled, kNeverFilled);
}

Rgb pseudoEdgeColour(EdgeVerdict verdict) {
    return verdict == EdgeVerdict::kSpread ? kSpreadColour : kVanishingColour;
}

void insertEdgeLayers(compat::Scene& scene, const SceneContent& content) {
    insertEdges(scene, content);
    insertCovisibility(scene, content);
    insertSemiDense(scene, content);
}

}  // namespace roevo
