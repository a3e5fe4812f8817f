#include "edges/organize.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>

#include "roevo/types.h"

namespace roevo {
namespace {

/// The eight neighbours of a pixel, side neighbours before diagonal ones: the nearer pixel is the better
/// successor.
constexpr int kStepX[8] = {-1, 1, 0, 0, -1, 1, -1, 1};
constexpr int kStepY[8] = {0, 0, -1, 1, -1, -1, 1, 1};

/// The 3x3 pixels of a mask (0 or 1) around p as bits: columns from the right to the left, each from the top.
inline unsigned neighbourhood(const std::uint8_t* mask, std::int32_t p, int width) {
    const auto three = [&](std::int32_t middle) {
        std::uint32_t word;
        std::memcpy(&word, mask + middle - 1, sizeof word);
        return word;
    };
    const std::uint32_t columns = (three(p - width) | three(p) << 1 | three(p + width) << 2) & 0x070707U;
    return columns * ((1U << 22) | (1U << 11) | 1U) >> 16 & 511U;  // moves the columns together
}

constexpr unsigned bitOf(int x, int y) {
    return 1U << (3 * (1 - x) + y + 1);
}

/// Of a neighbour's neighbourhood: the bit of the pixel that it is a neighbour of.
constexpr unsigned backFrom(unsigned step) {
    return bitOf(-kStepX[step], -kStepY[step]);
}

struct Neighbours {
    std::uint32_t first = 0;  ///< numbers of the neighbours that are there, four bits each, the first lowest
    std::uint8_t count = 0;
    bool l = false;  ///< there are some to its left or right, and some above or below
    bool t = false;  ///< there are three of the four at its sides: it is an L, too
};

constexpr std::array<Neighbours, 512> tableOfNeighbours() {
    std::array<Neighbours, 512> table{};
    for (unsigned bits = 0; bits < 512; ++bits) {
        Neighbours& entry = table[bits];
        int sides = 0;
        for (int k = 0; k < 8; ++k) {
            if ((bits & bitOf(kStepX[k], kStepY[k])) == 0) continue;
            entry.first |= static_cast<std::uint32_t>(k) << (4 * entry.count);
            ++entry.count;
            sides += k < 4 ? 1 : 0;
        }
        entry.t = sides >= 3;
        entry.l = (bits & (bitOf(-1, 0) | bitOf(1, 0))) != 0 && (bits & (bitOf(0, -1) | bitOf(0, 1))) != 0;
    }
    return table;
}

constexpr std::array<Neighbours, 512> kNeighbours = tableOfNeighbours();

}  // namespace

void adjustAdjacency(EdgeMask& edges) {
    const int width = edges.mask.cols;
    auto* mask = edges.mask.ptr<std::uint8_t>();
    const auto around = [&](std::int32_t p) -> const Neighbours& {
        return kNeighbours[neighbourhood(mask, p, width)];
    };
    // Taking pixels away makes no new pattern: those that may go are known beforehand
    auto& corners = edges.corners;
    corners.clear();
    for (const std::int32_t p : edges.pixels)
        if (around(p).l) corners.push_back(p);
    // T first: its centre has to go while all three arms are there; the arms stay connected through
    // diagonals.
    for (const std::int32_t p : corners)
        if (around(p).t) mask[p] = 0;
    // L: a horizontal and a vertical neighbour, which touch each other by a diagonal. Looked at from the
    // corner.
    for (const std::int32_t p : corners)
        if (around(p).l) mask[p] = 0;
    std::size_t kept = 0;
    for (const std::int32_t p : edges.pixels) {
        edges.pixels[kept] = p;
        kept += mask[p];
    }
    edges.pixels.resize(kept);
}

void EdgeOrganizer::growCluster(const Gradient& gradient, const std::uint8_t* mask, std::int32_t seed,
                                float min_cosine) {
    const auto* gx = gradient.gx.ptr<std::int16_t>();
    const auto* gy = gradient.gy.ptr<std::int16_t>();
    std::int32_t offset[8];
    for (int k = 0; k < 8; ++k) offset[k] = kStepY[k] * width_ + kStepX[k];
    std::uint8_t* open = open_.data();
    Node* tree = tree_.data();
    tree[0] = {seed, -1, 0, 0, -1, -1, 0};
    open[seed] = 0;
    std::size_t nodes = 1;
    for (std::size_t i = 0; i < nodes; ++i) {
        const std::int32_t p = tree[i].pixel;
        // Of the mask, which does not change, and not of what is open: words of bytes just written would have
        // to wait for them
        const unsigned bits = neighbourhood(mask, p, width_) & ~tree[i].parent_bit;
        const auto px = static_cast<float>(gx[p]), py = static_cast<float>(gy[p]);
        const float least = min_cosine * min_cosine * (px * px + py * py);
        std::uint32_t next = kNeighbours[bits].first;
        for (int left = kNeighbours[bits].count; left > 0; --left, next >>= 4) {
            const unsigned step = next & 7;
            const std::int32_t q = p + offset[step];
            if (open[q] == 0) continue;
            const auto qx = static_cast<float>(gx[q]), qy = static_cast<float>(gy[q]);
            const float dot = px * qx + py * qy;
            if (dot < 0 || dot * dot < least * (qx * qx + qy * qy)) continue;
            open[q] = 0;
            tree[nodes++] = {q, static_cast<std::int32_t>(i), 0, 0, -1, -1, backFrom(step)};
        }
    }
    nodes_ = nodes;
}

std::size_t EdgeOrganizer::appendLongestRoute() {
    // Children come after their parents in the tree, so one backward pass knows the two longest routes below
    // each node; the best pair meets where their sum is greatest.
    Node* tree = tree_.data();
    std::size_t top = 0;
    std::int32_t best = -1;
    for (std::size_t i = nodes_; i-- > 0;) {
        const Node& node = tree[i];
        if (const std::int32_t length = node.depth1 + node.depth2 + 1; length > best) {
            best = length;
            top = i;
        }
        if (node.parent < 0) continue;
        Node& parent = tree[node.parent];
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
    // From the end of the one route up to where they meet, and down the other. Their nodes are used.
    const auto length = static_cast<std::size_t>(best);
    const std::size_t first = points_.size();
    points_.resize(first + length);
    const auto use = [&](std::int32_t node, std::int32_t& point) {
        point = tree[node].pixel;
        tree[node].pixel = -1;
        return tree[node].child1;
    };
    std::int32_t* middle = points_.data() + first + tree[top].depth1;
    std::int32_t* point = middle;
    const std::int32_t other = tree[top].child2;
    for (auto i = static_cast<std::int32_t>(top); i >= 0;) i = use(i, *point--);
    point = middle;
    for (std::int32_t i = other; i >= 0;) i = use(i, *++point);
    return length;
}

void EdgeOrganizer::searchFrom(const Gradient& gradient, const std::uint8_t* mask, std::int32_t seed,
                               float min_cosine, std::size_t min_length, std::vector<std::int32_t>& begin) {
    if (at(open_, seed) == 0) return;
    growCluster(gradient, mask, seed, min_cosine);
    if (nodes_ < min_length) return;
    const std::size_t length = appendLongestRoute();
    if (length < min_length) {
        points_.resize(points_.size() - length);
        return;
    }
    begin.push_back(static_cast<std::int32_t>(points_.size()));
    if (length == nodes_) return;
    for (std::size_t i = 0; i < nodes_; ++i)
        if (tree_[i].pixel >= 0) again_.push_back(tree_[i].pixel);
}

void EdgeOrganizer::organize(const Gradient& gradient, const EdgeMask& edges, double angle_deg,
                             int min_length, OrganizedEdges& out) {
    width_ = edges.mask.cols;
    if (open_.size() != edges.mask.total()) open_.assign(edges.mask.total(), 0);
    if (tree_.size() < edges.pixels.size()) tree_.resize(edges.pixels.size());
    for (const std::int32_t p : edges.pixels) at(open_, p) = 1;
    const auto min_cosine = static_cast<float>(std::cos(angle_deg * kDegree));
    const auto least = static_cast<std::size_t>(std::max(1, min_length));
    const auto* mask = edges.mask.ptr<std::uint8_t>();
    again_.clear();
    points_.clear();
    out.begin.assign(1, 0);
    for (const std::int32_t seed : edges.pixels)
        searchFrom(gradient, mask, seed, min_cosine, least, out.begin);
    // Branches left out are opened together and searched once; what is left out then is dropped, which keeps
    // the work linear.
    const std::size_t count = again_.size();
    for (std::size_t i = 0; i < count; ++i) at(open_, again_[i]) = 1;
    for (std::size_t i = 0; i < count; ++i)
        searchFrom(gradient, mask, again_[i], min_cosine, least, out.begin);

    out.resize(points_.size());
    out.numberPoints();
    kernels::best().refine(
        gradient.view(), points_.data(), points_.size(),
        {out.x.data(), out.y.data(), out.gradient_x.data(), out.gradient_y.data(), out.strength.data()});
}

}  // namespace roevo
