#pragma once
#include <map>
#include <optional>
#include <string>

#include "bag2rawlog/bag_file.h"
#include "roevo/types.h"

namespace roevo {

/// The tree of fixed frames that a bag's /tf_static tells of.
class StaticTransforms {
  public:
    /// Empty when the bag has no /tf_static. Unusable transforms (no unit quaternion, not finite) are left
    /// out.
    explicit StaticTransforms(const BagFile& bag);

    /// T_a_b, or nothing when no chain of transforms joins the two frames.
    std::optional<Pose> find(const std::string& a, const std::string& b) const;

    bool empty() const { return parents_.empty(); }

  private:
    struct Link {
        std::string parent;
        Pose T_parent_child;
    };
    /// The pose of `frame` in each of its ancestors, itself included.
    std::map<std::string, Pose> ancestorsOf(std::string frame) const;

    std::map<std::string, Link> parents_;  ///< by child
};

}  // namespace roevo
