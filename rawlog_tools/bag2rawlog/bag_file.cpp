#include "bag2rawlog/bag_file.h"

#include <console_bridge/console.h>
#include <rosbag/view.h>
#include <sensor_msgs/CameraInfo.h>
#include <sensor_msgs/Image.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <map>
#include <stdexcept>

#include "input/excerpt.h"
#include "input/regular_file.h"

namespace fs = std::filesystem;

namespace roevo {
namespace {

/// What is wrong with a file that cannot be a ROS 1 bag, or "".
std::string faultOf(const std::string& path) {
    constexpr char kRos2[] =
        " is a ROS 2 recording: turn it into a ROS 1 bag first (rosbags-convert of the Python package "
        "rosbags)";
    if (!fs::exists(path)) return path + ": no such file";
    if (fs::is_directory(path))
        return path + (fs::exists(fs::path(path) / "metadata.yaml") ? kRos2 : " is a folder, not a bag");
    if (const std::string other = otherThanFile(path); !other.empty())
        return "cannot read " + path + ": " + other;
    std::ifstream in(path, std::ios::binary);
    std::string head(16, '\0');
    if (!in) return path + ": cannot be read (no permission?)";
    in.read(head.data(), static_cast<std::streamsize>(head.size()));
    head.resize(static_cast<std::size_t>(in.gcount()));
    if (head.rfind("#ROSBAG V", 0) == 0) return "";
    if (head.rfind("SQLite format 3", 0) == 0 || head.rfind("\x89MCAP", 0) == 0) return path + kRos2;
    return path + " is not a ROS bag (it does not begin with #ROSBAG)";
}

}  // namespace

std::string BagTopic::toText() const {
    return excerpt(name) + " (" + excerpt(type) + (encoding.empty() ? "" : ", " + excerpt(encoding)) + ", " +
           std::to_string(messages) + (messages == 1 ? " message)" : " messages)");
}

BagFile::BagFile(const std::string& path) : path_(path) {
    if (const std::string fault = faultOf(path); !fault.empty()) throw std::runtime_error(fault);
    console_bridge::setLogLevel(console_bridge::CONSOLE_BRIDGE_LOG_NONE);  // we report ourselves
    try {
        bag_.open(path, rosbag::bagmode::Read);
        listTopics();
    } catch (const rosbag::BagUnindexedException&) {
        throw std::runtime_error(path +
                                 " has no index, its recording was not ended: run `rosbag reindex` on it");
    } catch (const std::exception& error) {
        throw std::runtime_error(path + ": truncated or damaged bag (" + error.what() +
                                 "): copy it again, or run `rosbag reindex` on it");
    }
    if (topics_.empty()) throw std::runtime_error(path + ": the bag is empty");
}

void BagFile::listTopics() {
    std::map<std::string, BagTopic> found;
    rosbag::View view(bag_);
    for (const rosbag::ConnectionInfo* connection : view.getConnections()) {
        BagTopic& topic = found[connection->topic];  // one topic may have several publishers
        topic.name = connection->topic;
        topic.type = connection->datatype;
    }
    for (auto& [name, topic] : found) {
        rosbag::View messages_of(bag_, rosbag::TopicQuery(name));
        topic.messages = messages_of.size();
        if (topic.messages > 0 && (topic.isImage() || topic.isCameraInfo())) {
            const rosbag::View::iterator begin = messages_of.begin();  // owns the message that it points to
            const rosbag::MessageInstance& first = *begin;
            if (const auto image = first.instantiate<sensor_msgs::Image>()) {
                topic.encoding = image->encoding;
                topic.frame_id = plainFrameId(image->header.frame_id);
            } else if (const auto info = first.instantiate<sensor_msgs::CameraInfo>()) {
                topic.frame_id = plainFrameId(info->header.frame_id);
            }
        }
        topics_.push_back(topic);
    }
}

const BagTopic* BagFile::find(const std::string& topic) const {
    const auto found = std::find_if(topics_.begin(), topics_.end(),
                                    [&](const BagTopic& candidate) { return candidate.name == topic; });
    return found == topics_.end() ? nullptr : &*found;
}

std::vector<rosbag::MessageInstance> BagFile::messages(const std::string& topic) const {
    std::vector<rosbag::MessageInstance> all;
    rosbag::View view(bag_, rosbag::TopicQuery(topic));
    all.reserve(view.size());
    for (const rosbag::MessageInstance& message : view) all.push_back(message);
    return all;
}

std::string plainFrameId(const std::string& frame_id) {
    return frame_id.substr(0, 1) == "/" ? frame_id.substr(1) : frame_id;
}

std::string toText(const std::vector<BagTopic>& topics) {
    std::string text;
    for (const BagTopic& topic : topics) text += (text.empty() ? "" : ", ") + topic.toText();
    return text.empty() ? "none" : text;
}

}  // namespace roevo
