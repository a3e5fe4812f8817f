#include "bag2rawlog/static_transforms.h"

#include <tf2_msgs/TFMessage.h>

#include <cmath>

namespace roevo {

StaticTransforms::StaticTransforms(const BagFile& bag) {
    for (const rosbag::MessageInstance& message : bag.messages("/tf_static")) {
        const auto transforms = message.instantiate<tf2_msgs::TFMessage>();
        if (!transforms) continue;
        for (const auto& stamped : transforms->transforms) {
            const auto& t = stamped.transform.translation;
            const auto& q = stamped.transform.rotation;
            const Eigen::Quaterniond rotation(q.w, q.x, q.y, q.z);
            const Eigen::Vector3d translation(t.x, t.y, t.z);
            if (!translation.allFinite() || !(std::abs(rotation.norm() - 1) < 1e-2)) continue;
            Link link{plainFrameId(stamped.header.frame_id), Pose::Identity()};
            link.T_parent_child.setRotation(rotation.normalized().toRotationMatrix());
            link.T_parent_child.translation() = translation;
            parents_[plainFrameId(stamped.child_frame_id)] = link;
        }
    }
}

std::map<std::string, Pose> StaticTransforms::ancestorsOf(std::string frame) const {
    std::map<std::string, Pose> out;
    Pose T_ancestor_frame = Pose::Identity();
    while (out.emplace(frame, T_ancestor_frame).second) {  // ends in a loop of frames, too
        const auto link = parents_.find(frame);
        if (link == parents_.end()) break;
        T_ancestor_frame = link->second.T_parent_child * T_ancestor_frame;
        frame = link->second.parent;
    }
    return out;
}

std::optional<Pose> StaticTransforms::find(const std::string& a, const std::string& b) const {
    const auto above_a = ancestorsOf(a);
    for (const auto& [frame, T_frame_b] : ancestorsOf(b)) {
        const auto common = above_a.find(frame);
        if (common != above_a.end()) return common->second.inverse() * T_frame_b;
    }
    return std::nullopt;
}

}  // namespace roevo
