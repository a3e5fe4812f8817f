#include "roevo/edges/edge_grid.h"

#include <algorithm>

namespace roevo {

const std::vector<EdgeGrid::Offset>& EdgeGrid::spiral() {
    static const std::vector<Offset> offsets = [] {
        std::vector<Offset> all;
        const int reach = kMaxRadius + 2;
        for (int dy = -reach; dy <= reach; ++dy) {
            for (int dx = -reach; dx <= reach; ++dx) {
                all.push_back({static_cast<std::int16_t>(dx), static_cast<std::int16_t>(dy),
                               std::sqrt(static_cast<float>(dx * dx + dy * dy))});
            }
        }
        std::stable_sort(all.begin(), all.end(),
                         [](const Offset& a, const Offset& b) { return a.distance < b.distance; });
        return all;
    }();
    return offsets;
}

void EdgeGrid::build(const OrganizedEdges& edges, int width, int height) {
    if (width != width_ || height != height_) {
        width_ = width;
        height_ = height;
        cell_.assign(static_cast<std::size_t>(width) * static_cast<std::size_t>(height), 0);
    } else {
        for (const std::int32_t cell : filled_) cell_[static_cast<std::size_t>(cell)] = 0;
    }
    filled_.clear();
    edges_ = &edges;
    for (std::size_t i = 0; i < edges.size(); ++i) {
        const int x = std::clamp(static_cast<int>(std::lround(edges.x[i])), 0, width - 1);
        const int y = std::clamp(static_cast<int>(std::lround(edges.y[i])), 0, height - 1);
        const std::int32_t cell = y * width + x;
        cell_[static_cast<std::size_t>(cell)] = static_cast<std::int32_t>(i) + 1;
        filled_.push_back(cell);
    }
}

}  // namespace roevo
