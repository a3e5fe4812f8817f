#include "roevo/mapping/pseudo_edges.h"

#include <algorithm>
#include <cmath>

namespace roevo {
namespace {

constexpr double kNearest = 0.05;     ///< m; nearer points cannot be projected
constexpr double kFarOff = 100;       ///< px, for a point that cannot be projected
constexpr double kLookShare = 0.7;    ///< a keyframe looks at an edge when so much of it is in its image
constexpr double kSeeShare = 0.3;     ///< and sees it when so much of that is observed
constexpr double kFrameEvidence = 3;  ///< keyframes that all frames since a keyframe count as

double tangentResidual(const PinholeCamera& camera, const MapKeyframe& keyframe, std::size_t i,
                       const Eigen::Vector3d& in_camera) {
    const Eigen::Vector2d pixel = camera.project(in_camera);
    return static_cast<double>(keyframe.image.normal_x[i]) *
               (pixel.x() - static_cast<double>(keyframe.image.x[i])) +
           static_cast<double>(keyframe.image.normal_y[i]) *
               (pixel.y() - static_cast<double>(keyframe.image.y[i]));  // Eq. (7)
}

}  // namespace

double PseudoEdgeJudge::spreadOf(const std::vector<WindowKeyframe>& window, const FusedEdges& edges,
                                 std::size_t p) const {
    const auto first = static_cast<std::size_t>(edges.observation_begin[p]);
    const auto end = static_cast<std::size_t>(edges.observation_begin[p + 1]);
    double sum = 0;
    for (std::size_t k = first; k < end; ++k) {
        const WindowKeyframe& view = window[static_cast<std::size_t>(edges.observations[k].slot)];
        const auto i = static_cast<std::size_t>(edges.observations[k].point);
        const Eigen::Vector3d q =
            view.T_world_camera.linear().transpose() * (edges.points[p] - view.T_world_camera.translation());
        const double residual = q.z() > kNearest ? tangentResidual(camera_, *view.keyframe, i, q) : kFarOff;
        sum += residual * residual;
    }
    return std::sqrt(sum / static_cast<double>(end - first - 1));
}

std::pair<int, int> PseudoEdgeJudge::countLooks(const std::vector<WindowKeyframe>& window,
                                                const FusedEdges& edges, std::size_t edge) const {
    constexpr double kMargin = 5;
    const auto first = static_cast<std::size_t>(edges.begin[edge]);
    const auto end = static_cast<std::size_t>(edges.begin[edge + 1]);
    int looked = 0, seen = 0;
    for (std::size_t slot = 0; slot < window.size(); ++slot) {
        const WindowKeyframe& view = window[slot];
        int inside = 0, observed = 0;
        for (std::size_t p = first; p < end; ++p) {
            const Eigen::Vector3d q = view.T_world_camera.linear().transpose() *
                                      (edges.points[p] - view.T_world_camera.translation());
            if (!(q.z() > sensor_.min_depth)) continue;
            const Eigen::Vector2d pixel = camera_.project(q);
            if (pixel.x() < kMargin || pixel.y() < kMargin || pixel.x() > camera_.width - 1 - kMargin ||
                pixel.y() > camera_.height - 1 - kMargin) {
                continue;
            }
            ++inside;
            const auto from = edges.observations.begin() + edges.observation_begin[p];
            const auto to = edges.observations.begin() + edges.observation_begin[p + 1];
            observed += std::any_of(from, to,
                                    [&](const Observation& observation) {
                                        return observation.slot == static_cast<std::int32_t>(slot);
                                    })
                            ? 1
                            : 0;
        }
        if (inside < kLookShare * static_cast<double>(end - first)) continue;
        ++looked;
        seen += observed >= kSeeShare * inside ? 1 : 0;
    }
    return {looked, seen};
}

void PseudoEdgeJudge::judge(const std::vector<WindowKeyframe>& window, FusedEdges& edges,
                            double scale) const {
    std::vector<double> spreads;
    for (int e = 0; e < edges.numEdges(); ++e) {
        const auto edge = static_cast<std::size_t>(e);
        EdgeVerdict& verdict = edges.verdicts[edge];
        verdict = edges.views[edge] > 1 ? EdgeVerdict::kTrue : EdgeVerdict::kUnconfirmed;
        spreads.clear();
        for (auto p = static_cast<std::size_t>(edges.begin[edge]);
             p < static_cast<std::size_t>(edges.begin[edge + 1]); ++p) {
            if (edges.observation_begin[p + 1] - edges.observation_begin[p] < 2) continue;
            spreads.push_back(spreadOf(window, edges, p));
        }
        if (!spreads.empty()) {
            const auto middle = spreads.begin() + static_cast<std::ptrdiff_t>(spreads.size() / 2);
            std::nth_element(spreads.begin(), middle, spreads.end());
            if (*middle > options_.max_spread * scale) {
                verdict = EdgeVerdict::kSpread;
                continue;
            }
        }
        // The keyframe in which an edge was found first proves nothing
        const auto [looked, seen] = countLooks(window, edges, edge);
        const double found = foundShare(window, edges, edge);
        const double frames = found < 0 ? 0 : kFrameEvidence;
        const double evidence = looked - 1 + frames;
        if (evidence < options_.min_looks - 1) continue;
        if (seen - 1 + frames * found < options_.min_seen * evidence) verdict = EdgeVerdict::kVanishing;
    }
}

double PseudoEdgeJudge::foundShare(const std::vector<WindowKeyframe>& window, const FusedEdges& edges,
                                   std::size_t edge) const {
    double sum = 0;
    int count = 0;
    for (auto k =
             static_cast<std::size_t>(edges.observation_begin[static_cast<std::size_t>(edges.begin[edge])]);
         k <
         static_cast<std::size_t>(edges.observation_begin[static_cast<std::size_t>(edges.begin[edge + 1])]);
         ++k) {
        const MapKeyframe& keyframe = *window[static_cast<std::size_t>(edges.observations[k].slot)].keyframe;
        const std::int32_t own =
            keyframe.image.edge_of[static_cast<std::size_t>(edges.observations[k].point)];
        const float found = keyframe.found[static_cast<std::size_t>(own)];
        if (found < 0) continue;
        sum += static_cast<double>(found);
        ++count;
    }
    return count > 0 ? sum / count : -1;
}

}  // namespace roevo
