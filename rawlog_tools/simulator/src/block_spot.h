#pragma once
#include "scene_builder.h"

namespace roevo::simulator::block {

using V = Eigen::Vector3d;

/// Where a piece stands in the scene `block`: x leads on along the corridor, y to the block in the middle, z
/// up. What is described in these axes once can stand at several places and look the same at each.
class Spot {
  public:
    /// @param quarters  quarter turns from the world's x to the way on
    Spot(SceneBuilder& builder, const V& origin, int quarters);

    /// The spot `x` metres further on.
    Spot along(double x) const;
    V toWorld(const V& local) const { return origin_ + turn_ * local; }

    Primitive& box(const V& low, const V& high, int material) const;
    Primitive& cylinder(const V& foot, double radius, double height, int material, double taper = 1) const;
    Primitive& rod(const V& from, const V& to, double radius, int material) const;
    Primitive& ellipsoid(const V& centre, const V& half_size, int material) const;
    Primitive& sheet(const V& centre, double width, double height, const V& normal, int material) const;

  private:
    SceneBuilder* builder_;
    V origin_;
    Eigen::Matrix3d turn_;
};

}  // namespace roevo::simulator::block
