#pragma once
#include <memory>
#include <string>
#include <vector>

#include "recordings/bags/message_store.h"

namespace roevo {

/// What the images of a topic are.
enum class ImageKind { kNone, kColour, kGrey, kDepth };

/// One topic of a bag.
struct BagTopic {
    std::string name, type;    ///< "/camera/rgb/image_color", "sensor_msgs/Image"
    std::size_t messages = 0;  ///< how many
    std::string encoding;      ///< of images: that of the first one, as ROS writes it
    std::string frame_id;      ///< of images and camera_info: that of the first one, without leading '/'
    ImageKind kind = ImageKind::kNone;
    std::uint32_t width = 0, height = 0;  ///< of the first image; 0 where it is compressed

    bool isImage() const { return isRaw() || type == "sensor_msgs/CompressedImage"; }
    bool isRaw() const { return type == "sensor_msgs/Image"; }
    bool isCameraInfo() const { return type == "sensor_msgs/CameraInfo"; }
    std::string toText() const;  ///< "/camera/rgb/image_color (sensor_msgs/Image, rgb8, 120 messages)"
};

/// A bag of ROS 1 or ROS 2, opened for reading. Not for two threads at a time.
class BagFile {
  public:
    /// @throws std::runtime_error as openMessageStore()
    explicit BagFile(const std::string& path);

    const std::string& path() const { return path_; }
    const std::vector<BagTopic>& topics() const { return topics_; }  ///< in order of name
    const BagTopic* find(const std::string& topic) const;            ///< null when the bag has no such topic
    const std::vector<std::string>& damage() const { return store_->damage(); }

    /// Of a topic that there is. The order is that of the recording.
    std::size_t count(const std::string& topic) const { return stored(topic).messages.size(); }
    /// Valid until the next call. @throws std::runtime_error in one line
    MessageBytes message(const std::string& topic, std::size_t i) const;
    /// The stamp in the message's header, s, without reading the rest of it. @throws as message()
    double stamp(const std::string& topic, std::size_t i) const;

  private:
    /// Of several topics of one name, which differ in their type, that with the most messages.
    const StoredTopic& stored(const std::string& topic) const;
    void describe(BagTopic& topic) const;

    std::string path_;
    std::unique_ptr<MessageStore> store_;
    std::vector<BagTopic> topics_;
};

/// Several topics on one line, "none" when there are none.
std::string toText(const std::vector<BagTopic>& topics);

}  // namespace roevo
