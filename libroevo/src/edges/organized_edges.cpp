#include "edges/organized_edges.h"

#include <algorithm>
#include <cmath>

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
    for (int e = 0; e < edges.numEdges(); ++e) {
        const int first = edges.begin[static_cast<std::size_t>(e)];
        const int last = edges.begin[static_cast<std::size_t>(e) + 1] - 1;
        for (int i = first; i <= last; ++i) {
            const auto before = static_cast<std::size_t>(std::max(first, i - span));
            const auto after = static_cast<std::size_t>(std::min(last, i + span));
            const auto at = static_cast<std::size_t>(i);
            const float vx = edges.x[after] - edges.x[before], vy = edges.y[after] - edges.y[before];
            const float length = std::sqrt(vx * vx + vy * vy);
            if (!(length > 0)) {  // an edge of one point, or one that turns back on itself
                edges.normal_x[at] = edges.gradient_x[at];
                edges.normal_y[at] = edges.gradient_y[at];
                continue;
            }
            float mx = -vy / length, my = vx / length;                        // Eq. (4)
            if (mx * edges.gradient_x[at] + my * edges.gradient_y[at] < 0) {  // Eqs. (5), (6)
                mx = -mx;
                my = -my;
            }
            edges.normal_x[at] = mx;
            edges.normal_y[at] = my;
        }
    }
}

}  // namespace roevo
