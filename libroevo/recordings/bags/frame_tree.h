#pragma once
#include <map>
#include <optional>
#include <string>

#include "recordings/bags/bag_file.h"
#include "roevo/types.h"

namespace roevo {

/// The tree of frames that do not move against one another, as a bag tells of it.
class FrameTree {
  public:
    /// From /tf_static, and what RealSense recordings have in its place. Unusable transforms (no unit
    /// quaternion, not finite) are left out.
    static FrameTree ofStatic(const BagFile& bag);

    /// From /tf as well, which older recordings have for everything: of it only what stays the same.
    static FrameTree ofAll(const BagFile& bag);

    /// T_a_b, or nothing when no chain of transforms joins the two frames.
    std::optional<Pose> find(const std::string& a, const std::string& b) const;

  private:
    struct Link {
        std::string parent;
        Pose T_parent_child;
        bool moves = false;
    };
    void addTopic(const BagFile& bag, const std::string& topic, bool fixed);
    void addRealSense(const BagFile& bag);
    /// The pose of `frame` in each of its ancestors, itself included.
    std::map<std::string, Pose> ancestorsOf(std::string frame) const;

    std::map<std::string, Link> parents_;  ///< by child
};

}  // namespace roevo
