#include "view.h"

#include <algorithm>
#include <cmath>

namespace roevo::simulator {
namespace {

constexpr double kNearestSeen = 0.02;  // metres: nothing is seen nearer than this

/// Bounds of a primitive's box in the image, its edges cut at the near plane. False: wholly behind it.
bool boundInImage(const Eigen::Matrix3d& axes, const Eigen::Vector3d& centre, ImageRect& rect,
                  double& least_depth) {
    std::array<Eigen::Vector3d, 8> corners;
    for (int i = 0; i < 8; ++i)
        corners[static_cast<size_t>(i)] =
            centre + axes * Eigen::Vector3d(i & 1 ? 1 : -1, i & 2 ? 1 : -1, i & 4 ? 1 : -1);
    bool any = false;
    least_depth = 1e300;
    for (int i = 0; i < 8; ++i) {
        const Eigen::Vector3d& a = corners[static_cast<size_t>(i)];
        if (a.z() >= kNearestSeen) {
            rect.include(a.x() / a.z(), a.y() / a.z());
            any = true;
        }
        least_depth = std::min(least_depth, a.z());
        for (int bit = 1; bit < 8; bit <<= 1) {
            const Eigen::Vector3d& b = corners[static_cast<size_t>(i ^ bit)];
            if ((a.z() < kNearestSeen) == (b.z() < kNearestSeen)) continue;
            const Eigen::Vector3d cut = a + (b - a) * ((kNearestSeen - a.z()) / (b.z() - a.z()));
            rect.include(cut.x() / kNearestSeen, cut.y() / kNearestSeen);
            any = true;
        }
    }
    return any;
}

}  // namespace

Eigen::Vector3d centreAt(const Scene& scene, const Primitive& primitive, double seconds) {
    if (primitive.motion < 0) return primitive.centre;
    const Motion& motion = scene.motions[static_cast<size_t>(primitive.motion)];
    const double angle = motion.angular_speed * seconds + motion.phase;
    return primitive.centre + std::sin(angle) * motion.amplitude_a + std::cos(angle) * motion.amplitude_b;
}

View::View(const Scene& scene, const Instant& instant) : instant_(instant) {
    const Eigen::Matrix3d R_world_camera = instant.T_world_camera.linear();
    const Eigen::Vector3d eye = instant.T_world_camera.translation();
    const bool sharp =
        std::any_of(scene.lights.begin(), scene.lights.end(), [](const Light& l) { return l.sharp_shadows; });
    for (size_t i = 0; i < scene.primitives.size(); ++i) {
        const Primitive& primitive = scene.primitives[i];
        const Eigen::Vector3d centre = centreAt(scene, primitive, instant.seconds);
        const Eigen::Matrix3d unit_from_world =
            primitive.half_size.cwiseInverse().asDiagonal() * primitive.R_world_object.transpose();
        if (sharp && primitive.casts_shadow)
            casters_.push_back(
                {unit_from_world, centre, primitive.shape, primitive.taper, primitive.motion >= 0});
        if (!primitive.visible) continue;
        const double wide = std::max(1., primitive.taper);
        const Eigen::Vector3d half = primitive.half_size.cwiseProduct(
            Eigen::Vector3d(wide, wide, primitive.shape == Shape::kQuad ? 0 : 1));
        Item item;
        const Eigen::Matrix3d axes =
            R_world_camera.transpose() * primitive.R_world_object * half.asDiagonal();
        if (!boundInImage(axes, R_world_camera.transpose() * (centre - eye), item.rect, item.least_depth))
            continue;
        item.unit_from_ray = unit_from_world * R_world_camera;
        item.unit_origin = unit_from_world * (eye - centre);
        item.primitive = static_cast<int>(i);
        item.shape = primitive.shape;
        item.taper = primitive.taper;
        items_.push_back(item);
    }
    std::stable_sort(items_.begin(), items_.end(),
                     [](const Item& a, const Item& b) { return a.least_depth < b.least_depth; });
    for (size_t i = 0; i < items_.size(); ++i) all_.push_back(static_cast<int>(i));
}

void View::select(const ImageRect& rect, const std::vector<int>& among, std::vector<int>& selected) const {
    selected.clear();
    for (const int i : among)
        if (items_[static_cast<size_t>(i)].rect.overlaps(rect)) selected.push_back(i);
}

bool View::trace(double x, double y, const std::vector<int>& candidates, ViewHit& hit) const {
    const Item* best = nullptr;
    double depth = 1e6;
    UnitHit found;
    for (const int i : candidates) {
        const Item& item = items_[static_cast<size_t>(i)];
        if (item.least_depth > depth) break;
        if (x < item.rect.x0 || x > item.rect.x1 || y < item.rect.y0 || y > item.rect.y1) continue;
        const Eigen::Vector3d d =
            item.unit_from_ray.col(0) * x + item.unit_from_ray.col(1) * y + item.unit_from_ray.col(2);
        if (!intersectUnit(item.shape, item.taper, item.unit_origin, d, kNearestSeen, depth, found)) continue;
        depth = found.t;
        hit.unit = found;
        hit.unit_point = item.unit_origin + d * depth;
        best = &item;
    }
    if (!best) return false;
    hit.depth = depth;
    hit.primitive = best->primitive;
    return true;
}

View::Blocking View::blocking(const Eigen::Vector3d& point, const Eigen::Vector3d& light) const {
    Blocking result;
    const Eigen::Vector3d way = light - point;
    UnitHit hit;
    for (const Caster& caster : casters_) {
        if (caster.moving ? result.moving : result.resting) continue;
        if (!intersectUnit(caster.shape, caster.taper, caster.unit_from_world * (point - caster.centre),
                           caster.unit_from_world * way, 1e-5, 1, hit))
            continue;
        (caster.moving ? result.moving : result.resting) = true;
    }
    return result;
}

}  // namespace roevo::simulator
