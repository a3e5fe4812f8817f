#include "recordings/bags/frame_tree.h"

#include <stdexcept>

#include "recordings/bags/realsense.h"

namespace roevo {
namespace {

constexpr double kSame = 1e-4;  // m, and of a rotation's entries: what a fixed transform may differ by

}  // namespace

FrameTree FrameTree::ofStatic(const BagFile& bag) {
    FrameTree tree;
    tree.addTopic(bag, "/tf_static", true);
    tree.addRealSense(bag);
    return tree;
}

FrameTree FrameTree::ofAll(const BagFile& bag) {
    FrameTree tree = ofStatic(bag);
    tree.addTopic(bag, "/tf", false);
    return tree;
}

void FrameTree::addTopic(const BagFile& bag, const std::string& name, bool fixed) {
    const BagTopic* topic = bag.find(name);
    if (topic == nullptr) return;
    for (std::size_t i = 0; i < bag.count(name); i++) {
        std::vector<TransformMessage> transforms;
        try {
            transforms = parseTransforms(bag.message(name, i));
        } catch (const std::runtime_error&) {
            continue;  // another type, or damaged; the frames are told of again, or are missed by name
        }
        for (const TransformMessage& transform : transforms) {
            if (!transform.T_parent_child) continue;
            const Link link{transform.parent, *transform.T_parent_child};
            const auto [place, added] = parents_.emplace(transform.child, link);
            if (added) continue;
            if (fixed)
                place->second = link;  // the latest holds
            else if (place->second.parent != link.parent ||
                     !(place->second.T_parent_child.matrix() - link.T_parent_child.matrix()).isZero(kSame))
                place->second.moves = true;
        }
    }
}

void FrameTree::addRealSense(const BagFile& bag) {
    for (const BagTopic& topic : bag.topics()) {
        const std::string stream = realsense::transformStream(topic.name);
        if (stream.empty() || topic.type != "geometry_msgs/Transform" || topic.messages == 0) continue;
        // It maps points of the reference into the stream's frame
        const auto T_stream_reference = parseTransform(bag.message(topic.name, 0));
        if (T_stream_reference)
            parents_.emplace(stream,
                             Link{realsense::referenceFrame(topic.name), T_stream_reference->inverse()});
    }
}

std::map<std::string, Pose> FrameTree::ancestorsOf(std::string frame) const {
    std::map<std::string, Pose> out;
    Pose T_ancestor_frame = Pose::Identity();
    while (out.emplace(frame, T_ancestor_frame).second) {  // ends in a loop of frames, too
        const auto link = parents_.find(frame);
        if (link == parents_.end() || link->second.moves) break;
        T_ancestor_frame = link->second.T_parent_child * T_ancestor_frame;
        frame = link->second.parent;
    }
    return out;
}

std::optional<Pose> FrameTree::find(const std::string& a, const std::string& b) const {
    const auto above_a = ancestorsOf(a);
    for (const auto& [frame, T_frame_b] : ancestorsOf(b)) {
        const auto common = above_a.find(frame);
        if (common != above_a.end()) return common->second.inverse() * T_frame_b;
    }
    return std::nullopt;
}

}  // namespace roevo
