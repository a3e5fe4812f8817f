#include "recordings/bags/bag_file.h"

#include <algorithm>
#include <stdexcept>

#include "input/excerpt.h"
#include "recordings/bags/image_messages.h"
#include "recordings/bags/realsense.h"

namespace roevo {

namespace {

const StoredMessage& messageOf(const StoredTopic& topic, std::size_t i) {
    if (i >= topic.messages.size())
        throw std::runtime_error(excerpt(topic.name) + " has no message " + std::to_string(i + 1));
    return topic.messages[i];
}

}  // namespace

std::string BagTopic::toText() const {
    return excerpt(name) + " (" + excerpt(type) + (encoding.empty() ? "" : ", " + excerpt(encoding)) + ", " +
           std::to_string(messages) + (messages == 1 ? " message)" : " messages)");
}

BagFile::BagFile(const std::string& path) : path_(path), store_(openMessageStore(path)) {
    for (const StoredTopic& stored : store_->topics()) {
        if (&stored != &this->stored(stored.name)) continue;
        BagTopic& topic = topics_.emplace_back();
        topic.name = stored.name;
        topic.type = stored.type;
        topic.messages = isReadType(stored.type) ? stored.messages.size() : stored.count;
    }
    std::stable_sort(topics_.begin(), topics_.end(),
                     [](const BagTopic& a, const BagTopic& b) { return a.name < b.name; });
    for (BagTopic& topic : topics_) {
        try {
            if (topic.messages > 0) describe(topic);
        } catch (const std::runtime_error&) {
            // A first message that cannot be read: its topic stays without encoding
        }
        realsense::describe(topic);
    }
}

void BagFile::describe(BagTopic& topic) const {
    if (topic.isRaw()) {
        const ImageMessage image = parseImage(message(topic.name, 0));
        topic.encoding = image.encoding;
        topic.frame_id = image.header.frame_id;
        topic.width = image.width, topic.height = image.height;
        topic.kind = kindOf(image.encoding);
    } else if (topic.isImage()) {
        const CompressedImageMessage image = parseCompressedImage(message(topic.name, 0));
        topic.encoding = image.format;
        topic.frame_id = image.header.frame_id;
        topic.kind = kindOf(image);
    } else if (topic.isCameraInfo()) {
        topic.frame_id = parseCameraInfo(message(topic.name, 0)).header.frame_id;
    }
}

const BagTopic* BagFile::find(const std::string& topic) const {
    const auto found = std::find_if(topics_.begin(), topics_.end(),
                                    [&](const BagTopic& candidate) { return candidate.name == topic; });
    return found == topics_.end() ? nullptr : &*found;
}

const StoredTopic& BagFile::stored(const std::string& topic) const {
    const StoredTopic* found = nullptr;
    for (const StoredTopic& candidate : store_->topics())
        if (candidate.name == topic && (found == nullptr || candidate.count > found->count))
            found = &candidate;
    if (found == nullptr) throw std::runtime_error("no topic " + excerpt(topic));
    return *found;
}

MessageBytes BagFile::message(const std::string& topic, std::size_t i) const {
    const StoredTopic& from = stored(topic);
    return {store_->read(messageOf(from, i)), from.wire()};
}

double BagFile::stamp(const std::string& topic, std::size_t i) const {
    const StoredTopic& from = stored(topic);
    const StoredMessage& message = messageOf(from, i);
    const std::size_t known = std::min<std::size_t>(message.head.size(), message.size);
    return parseStamp({std::string_view(message.head.data(), known), from.wire()});
}

std::string toText(const std::vector<BagTopic>& topics) {
    std::string text;
    for (const BagTopic& topic : topics) text += (text.empty() ? "" : ", ") + topic.toText();
    return text.empty() ? "none" : text;
}

}  // namespace roevo
