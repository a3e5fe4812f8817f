#include "edges/organized_edges.h"

#include "kernels/kernels.h"

namespace roevo {
namespace {

/// What there is of every point, but for its edge.
constexpr std::vector<float> OrganizedEdges::*kArrays[] = {
    &OrganizedEdges::x,          &OrganizedEdges::y,        &OrganizedEdges::gradient_x,
    &OrganizedEdges::gradient_y, &OrganizedEdges::normal_x, &OrganizedEdges::normal_y,
    &OrganizedEdges::strength};

}  // namespace

void OrganizedEdges::addPoint(float px, float py, float gx, float gy, float magnitude) {
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

void OrganizedEdges::numberPoints() {
    edge_of.resize(size());
    for (int e = 0; e < numEdges(); ++e) {
        const auto [first, end] = pointsOf(e);
        std::fill(edge_of.data() + first, edge_of.data() + end, e);
    }
}

void OrganizedEdges::resize(std::size_t count) {
    for (const auto array : kArrays) (this->*array).resize(count);
}

void OrganizedEdges::addEdge(const OrganizedEdges& from, std::size_t first,
                             const std::vector<std::size_t>& further) {
    const std::size_t before = size(), count = before + further.size();
    for (const auto array : kArrays) {
        const std::vector<float>& source = from.*array;
        std::vector<float>& target = this->*array;
        target.resize(count);
        for (std::size_t k = 0; k < further.size(); ++k) target[before + k] = source[first + further[k]];
    }
    edge_of.resize(count, numEdges());
    finishEdge();
}

void computeNormals(OrganizedEdges& edges, int span) {
    edges.normal_x.resize(edges.size());
    edges.normal_y.resize(edges.size());
    const auto reach = static_cast<std::size_t>(span);
    float *u = edges.normal_x.data(), *v = edges.normal_y.data();  // chords first
    const float *x = edges.x.data(), *y = edges.y.data();
    for (int e = 0; e < edges.numEdges(); ++e) {
        const IndexRange own = edges.pointsOf(e);
        const auto chord = [&](std::size_t i) {
            const auto [before, end] = own.around(i, reach);
            u[i] = x[end - 1] - x[before];
            v[i] = y[end - 1] - y[before];
        };
        const std::size_t inner = std::min(own.first + reach, own.end),
                          inner_end = std::max(inner, own.end - std::min(reach, own.size()));
        for (std::size_t i = own.first; i < inner; ++i) chord(i);
        for (std::size_t i = inner; i < inner_end; ++i) {
            u[i] = x[i + reach] - x[i - reach];
            v[i] = y[i + reach] - y[i - reach];
        }
        for (std::size_t i = inner_end; i < own.end; ++i) chord(i);
    }
    // An edge of one point, or one that turns back on itself, has its gradient
    kernels::best().normals(u, v, edges.gradient_x.data(), edges.gradient_y.data(), edges.size(), u, v);
}

}  // namespace roevo
