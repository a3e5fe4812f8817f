#pragma once
#include <array>
#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "recordings/bags/messages.h"

namespace roevo {

/// Where a message is. What the numbers mean is the store's own.
struct StoredMessage {
    std::uint64_t piece = 0, offset = 0, size = 0;
    std::uint32_t part = 0;       ///< of several files
    std::array<char, 12> head{};  ///< its first bytes: enough for parseStamp()
};

struct StoredTopic {
    std::string name, type;  ///< "/camera/rgb/image_color", "sensor_msgs/Image" (as ROS 1 writes it)
    std::string encoding;    ///< of the messages' fields: "ros1" or "cdr"
    std::size_t count = 0;   ///< of its messages
    std::vector<StoredMessage> messages;  ///< in the file's order; of types that are not read: none

    Wire wire() const { return encoding == "ros1" ? Wire::kPacked : Wire::kCdr; }
};

/// The messages of a recording, whatever file they are in. Not for two threads at a time.
class MessageStore {
  public:
    virtual ~MessageStore() = default;

    /// Valid until the next call. @throws std::runtime_error in one line
    virtual std::string_view read(const StoredMessage& message) = 0;

    const std::vector<StoredTopic>& topics() const { return topics_; }
    const std::vector<std::string>& damage() const { return damage_; }  ///< pieces left out, a line each

    /// Brings each topic's messages into the file's order, whichever connection they came by.
    void sortMessages();

  protected:
    /// The topic of that name and type, made where there is none.
    StoredTopic& topic(const std::string& name, const std::string& type, const std::string& encoding);
    void addDamage(const std::string& text);

    std::vector<StoredTopic> topics_;
    std::vector<std::string> damage_;
};

/// Whether messages of this type are read; others are only counted.
bool isReadType(const std::string& type);

/// As ROS 1 writes it: "sensor_msgs/Image" for "sensor_msgs/msg/Image".
std::string plainType(std::string type);

/// Opens a recording of ROS 1 (.bag) or ROS 2 (.db3, .mcap, or the folder of metadata.yaml with such files).
/// @throws std::runtime_error with one line: no such file, no bag at all, truncated, damaged or empty
std::unique_ptr<MessageStore> openMessageStore(const std::string& path);

/// Whether the input looks like one, by its first bytes, its name's ending or what is in the folder.
bool isBag(const std::string& path);

/// The kinds, for openMessageStore().
std::unique_ptr<MessageStore> openRos1Bag(const std::string& path);
std::unique_ptr<MessageStore> openMcap(const std::string& path);
std::unique_ptr<MessageStore> openSqliteBag(const std::string& path);
std::unique_ptr<MessageStore> openBagFolder(const std::string& folder);

bool isBagFolder(const std::string& folder);

}  // namespace roevo
