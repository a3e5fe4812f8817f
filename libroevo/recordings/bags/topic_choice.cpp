#include "recordings/bags/topic_choice.h"

#include <algorithm>
#include <functional>
#include <stdexcept>

#include "input/excerpt.h"
#include "recordings/bags/realsense.h"

namespace roevo {
namespace {

using Topics = std::vector<BagTopic>;

Topics select(const Topics& topics, const std::function<bool(const BagTopic&)>& wanted) {
    Topics out;
    std::copy_if(topics.begin(), topics.end(), std::back_inserter(out),
                 [&](const BagTopic& topic) { return topic.messages > 0 && wanted(topic); });
    return out;
}

bool contains(const std::string& text, const char* part) {
    return text.find(part) != std::string::npos;
}

/// A topic that the user named.
const BagTopic& named(const BagFile& bag, const std::string& name, const char* type) {
    const BagTopic* topic = bag.find(name);
    if (topic == nullptr)
        throw std::runtime_error(bag.path() + " has no topic " + name + "; it has " + toText(bag.topics()));
    const bool images = contains(type, "Image");
    if (images ? !topic->isImage() : topic->type != type)
        throw std::runtime_error(bag.path() + ": " + name + " is a " + excerpt(topic->type) +
                                 ", wanted is a " + type);
    if (topic->messages == 0) throw std::runtime_error(bag.path() + ": topic " + name + " has no messages");
    return *topic;
}

/// The one that is left, or an error that says what there is.
std::string only(const BagFile& bag, const Topics& candidates, const std::string& what, const char* option) {
    if (candidates.size() == 1) return candidates.front().name;
    if (!candidates.empty())
        throw std::runtime_error(bag.path() + " has several topics with " + what + ", choose one by " +
                                 option + ": " + toText(candidates));
    throw std::runtime_error(bag.path() + " has no topic with " + what + "; it has " + toText(bag.topics()));
}

void checkKind(const BagFile& bag, const BagTopic& topic, bool usable, const char* what) {
    if (!usable)
        throw std::runtime_error(bag.path() + ": " + topic.name + " has encoding " + excerpt(topic.encoding) +
                                 ", which is no " + what);
}

/// Topics of a kind; of one that was recorded both raw and compressed the raw one.
Topics imagesOf(const BagFile& bag, ImageKind kind) {
    return select(bag.topics(), [&](const BagTopic& topic) {
        const std::string base = imageTopicBase(topic.name);
        const BagTopic* raw = base == topic.name ? nullptr : bag.find(base);
        return topic.kind == kind && (raw == nullptr || !raw->isRaw() || raw->kind != kind);
    });
}

std::string chooseColour(const BagFile& bag) {
    const Topics in_colour = imagesOf(bag, ImageKind::kColour);
    if (!in_colour.empty()) return only(bag, in_colour, "colour images", "--colour-topic");
    return only(bag, imagesOf(bag, ImageKind::kGrey), "colour images (rgb8, bgr8, JPEG) or grey ones (mono8)",
                "--colour-topic");
}

std::string chooseDepth(const BagFile& bag, const BagTopic& colour) {
    const Topics depth = imagesOf(bag, ImageKind::kDepth);
    const Topics aligned = select(depth, [&](const BagTopic& t) { return t.frame_id == colour.frame_id; });
    return only(bag, aligned.size() == 1 ? aligned : depth, "depth images (16UC1, 32FC1, compressedDepth)",
                "--depth-topic");
}

/// The camera_info that belongs to images: beside them by name, or else the only one in their frame.
std::string infoOf(const BagFile& bag, const BagTopic& images) {
    const std::string base = imageTopicBase(images.name);
    for (const std::string& name :
         {base.substr(0, base.rfind('/') + 1) + "camera_info", realsense::infoTopic(images.name)}) {
        const BagTopic* beside = bag.find(name);
        if (beside != nullptr && beside->isCameraInfo() && beside->messages > 0) return name;
    }
    const Topics same_frame = select(bag.topics(), [&](const BagTopic& t) {
        return t.isCameraInfo() && !t.frame_id.empty() && t.frame_id == images.frame_id;
    });
    return same_frame.size() == 1 ? same_frame.front().name : "";
}

}  // namespace

std::string imageTopicBase(const std::string& topic) {
    const std::size_t slash = topic.rfind('/');
    if (slash == std::string::npos || slash == 0) return topic;
    const std::string last = topic.substr(slash + 1);
    return last == "compressed" || last == "compressedDepth" ? topic.substr(0, slash) : topic;
}

BagTopicNames chooseTopics(const BagFile& bag, BagTopicNames names) {
    if (names.colour.empty()) names.colour = chooseColour(bag);
    const BagTopic& colour = named(bag, names.colour, "sensor_msgs/Image");
    checkKind(bag, colour, colour.kind == ImageKind::kColour || colour.kind == ImageKind::kGrey,
              "8-bit colour or grey image (rgb8, bgr8, rgba8, bgra8, mono8, JPEG, PNG): convert it first");

    if (names.depth.empty()) names.depth = chooseDepth(bag, colour);
    const BagTopic& depth = named(bag, names.depth, "sensor_msgs/Image");
    // Some older drivers call their millimetres mono16; that it is depth must be said by name
    checkKind(bag, depth, depth.kind == ImageKind::kDepth || depth.encoding == "mono16",
              "depth image (16UC1 in millimetres or 32FC1 in metres)");

    if (names.colour_info.empty()) names.colour_info = infoOf(bag, colour);
    if (names.colour_info.empty())
        throw std::runtime_error(
            bag.path() + " has no camera_info for " + colour.name + ", choose one by --info-topic: " +
            toText(select(bag.topics(), [](const BagTopic& t) { return t.isCameraInfo(); })));
    named(bag, names.colour_info, "sensor_msgs/CameraInfo");
    if (names.depth_info.empty()) names.depth_info = infoOf(bag, depth);
    if (!names.depth_info.empty()) named(bag, names.depth_info, "sensor_msgs/CameraInfo");
    return names;
}

}  // namespace roevo
