#pragma once
#include <vector>

#include "roevo_simulator/scene.h"

namespace roevo::simulator {

/// Tells whether a straight way is blocked by resting primitives that cast shadows: a tree of bounding boxes.
class Occlusion {
  public:
    explicit Occlusion(const Scene& scene);

    /// Whether anything lies between `from` and `from + way`, both ends excluded.
    bool blocked(const Eigen::Vector3d& from, const Eigen::Vector3d& way) const;

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

    std::vector<Caster> casters_;
    std::vector<Node> nodes_;
};

}  // namespace roevo::simulator
