#include "recordings/bags/message_store.h"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <set>
#include <stdexcept>
#include <tuple>

#include "input/excerpt.h"
#include "input/regular_file.h"

namespace fs = std::filesystem;

namespace roevo {
namespace {

constexpr std::size_t kMostTopics = 10000;
constexpr std::size_t kMostDamage = 10;  // lines

std::string firstBytes(const std::string& path) {
    if (!otherThanFile(path).empty()) return {};  // a pipe might be waited for
    std::ifstream in(path, std::ios::binary);
    std::string head(16, '\0');
    in.read(head.data(), static_cast<std::streamsize>(head.size()));
    head.resize(static_cast<std::size_t>(in.gcount()));
    return head;
}

bool beginsWith(const std::string& text, const std::string& with) {
    return text.compare(0, with.size(), with) == 0;
}

constexpr char kRos1Head[] = "#ROSBAG V", kSqliteHead[] = "SQLite format 3", kMcapHead[] = "\x89MCAP";

std::unique_ptr<MessageStore> openFile(const std::string& path) {
    std::error_code fault;
    const fs::file_status status = fs::status(path, fault);
    if (status.type() == fs::file_type::not_found) throw std::runtime_error(path + ": no such file");
    if (fault) throw std::runtime_error("cannot read " + path + ": " + fault.message());
    if (fs::is_directory(status)) return openBagFolder(path);
    requireRegularInput(path);
    if (!std::ifstream(path)) throw std::runtime_error(path + ": cannot be read (no permission?)");
    const std::string head = firstBytes(path);
    if (beginsWith(head, kRos1Head)) return openRos1Bag(path);
    if (beginsWith(head, kSqliteHead)) return openSqliteBag(path);
    if (beginsWith(head, kMcapHead)) return openMcap(path);
    throw std::runtime_error(path + " is not a ROS bag (it begins neither with #ROSBAG, as those of ROS 1, " +
                             "nor as SQLite or MCAP, as those of ROS 2)");
}

}  // namespace

StoredTopic& MessageStore::topic(const std::string& name, const std::string& type,
                                 const std::string& encoding) {
    const std::string plain = plainType(type);
    const auto found = std::find_if(topics_.begin(), topics_.end(), [&](const StoredTopic& t) {
        return t.name == name && t.type == plain && t.encoding == encoding;
    });
    if (found != topics_.end()) return *found;
    if (topics_.size() == kMostTopics)
        throw std::runtime_error("more than " + std::to_string(kMostTopics) + " topics");
    StoredTopic& added = topics_.emplace_back();
    added.name = name, added.type = plain, added.encoding = encoding;
    return added;
}

void MessageStore::sortMessages() {
    const auto place = [](const StoredMessage& message) {  // piece 0 is the file itself
        return std::tuple(message.part, message.piece > 0 ? message.piece : message.offset, message.offset);
    };
    for (StoredTopic& topic : topics_)
        std::stable_sort(topic.messages.begin(), topic.messages.end(),
                         [&](const StoredMessage& a, const StoredMessage& b) { return place(a) < place(b); });
}

void MessageStore::addDamage(const std::string& text) {
    if (damage_.size() < kMostDamage) damage_.push_back(text);
}

std::string plainType(std::string type) {
    if (const std::size_t msg = type.find("/msg/"); msg != std::string::npos) type.erase(msg, 4);
    return type;
}

bool isReadType(const std::string& type) {
    static const std::set<std::string> kTypes = {
        "sensor_msgs/Image", "sensor_msgs/CompressedImage", "sensor_msgs/CameraInfo", "tf2_msgs/TFMessage",
        "tf/tfMessage",      "geometry_msgs/Transform",     "std_msgs/Float32"};
    return kTypes.count(type) > 0;
}

bool isBag(const std::string& path) {
    static const std::set<std::string> kEndings = {".bag", ".db3", ".mcap"};
    std::error_code unseen;
    if (fs::is_directory(path, unseen)) return isBagFolder(path);
    const std::string head = firstBytes(path);
    return kEndings.count(fs::path(path).extension().string()) > 0 || beginsWith(head, kRos1Head) ||
           beginsWith(head, kSqliteHead) || beginsWith(head, kMcapHead);
}

std::unique_ptr<MessageStore> openMessageStore(const std::string& path) {
    auto store = openFile(path);
    if (store->topics().empty()) throw std::runtime_error(path + ": the bag is empty");
    store->sortMessages();
    return store;
}

}  // namespace roevo
