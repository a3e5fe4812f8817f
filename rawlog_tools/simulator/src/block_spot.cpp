#include "block_spot.h"

namespace roevo::simulator::block {

Spot::Spot(SceneBuilder& builder, const V& origin, int quarters) : builder_(&builder), origin_(origin) {
    // Whole numbers: walls of neighbouring spots meet without a gap.
    const V ways[] = {V::UnitX(), V::UnitY(), -V::UnitX(), -V::UnitY()};
    turn_ << ways[quarters % 4], ways[(quarters + 1) % 4], V::UnitZ();
}

Spot Spot::along(double x) const {
    Spot other = *this;
    other.origin_ = toWorld({x, 0, 0});
    return other;
}

Primitive& Spot::box(const V& low, const V& high, int material) const {
    Primitive& primitive = builder_->box(low, high, material);
    primitive.centre = toWorld(primitive.centre);
    primitive.R_world_object = turn_;
    return primitive;
}

Primitive& Spot::cylinder(const V& foot, double radius, double height, int material, double taper) const {
    Primitive& primitive = builder_->cylinder(toWorld(foot), radius, height, material, taper);
    primitive.R_world_object = turn_;
    return primitive;
}

Primitive& Spot::rod(const V& from, const V& to, double radius, int material) const {
    return builder_->rod(toWorld(from), toWorld(to), radius, material);
}

Primitive& Spot::ellipsoid(const V& centre, const V& half_size, int material) const {
    Primitive& primitive = builder_->ellipsoid(toWorld(centre), half_size, material);
    primitive.R_world_object = turn_;
    return primitive;
}

Primitive& Spot::sheet(const V& centre, double width, double height, const V& normal, int material) const {
    Primitive& primitive = builder_->sheet(centre, width, height, normal, material);
    primitive.centre = toWorld(primitive.centre);
    primitive.R_world_object = turn_ * primitive.R_world_object;
    return primitive;
}

}  // namespace roevo::simulator::block
