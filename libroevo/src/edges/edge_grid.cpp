#include "edges/edge_grid.h"

namespace roevo {

void EdgeGrid::build(const OrganizedEdges& edges, int width, int height) {
    width_ = width;
    height_ = height;
    row_bits_ = static_cast<std::size_t>(width + 2 * kPadding + 63) / 64 * 64;
    // One word more for the last row's overlap
    bits_.assign(row_bits_ / 64 * static_cast<std::size_t>(height) + 1, 0);
    edges_ = &edges;
    const auto most_x = static_cast<float>(width - 1), most_y = static_cast<float>(height - 1);
    const auto bitOf = [&](std::size_t i) {
        // As nearestPixel() of what is inside
        const int x = static_cast<int>(std::clamp(edges.x[i], 0.0F, most_x) + 0.5F);
        const int y = static_cast<int>(std::clamp(edges.y[i], 0.0F, most_y) + 0.5F);
        return bitIndex(x, y);
    };
    for (std::size_t i = 0; i < edges.size(); ++i) {
        const std::size_t bit = bitOf(i);
        bits_[bit / 64] |= std::uint64_t{1} << (bit % 64);
    }
    before_.resize(bits_.size());
    std::int32_t count = 0;
    for (std::size_t word = 0; word < bits_.size(); ++word) {
        before_[word] = count;
        count += __builtin_popcountll(bits_[word]);
    }
    points_.resize(static_cast<std::size_t>(count));
    for (std::size_t i = 0; i < edges.size(); ++i) points_[rank(bitOf(i))] = pointAt(i);
}

}  // namespace roevo
