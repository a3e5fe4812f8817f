#include "edges/edge_grid.h"

namespace roevo {

void EdgeGrid::build(const OrganizedEdges& edges, int width, int height) {
    width_ = width;
    height_ = height;
    row_bits_ = static_cast<std::size_t>(width + 2 * kPadding + 63) / 64 * 64;
    // One word more for the last row's overlap
    bits_.assign(row_bits_ / 64 * static_cast<std::size_t>(height) + 1, 0);
    cell_.resize(static_cast<std::size_t>(width) * static_cast<std::size_t>(height));
    edges_ = &edges;
    for (std::size_t i = 0; i < edges.size(); ++i) {
        const int x = std::clamp(nearestPixel(edges.x[i]), 0, width - 1);
        const int y = std::clamp(nearestPixel(edges.y[i]), 0, height - 1);
        const std::size_t bit = bitIndex(x, y);
        bits_[bit / 64] |= std::uint64_t{1} << (bit % 64);
        cell_[static_cast<std::size_t>(y * width + x)] = static_cast<std::int32_t>(i);
    }
}

}  // namespace roevo
