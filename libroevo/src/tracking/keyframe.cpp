#include "tracking/keyframe.h"

namespace roevo {

void Keyframe::setRowMotion(const RowMotion& rows) {
    if (rows == row_motion) return;
    exchangeMotion(row_motion, rows, edges.image.y, edges.size(), edges.points);
    row_motion = rows;
    for (std::size_t k = 0; k < photometric.source.size(); ++k)
        for (const auto axis : {&Points3::x, &Points3::y, &Points3::z})
            (photometric.points.*axis)[k] = at(edges.points.*axis, photometric.source[k]);
}

void Keyframe::count(const std::vector<std::int32_t>& looked_for, const std::vector<std::int32_t>& found) {
    constexpr int kMostTrials = 1 << 30;  // a camera may stand still for days
    if (found.empty()) return;
    hits.resize(found.size(), 0);
    trials.resize(found.size(), 0);
    for (std::size_t e = 0; e < found.size(); ++e) {
        if (trials[e] > kMostTrials) hits[e] /= 2, trials[e] /= 2;
        hits[e] += found[e];
        trials[e] += looked_for[e];
    }
}

std::vector<float> Keyframe::foundShares() const {
    constexpr int kMinTrials = 10;  // of points and frames together
    std::vector<float> shares(static_cast<std::size_t>(edges.image.numEdges()), -1);
    for (std::size_t e = 0; e < trials.size(); ++e)
        if (trials[e] >= kMinTrials) shares[e] = static_cast<float>(hits[e]) / static_cast<float>(trials[e]);
    return shares;
}

void Keyframe::weaken(const std::vector<EdgeVerdict>& verdicts, double weight) {
    const auto factor = static_cast<float>(weight);
    const auto affected = [&](auto point) { return isPseudo(at(verdicts, at(edges.image.edge_of, point))); };
    for (std::size_t i = 0; i < edges.size(); ++i)
        if (affected(i)) edges.weight[i] *= factor;
    for (std::size_t k = 0; k < photometric.source.size(); ++k)
        if (affected(photometric.source[k])) photometric.weight[k] *= factor;
}

}  // namespace roevo
