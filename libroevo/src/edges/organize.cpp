#include "edges/organize.h"

#include <algorithm>
#include <cmath>

#include "roevo/types.h"

namespace roevo {

void adjustAdjacency(EdgeMask& edges) {
    const int width = edges.mask.cols;
    auto* mask = edges.mask.ptr<std::uint8_t>();
    // T first: its centre has to go while all three arms are there; the arms stay connected through
    // diagonals.
    for (const std::int32_t p : edges.pixels) {
        const int sides = mask[p - 1] + mask[p + 1] + mask[p - width] + mask[p + width];
        if (mask[p] != 0 && sides >= 3) mask[p] = 0;
    }
    // L: a horizontal and a vertical neighbour, which touch each other by a diagonal. Looked at from the
    // corner.
    for (const std::int32_t p : edges.pixels) {
        if (mask[p] == 0) continue;
        const bool horizontal = mask[p - 1] != 0 || mask[p + 1] != 0;
        const bool vertical = mask[p - width] != 0 || mask[p + width] != 0;
        if (horizontal && vertical) mask[p] = 0;
    }
    edges.pixels.erase(
        std::remove_if(edges.pixels.begin(), edges.pixels.end(), [&](auto p) { return mask[p] == 0; }),
        edges.pixels.end());
}

void EdgeOrganizer::growCluster(const Gradient& gradient, std::int32_t seed, float min_cosine) {
    const auto* gx = gradient.gx.ptr<std::int16_t>();
    const auto* gy = gradient.gy.ptr<std::int16_t>();
    const auto* magnitude = gradient.magnitude.ptr<float>();
    // Side neighbours before diagonal ones: the nearer pixel is the better successor.
    const std::int32_t neighbours[8] = {-1,          1,           -width_,    width_,
                                        -width_ - 1, -width_ + 1, width_ - 1, width_ + 1};
    tree_.clear();
    tree_.push_back({seed, -1, 0, 0, -1, -1});
    open_[static_cast<std::size_t>(seed)] = 0;
    for (std::size_t i = 0; i < tree_.size(); ++i) {
        const std::int32_t p = tree_[i].pixel;
        const auto px = static_cast<float>(gx[p]), py = static_cast<float>(gy[p]);
        for (const std::int32_t offset : neighbours) {
            const std::int32_t q = p + offset;
            if (open_[static_cast<std::size_t>(q)] == 0) continue;
            const float dot = px * static_cast<float>(gx[q]) + py * static_cast<float>(gy[q]);
            if (dot < min_cosine * magnitude[p] * magnitude[q]) continue;
            open_[static_cast<std::size_t>(q)] = 0;
            tree_.push_back({q, static_cast<std::int32_t>(i), 0, 0, -1, -1});
        }
    }
}

void EdgeOrganizer::longestRoute() {
    // Children come after their parents in the tree, so one backward pass knows the two longest routes below
    // each node; the best pair meets where their sum is greatest.
    std::size_t top = 0;
    std::int32_t best = -1;
    for (std::size_t i = tree_.size(); i-- > 0;) {
        const Node& node = tree_[i];
        if (const std::int32_t length = node.depth1 + node.depth2 + 1; length > best) {
            best = length;
            top = i;
        }
        if (node.parent < 0) continue;
        Node& parent = tree_[static_cast<std::size_t>(node.parent)];
        const std::int32_t below = node.depth1 + 1;
        if (below > parent.depth1) {
            parent.depth2 = parent.depth1;
            parent.child2 = parent.child1;
            parent.depth1 = below;
            parent.child1 = static_cast<std::int32_t>(i);
        } else if (below > parent.depth2) {
            parent.depth2 = below;
            parent.child2 = static_cast<std::int32_t>(i);
        }
    }
    route_.clear();
    for (std::int32_t i = tree_[top].child1; i >= 0; i = tree_[static_cast<std::size_t>(i)].child1)
        route_.push_back(i);
    std::reverse(route_.begin(), route_.end());
    route_.push_back(static_cast<std::int32_t>(top));
    for (std::int32_t i = tree_[top].child2; i >= 0; i = tree_[static_cast<std::size_t>(i)].child1)
        route_.push_back(i);
}

void EdgeOrganizer::emitRoute(const Gradient& gradient, OrganizedEdges& out) const {
    for (const std::int32_t node : route_) {
        const std::int32_t p = tree_[static_cast<std::size_t>(node)].pixel;
        const int px = p % width_, py = p / width_;
        const cv::Point2f offset = subpixelOffset(gradient, px, py);
        const float magnitude = gradient.magnitude.ptr<float>()[p];
        out.addPoint(static_cast<float>(px) + offset.x, static_cast<float>(py) + offset.y,
                     static_cast<float>(gradient.gx.ptr<std::int16_t>()[p]) / magnitude,
                     static_cast<float>(gradient.gy.ptr<std::int16_t>()[p]) / magnitude, magnitude / 8);
    }
    out.finishEdge();
}

void EdgeOrganizer::organize(const Gradient& gradient, const EdgeMask& edges, double angle_deg,
                             int min_length, OrganizedEdges& out) {
    out.clear();
    width_ = edges.mask.cols;
    const auto* mask = edges.mask.ptr<std::uint8_t>();
    open_.assign(mask, mask + edges.mask.total());
    const auto min_cosine = static_cast<float>(std::cos(angle_deg * kDegree));
    const auto searchFrom = [&](std::int32_t seed) {
        if (open_[static_cast<std::size_t>(seed)] == 0) return;
        growCluster(gradient, seed, min_cosine);
        if (tree_.size() < static_cast<std::size_t>(min_length)) return;
        longestRoute();
        if (route_.size() < static_cast<std::size_t>(min_length)) return;
        emitRoute(gradient, out);
        for (const std::int32_t node : route_) tree_[static_cast<std::size_t>(node)].pixel = -1;
        for (const Node& node : tree_) {
            if (node.pixel >= 0) again_.push_back(node.pixel);
        }
    };
    again_.clear();
    for (const std::int32_t seed : edges.pixels) searchFrom(seed);
    // Branches left out are opened together and searched once; what is left out then is dropped, which keeps
    // the work linear.
    const std::size_t count = again_.size();
    for (std::size_t i = 0; i < count; ++i) open_[static_cast<std::size_t>(again_[i])] = 1;
    for (std::size_t i = 0; i < count; ++i) searchFrom(again_[i]);
}

}  // namespace roevo
