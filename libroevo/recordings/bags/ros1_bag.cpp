// ROS 1 bags, format 2.0: http://wiki.ros.org/Bags/Format/2.0
#include <algorithm>
#include <map>
#include <optional>
#include <stdexcept>

#include "input/excerpt.h"
#include "recordings/bags/byte_source.h"
#include "recordings/bags/chunk_cache.h"
#include "recordings/bags/message_store.h"

namespace roevo {
namespace {

constexpr std::string_view kFirstLine = "#ROSBAG V2.0\n";

enum BagOp : std::uint8_t {
    kMessageRecord = 0x02,
    kBagHeader = 0x03,
    kChunkRecord = 0x05,
    kConnection = 0x07
};

/// "name=value" fields, each with its length before it.
class Fields {
  public:
    explicit Fields(std::string_view bytes) {
        for (FieldReader in(bytes); in.left() > 0;) {
            const std::string_view field = in.blob();
            const std::size_t equals = field.find('=');
            if (equals == std::string_view::npos) throw std::runtime_error("a record's header is damaged");
            fields_[std::string(field.substr(0, equals))] = field.substr(equals + 1);
        }
    }
    template <class T>
    T number(const char* name) const {
        return FieldReader(bytes(name)).get<T>();
    }
    std::string text(const char* name) const { return std::string(bytes(name)); }

  private:
    std::string_view bytes(const char* name) const {
        const auto found = fields_.find(name);
        if (found == fields_.end())
            throw std::runtime_error(std::string("a record has no field '") + name + "'");
        return found->second;
    }
    std::map<std::string, std::string_view> fields_;
};

/// A record without its data. The fields are copied: the next read may take their place.
struct BagRecord {
    std::string header;
    std::uint64_t data = 0, size = 0;  ///< place and length of the data
    std::uint64_t end() const { return data + size; }
};

BagRecord readBagRecord(ByteSource& bytes, std::uint64_t at) {
    const auto length = [&](std::uint64_t place) {
        return std::uint64_t{FieldReader(bytes.read(place, 4)).get<std::uint32_t>()};
    };
    BagRecord record;
    record.header = bytes.read(at + 4, length(at));
    record.data = at + 4 + record.header.size() + 4;
    record.size = length(record.data - 4);
    if (record.size > bytes.size() - record.data) throw std::runtime_error("it ends too early");
    return record;
}

struct Chunk {
    std::string compression;
    BagRecord record;
    std::uint32_t size = 0;  ///< without compression
};

class Ros1Bag : public MessageStore {
  public:
    explicit Ros1Bag(const std::string& path) : path_(path), file_(path) {
        try {
            checkHead();
            for (std::uint64_t at = kFirstLine.size(); at < file_.size();) at = addRecord(at);
        } catch (const std::runtime_error& error) {
            throw std::runtime_error(path + ": truncated or damaged bag (" + error.what() +
                                     "): copy it again, or run `rosbag reindex` on it");
        }
        if (unfinished_)
            throw std::runtime_error(
                path + " has no index, its recording was not ended: run `rosbag reindex` on it");
        for (auto& [id, connection] : connections_) {
            if (connection.topic.empty()) continue;  // messages of nothing that is told
            StoredTopic& out = topic(connection.topic, connection.type, "ros1");
            out.count += connection.count;
            if (isReadType(connection.type))
                out.messages.insert(out.messages.end(), connection.messages.begin(),
                                    connection.messages.end());
        }
    }

    std::string_view read(const StoredMessage& message) override {
        if (message.piece == 0) return file_.read(message.offset, message.size);
        return MemoryBytes(chunks_.get(message.piece, [&] { return unpack(message.piece); }))
            .read(message.offset, message.size);
    }

  private:
    struct Connection {
        std::string topic, type;
        std::size_t count = 0;
        std::vector<StoredMessage> messages;
    };

    void checkHead() {
        const std::string head(file_.read(0, std::min<std::uint64_t>(file_.size(), kFirstLine.size())));
        if (head == kFirstLine) return;
        throw std::runtime_error(head.rfind("#ROSBAG V", 0) == 0 && head.size() == kFirstLine.size()
                                     ? "its format is not 2.0 but " + excerpt(head.substr(9, 3)) +
                                           ": run `rosbag migrate` on it"
                                     : "it ends too early");
    }

    /// @return where the next one is
    std::uint64_t addRecord(std::uint64_t at) {
        const BagRecord record = readBagRecord(file_, at);
        const Fields fields(record.header);
        switch (fields.number<std::uint8_t>("op")) {
            case kBagHeader:
                unfinished_ = fields.number<std::uint64_t>("index_pos") == 0;
                break;
            case kConnection:
                addConnection(file_, record, fields);
                break;
            case kChunkRecord:
                addChunk(at, record, fields);
                break;
            default:;  // indices
        }
        return record.end();
    }

    /// A damaged one costs its own messages only.
    void addChunk(std::uint64_t at, const BagRecord& record, const Fields& fields) {
        try {
            if (fields.text("compression") == "none") {
                addMessages(file_, record.data, record.end(), 0);
                return;
            }
            const std::string unpacked = unpack(at);
            MemoryBytes bytes(unpacked);
            addMessages(bytes, 0, bytes.size(), at);
        } catch (const std::runtime_error& error) {
            addDamage("the chunk at byte " + std::to_string(at) + ": " + error.what());
        }
    }

    std::string unpack(std::uint64_t at) {
        const BagRecord record = readBagRecord(file_, at);
        const Fields fields(record.header);
        return decompressed(fields.text("compression"), file_.read(record.data, record.size),
                            fields.number<std::uint32_t>("size"));
    }

    void addMessages(ByteSource& bytes, std::uint64_t at, std::uint64_t end, std::uint64_t piece) {
        while (at < end) {
            const BagRecord record = readBagRecord(bytes, at);
            if (record.end() > end) throw std::runtime_error("a record reaches beyond its end");
            const Fields fields(record.header);
            const auto op = fields.number<std::uint8_t>("op");
            if (op == kConnection) addConnection(bytes, record, fields);
            if (op == kMessageRecord) {
                Connection& connection = connections_[fields.number<std::uint32_t>("conn")];
                connection.count++;
                StoredMessage message;
                message.piece = piece, message.offset = record.data, message.size = record.size;
                const std::uint64_t head = std::min<std::uint64_t>(message.head.size(), record.size);
                const std::string_view first = bytes.read(record.data, head);
                std::copy(first.begin(), first.end(), message.head.begin());
                if (connection.type.empty() || isReadType(connection.type))
                    connection.messages.push_back(message);
            }
            at = record.end();
        }
    }

    void addConnection(ByteSource& bytes, const BagRecord& record, const Fields& fields) {
        Connection& connection = connections_[fields.number<std::uint32_t>("conn")];
        connection.topic = fields.text("topic");
        connection.type = Fields(bytes.read(record.data, record.size)).text("type");
    }

    std::string path_;
    FileBytes file_;
    ChunkCache chunks_;
    std::map<std::uint32_t, Connection> connections_;
    bool unfinished_ = false;
};

}  // namespace

std::unique_ptr<MessageStore> openRos1Bag(const std::string& path) {
    return std::make_unique<Ros1Bag>(path);
}

}  // namespace roevo
