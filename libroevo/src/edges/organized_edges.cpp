#include "edges/organized_edges.h"

namespace roevo {

void OrganizedEdges::clear() {
    for (auto* array : {&x, &y, &gradient_x, &gradient_y, &normal_x, &normal_y, &strength}) array->clear();
    edge_of.clear();
    begin.assign(1, 0);
}

void OrganizedEdges::addPoint(float px, float py, float gx, float gy, float magnitude) {
    if (begin.empty()) begin.push_back(0);
    x.push_back(px);
    y.push_back(py);
    gradient_x.push_back(gx);
    gradient_y.push_back(gy);
    strength.push_back(magnitude);
    edge_of.push_back(numEdges());
}

void OrganizedEdges::finishEdge() {
    begin.push_back(static_cast<std::int32_t>(x.size()));
}

void computeNormals(OrganizedEdges& edges, int span) {
    edges.normal_x.resize(edges.size());
    edges.normal_y.resize(edges.size());
    const auto reach = static_cast<std::size_t>(span);
    for (int e = 0; e < edges.numEdges(); ++e) {
        const IndexRange own = edges.pointsOf(e);
        for (std::size_t i = own.first; i < own.end; ++i) {
            const auto [before, end] = own.around(i, reach);
            const float gx = edges.gradient_x[i], gy = edges.gradient_y[i];
            float &nx = edges.normal_x[i], &ny = edges.normal_y[i];
            if (edgeNormal(edges.x[end - 1] - edges.x[before], edges.y[end - 1] - edges.y[before], gx, gy, nx,
                           ny))
                continue;
            nx = gx;  // an edge of one point, or one that turns back on itself
            ny = gy;
        }
    }
}

}  // namespace roevo
