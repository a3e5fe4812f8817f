#pragma once
#include <rosbag/bag.h>
#include <rosbag/message_instance.h>

#include <string>
#include <vector>

namespace roevo {

/// One topic of a bag.
struct BagTopic {
    std::string name, type;    ///< "/camera/rgb/image_color", "sensor_msgs/Image"
    std::size_t messages = 0;  ///< how many
    std::string encoding;      ///< of images: that of the first one, as ROS writes it
    std::string frame_id;      ///< of images and camera_info: that of the first one, without leading '/'

    bool isImage() const { return type == "sensor_msgs/Image"; }
    bool isCameraInfo() const { return type == "sensor_msgs/CameraInfo"; }
    std::string toText() const;  ///< "/camera/rgb/image_color (sensor_msgs/Image, rgb8, 120 messages)"
};

/// A ROS 1 bag, opened for reading.
class BagFile {
  public:
    /// @throws std::runtime_error with one line: no such file, a ROS 2 bag, no bag at all, truncated or
    /// damaged.
    explicit BagFile(const std::string& path);

    const std::string& path() const { return path_; }
    const std::vector<BagTopic>& topics() const { return topics_; }  ///< in order of name
    const BagTopic* find(const std::string& topic) const;            ///< null when the bag has no such topic

    /// All messages of a topic, in the order of their recording; they are read from the file when they are
    /// looked into, and refer to this object.
    std::vector<rosbag::MessageInstance> messages(const std::string& topic) const;

  private:
    void listTopics();

    std::string path_;
    rosbag::Bag bag_;
    std::vector<BagTopic> topics_;
};

/// A frame's name without the leading '/' of older recordings.
std::string plainFrameId(const std::string& frame_id);

/// Several topics on one line, "none" when there are none.
std::string toText(const std::vector<BagTopic>& topics);

}  // namespace roevo
