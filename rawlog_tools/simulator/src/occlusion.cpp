#include "occlusion.h"

#include <algorithm>
#include <array>

#include "intersect.h"

namespace roevo::simulator {
namespace {

constexpr int kLeafSize = 3;

bool crossesBox(const Eigen::Vector3d& low, const Eigen::Vector3d& high, const Eigen::Vector3d& from,
                const Eigen::Vector3d& inverse_way) {
    double enter = 0, leave = 1;
    for (int axis = 0; axis < 3; ++axis) {
        const double a = (low[axis] - from[axis]) * inverse_way[axis],
                     b = (high[axis] - from[axis]) * inverse_way[axis];
        enter = std::max(enter, std::min(a, b));
        leave = std::min(leave, std::max(a, b));
    }
    return enter <= leave;
}

}  // namespace

Occlusion::Occlusion(const Scene& scene) {
    for (const Primitive& primitive : scene.primitives) {
        if (!primitive.casts_shadow || primitive.motion >= 0 || !primitive.visible) continue;
        const double wide = primitive.shape == Shape::kCylinder ? std::max(1., primitive.taper) : 1;
        const double thick = primitive.shape == Shape::kQuad ? 0 : 1;
        const Eigen::Vector3d half = primitive.half_size.cwiseProduct(Eigen::Vector3d(wide, wide, thick));
        const Eigen::Vector3d reach =
            primitive.R_world_object.cwiseAbs() * half + Eigen::Vector3d::Constant(1e-6);
        casters_.push_back(
            {primitive.half_size.cwiseInverse().asDiagonal() * primitive.R_world_object.transpose(),
             primitive.centre, primitive.centre - reach, primitive.centre + reach, primitive.shape,
             primitive.taper});
    }
    if (!casters_.empty()) build(0, static_cast<int>(casters_.size()));
}

int Occlusion::build(int first, int count) {
    const int index = static_cast<int>(nodes_.size());
    nodes_.emplace_back();
    Node node;
    node.low.setConstant(1e300);
    node.high.setConstant(-1e300);
    for (int i = first; i < first + count; ++i) {
        node.low = node.low.cwiseMin(casters_[static_cast<size_t>(i)].low);
        node.high = node.high.cwiseMax(casters_[static_cast<size_t>(i)].high);
    }
    if (count <= kLeafSize) {
        node.first = first;
        node.count = count;
    } else {
        int axis = 0;
        (node.high - node.low).maxCoeff(&axis);
        const auto begin = casters_.begin() + first;
        std::nth_element(begin, begin + count / 2, begin + count, [axis](const Caster& a, const Caster& b) {
            return a.centre[axis] < b.centre[axis];
        });
        build(first, count / 2);
        node.right = build(first + count / 2, count - count / 2);
    }
    nodes_[static_cast<size_t>(index)] = node;
    return index;
}

std::vector<const Occlusion::Caster*> Occlusion::near(const Eigen::Vector3d& from,
                                                      const Eigen::Vector3d& middle, double radius) const {
    std::vector<const Caster*> found;
    if (nodes_.empty()) return found;
    const Eigen::Vector3d inverse_way = middle.cwiseInverse(), margin = Eigen::Vector3d::Constant(radius);
    std::array<int, 64> stack;
    size_t height = 0;
    stack[height++] = 0;
    while (height > 0) {
        const int index = stack[--height];
        const Node& node = nodes_[static_cast<size_t>(index)];
        if (!crossesBox(node.low - margin, node.high + margin, from, inverse_way)) continue;
        if (node.right >= 0) {
            stack[height++] = node.right;
            stack[height++] = index + 1;
            continue;
        }
        for (int i = node.first; i < node.first + node.count; ++i) {
            const Caster& caster = casters_[static_cast<size_t>(i)];
            if (crossesBox(caster.low - margin, caster.high + margin, from, inverse_way))
                found.push_back(&caster);
        }
    }
    return found;
}

int Occlusion::open(const Eigen::Vector3d& from, const std::vector<Eigen::Vector3d>& ways,
                    const Eigen::Vector3d& middle, double radius) const {
    std::vector<const Caster*> casters = near(from, middle, radius);
    int open = 0;
    for (const Eigen::Vector3d& way : ways) {
        const Eigen::Vector3d inverse_way = way.cwiseInverse();
        const auto blocks = [&](const Caster* caster) {
            UnitHit hit;
            return crossesBox(caster->low, caster->high, from, inverse_way) &&
                   intersectUnit(caster->shape, caster->taper,
                                 caster->unit_from_world * (from - caster->centre),
                                 caster->unit_from_world * way, 1e-6, 1 - 1e-6, hit);
        };
        const auto blocker = std::find_if(casters.begin(), casters.end(), blocks);
        if (blocker == casters.end())
            ++open;
        else
            std::iter_swap(blocker, casters.begin());  // it most likely blocks the next one, too
    }
    return open;
}

}  // namespace roevo::simulator
