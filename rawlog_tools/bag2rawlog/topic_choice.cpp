#include "bag2rawlog/topic_choice.h"

#include <algorithm>
#include <functional>
#include <stdexcept>

#include "bag2rawlog/ros_image.h"
#include "input/excerpt.h"

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
    if (topic->type == "sensor_msgs/CompressedImage")
        throw std::runtime_error(
            name + " is compressed: write it as raw images first (rosrun image_transport republish)");
    if (topic->type != type)
        throw std::runtime_error(name + " is a " + topic->type + ", wanted is a " + type);
    if (topic->messages == 0) throw std::runtime_error(bag.path() + ": topic " + name + " has no messages");
    return *topic;
}

/// The one that is left, or an error that says what there is.
std::string only(const BagFile& bag, const Topics& candidates, const std::string& what, const char* option) {
    if (candidates.size() == 1) return candidates.front().name;
    if (!candidates.empty())
        throw std::runtime_error(bag.path() + " has several topics with " + what + ", choose one by " +
                                 option + ": " + toText(candidates));
    const Topics images = select(bag.topics(), [](const BagTopic& t) { return contains(t.type, "Image"); });
    const bool all_compressed =
        !images.empty() &&
        std::all_of(images.begin(), images.end(), [](const BagTopic& t) { return !t.isImage(); });
    throw std::runtime_error(
        bag.path() + " has no topic with " + what +
        (all_compressed
             ? "; its images are compressed: write them as raw images first (rosrun image_transport "
               "republish); it has "
             : "; it has ") +
        toText(bag.topics()));
}

void checkEncoding(const BagTopic& topic, bool usable, const char* what) {
    if (!usable)
        throw std::runtime_error(topic.name + " has encoding " + excerpt(topic.encoding) + ", which is no " +
                                 what);
}

std::string chooseColour(const BagFile& bag) {
    const Topics in_colour =
        select(bag.topics(), [](const BagTopic& t) { return t.isImage() && isColourEncoding(t.encoding); });
    if (!in_colour.empty()) return only(bag, in_colour, "colour images", "--colour-topic");
    const Topics grey =
        select(bag.topics(), [](const BagTopic& t) { return t.isImage() && isGreyEncoding(t.encoding); });
    return only(bag, grey, "colour images (rgb8, bgr8) or grey ones (mono8)", "--colour-topic");
}

std::string chooseDepth(const BagFile& bag, const BagTopic& colour) {
    const Topics depth =
        select(bag.topics(), [](const BagTopic& t) { return t.isImage() && isDepthEncoding(t.encoding); });
    const Topics aligned = select(depth, [&](const BagTopic& t) { return t.frame_id == colour.frame_id; });
    return only(bag, aligned.size() == 1 ? aligned : depth, "depth images (16UC1, 32FC1)", "--depth-topic");
}

/// The camera_info that belongs to images: beside them by name, or else the only one in their frame.
std::string infoOf(const BagFile& bag, const BagTopic& images) {
    const BagTopic* beside = bag.find(images.name.substr(0, images.name.rfind('/') + 1) + "camera_info");
    if (beside != nullptr && beside->isCameraInfo() && beside->messages > 0) return beside->name;
    const Topics same_frame = select(bag.topics(), [&](const BagTopic& t) {
        return t.isCameraInfo() && !t.frame_id.empty() && t.frame_id == images.frame_id;
    });
    return same_frame.size() == 1 ? same_frame.front().name : "";
}

}  // namespace

BagTopicNames chooseTopics(const BagFile& bag, BagTopicNames names) {
    if (names.colour.empty()) names.colour = chooseColour(bag);
    const BagTopic& colour = named(bag, names.colour, "sensor_msgs/Image");
    checkEncoding(colour, isColourEncoding(colour.encoding) || isGreyEncoding(colour.encoding),
                  "8-bit colour or grey image (rgb8, bgr8, rgba8, bgra8, mono8): convert it first");

    if (names.depth.empty()) names.depth = chooseDepth(bag, colour);
    const BagTopic& depth = named(bag, names.depth, "sensor_msgs/Image");
    // Some older drivers call their millimetres mono16; that it is depth must be said by name
    checkEncoding(depth, isDepthEncoding(depth.encoding) || depth.encoding == "mono16",
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
