#include "edges/edge_grid.h"

#include <algorithm>

namespace roevo {
namespace {

constexpr float kNowhere = 1e9F;  // px; nearer than any radius to no query

}  // namespace

void EdgeGrid::build(const OrganizedEdges& edges, int width, int height) {
    columns_ = width / kernels::kCellWidth + 1;
    rows_ = height / kernels::kCellHeight + 1;
    const std::size_t n = edges.size(), cells = static_cast<std::size_t>(columns_ * rows_);
    first_.assign(cells + 1, 0);
    cell_.resize(n);
    for (std::size_t i = 0; i < n; ++i) {
        cell_[i] = row(edges.y[i]) * columns_ + column(edges.x[i]);
        ++at(first_, cell_[i]);
    }
    std::int32_t end = 0;
    for (std::int32_t& first : first_) first = end += first;  // filled from their ends
    index_.resize(n);
    for (auto* values : {&x_, &y_, &normal_x_, &normal_y_}) values->resize(n + kernels::kGridPadding);
    for (std::size_t i = n; i-- > 0;) {
        const auto k = static_cast<std::size_t>(--at(first_, cell_[i]));
        index_[k] = static_cast<std::int32_t>(i);
        x_[k] = edges.x[i];
        y_[k] = edges.y[i];
        normal_x_[k] = edges.normal_x[i];
        normal_y_[k] = edges.normal_y[i];
    }
    std::fill(x_.begin() + static_cast<std::ptrdiff_t>(n), x_.end(), kNowhere);
}

void EdgeGrid::nearest(const EdgeQueries& queries, std::size_t count, double radius, double min_cosine,
                       std::int32_t* found) const {
    const kernels::EdgeCells cells{x_.data(),     y_.data(),     normal_x_.data(), normal_y_.data(),
                                   index_.data(), first_.data(), columns_,         rows_};
    kernels::best().nearestPoints(cells, queries.u.data(), queries.v.data(), queries.normal_x.data(),
                                  queries.normal_y.data(), count, static_cast<float>(radius),
                                  static_cast<float>(min_cosine), found);
}

}  // namespace roevo
