#pragma once
#include <vector>

#include "intersect.h"
#include "roevo_simulator/scene.h"

namespace roevo::simulator {

/// Camera pose and scene time of one moment.
struct Instant {
    Pose T_world_camera = Pose::Identity();
    double seconds = 0;
};

/// Where a moving primitive is.
Eigen::Vector3d centreAt(const Scene& scene, const Primitive& primitive, double seconds);

/// Rectangle of ideal image coordinates x/z, y/z.
struct ImageRect {
    double x0 = 1e300, x1 = -1e300, y0 = 1e300, y1 = -1e300;
    bool overlaps(const ImageRect& other) const {
        return x0 <= other.x1 && other.x0 <= x1 && y0 <= other.y1 && other.y0 <= y1;
    }
    void include(double x, double y) {
        x0 = std::min(x0, x), x1 = std::max(x1, x), y0 = std::min(y0, y), y1 = std::max(y1, y);
    }
};

struct ViewHit {
    double depth = 0;  ///< along the optical axis
    int primitive = -1;
    UnitHit unit;
    Eigen::Vector3d unit_point;
};

/// The scene prepared for one moment: primitives in front of the camera sorted by their least depth, each
/// with the map from image rays to its unit coordinates. A ray is (x, y, 1), so the ray parameter is the
/// depth itself.
class View {
  public:
    View(const Scene& scene, const Instant& instant);

    /// Indices (into this view, front to back) of `among` that may be seen inside the rectangle.
    void select(const ImageRect& rect, const std::vector<int>& among, std::vector<int>& selected) const;
    const std::vector<int>& all() const { return all_; }

    bool trace(double x, double y, const std::vector<int>& candidates, ViewHit& hit) const;

    const Instant& instant() const { return instant_; }

    /// What moving and resting primitives do to the straight way from `point` to `light`.
    struct Blocking {
        bool moving = false, resting = false;
    };
    Blocking blocking(const Eigen::Vector3d& point, const Eigen::Vector3d& light) const;

  private:
    struct Item {
        Eigen::Matrix3d unit_from_ray;
        Eigen::Vector3d unit_origin;
        ImageRect rect;
        double least_depth = 0;
        int primitive = 0;
        Shape shape = Shape::kBox;
        double taper = 1;
    };
    struct Caster {
        Eigen::Matrix3d unit_from_world;
        Eigen::Vector3d centre;
        Shape shape;
        double taper;
        bool moving;
    };
    Instant instant_;
    std::vector<Item> items_;
    std::vector<int> all_;
    std::vector<Caster> casters_;
};

}  // namespace roevo::simulator
