#pragma once
#include <vector>

#include "roevo_simulator/scene.h"

namespace roevo::simulator {

/// Tells which straight ways are blocked by resting primitives that cast shadows: a tree of bounding boxes.
class Occlusion {
  public:
    explicit Occlusion(const Scene& scene);

    /// How many of these ways nothing blocks between `from` and `from + way`, both ends excluded.
    /// @param ways  each within `radius` of `middle`
    int open(const Eigen::Vector3d& from, const std::vector<Eigen::Vector3d>& ways,
             const Eigen::Vector3d& middle, double radius) const;

  private:
    struct Caster {
        Eigen::Matrix3d unit_from_world;
        Eigen::Vector3d centre, low, high;
        Shape shape;
        double taper;
    };
    struct Node {
        Eigen::Vector3d low, high;
        int first = 0, count = 0;  ///< casters of a leaf
        int right = -1;            ///< the left child follows its parent
    };
    int build(int first, int count);
    /// What may block ways that end within this radius of the one from `from` to `from + middle`.
    std::vector<const Caster*> near(const Eigen::Vector3d& from, const Eigen::Vector3d& middle,
                                    double radius) const;

    std::vector<Caster> casters_;
    std::vector<Node> nodes_;
};

}  // namespace roevo::simulator
