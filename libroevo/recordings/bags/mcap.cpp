// MCAP, version 0: https://mcap.dev/spec
#include <zlib.h>

#include <algorithm>
#include <map>
#include <stdexcept>

#include "input/excerpt.h"
#include "recordings/bags/byte_source.h"
#include "recordings/bags/chunk_cache.h"
#include "recordings/bags/message_store.h"

namespace roevo {
namespace {

constexpr std::string_view kMagic("\x89MCAP0\r\n", 8);

enum McapOp : std::uint8_t {
    kFooter = 0x02,
    kSchema = 0x03,
    kChannel = 0x04,
    kMessage = 0x05,
    kChunk = 0x06
};

struct Record {
    std::uint8_t op = 0;
    std::uint64_t data = 0, size = 0;  ///< place and length of the content
    std::uint64_t end() const { return data + size; }
};

Record readRecord(ByteSource& bytes, std::uint64_t at) {
    constexpr std::uint64_t kHead = 1 + 8;
    FieldReader in(bytes.read(at, kHead));
    Record record;
    record.op = in.get<std::uint8_t>();
    record.size = in.get<std::uint64_t>();
    record.data = at + kHead;
    if (record.size > bytes.size() - record.data) throw std::runtime_error("it ends too early");
    return record;
}

/// A chunk without its records.
struct ChunkHead {
    std::uint64_t unpacked_size = 0;
    std::uint32_t crc = 0;
    std::string compression;
    std::uint64_t records = 0, size = 0;  ///< place and length as they are in the file
};

class Mcap : public MessageStore {
  public:
    explicit Mcap(const std::string& path) : file_(path) {
        try {
            readFile();
        } catch (const std::runtime_error& error) {
            throw std::runtime_error(path + ": truncated or damaged MCAP file (" + error.what() +
                                     "): copy it again, or run `mcap recover` on it");
        }
        for (auto& [id, channel] : channels_) {
            if (channel.topic.empty()) continue;  // messages of nothing that is told
            if (isReadType(channel.type) && channel.encoding != "cdr" && channel.encoding != "ros1")
                throw std::runtime_error(path + ": topic " + excerpt(channel.topic) + " is written as '" +
                                         excerpt(channel.encoding) + "', neither as cdr nor as ros1");
            StoredTopic& out = topic(channel.topic, channel.type, channel.encoding);
            out.count += channel.count;
            if (isReadType(out.type))
                out.messages.insert(out.messages.end(), channel.messages.begin(), channel.messages.end());
        }
    }

    std::string_view read(const StoredMessage& message) override {
        if (message.piece == 0) return file_.read(message.offset, message.size);
        return MemoryBytes(chunks_.get(message.piece, [&] { return unpack(message.piece); }))
            .read(message.offset, message.size);
    }

  private:
    struct Channel {
        std::string topic, type, encoding;
        std::size_t count = 0;
        std::vector<StoredMessage> messages;
    };

    void readFile() {
        if (file_.size() < 2 * kMagic.size()) throw std::runtime_error("it ends too early");
        const std::uint64_t end = file_.size() - kMagic.size();
        if (file_.read(end, kMagic.size()) != kMagic)
            throw std::runtime_error("it does not end as such a file does");
        for (std::uint64_t at = kMagic.size(); at < end;) {
            const Record record = readRecord(file_, at);
            if (record.op == kFooter) {
                if (record.end() != end) throw std::runtime_error("something follows its footer");
                return;
            }
            if (record.op == kChunk)
                addChunk(record);
            else
                addRecord(file_, record, 0);
            at = record.end();
        }
        throw std::runtime_error("it has no footer");
    }

    /// A damaged one costs its own messages only.
    void addChunk(const Record& record) {
        try {
            const ChunkHead head = readHead(record);
            if (head.compression.empty()) {
                addRecords(file_, head.records, head.records + head.size, 0);
                return;
            }
            const std::string unpacked = unpack(record.data);
            MemoryBytes bytes(unpacked);
            addRecords(bytes, 0, bytes.size(), record.data);
        } catch (const std::runtime_error& error) {
            addDamage("the chunk at byte " + std::to_string(record.data) + ": " + error.what());
        }
    }

    ChunkHead readHead(const Record& record) {
        constexpr std::uint64_t kMost = 256;  // more than the names of all compressions
        FieldReader in(file_.read(record.data, std::min(record.size, kMost)));
        ChunkHead head;
        in.skip(8 + 8);  // times of the first and the last message
        head.unpacked_size = in.get<std::uint64_t>();
        head.crc = in.get<std::uint32_t>();
        head.compression = in.text();
        head.size = in.get<std::uint64_t>();
        head.records = record.data + in.position();
        if (head.size > record.end() - head.records)
            throw std::runtime_error("its records reach beyond its end");
        return head;
    }

    /// @param place  of the chunk's content in the file
    std::string unpack(std::uint64_t place) {
        const ChunkHead head = readHead(readRecord(file_, place - 9));
        std::string out =
            decompressed(head.compression, file_.read(head.records, head.size), head.unpacked_size);
        const uLong crc = crc32_z(0, reinterpret_cast<const Bytef*>(out.data()), out.size());
        if (head.crc != 0 && crc != head.crc) throw std::runtime_error("its checksum is wrong");
        return out;
    }

    void addRecords(ByteSource& bytes, std::uint64_t at, std::uint64_t end, std::uint64_t piece) {
        while (at < end) {
            const Record record = readRecord(bytes, at);
            if (record.end() > end) throw std::runtime_error("a record reaches beyond its end");
            addRecord(bytes, record, piece);
            at = record.end();
        }
    }

    void addRecord(ByteSource& bytes, const Record& record, std::uint64_t piece) {
        if (record.op == kMessage) {
            addMessage(bytes, record, piece);
        } else if (record.op == kSchema) {
            FieldReader in(bytes.read(record.data, record.size));
            const auto id = in.get<std::uint16_t>();
            schemas_[id] = in.text();
        } else if (record.op == kChannel) {
            FieldReader in(bytes.read(record.data, record.size));
            Channel& channel = channels_[in.get<std::uint16_t>()];
            const auto schema = schemas_.find(in.get<std::uint16_t>());
            channel.type = schema == schemas_.end() ? "without type" : plainType(schema->second);
            channel.topic = in.text();
            channel.encoding = in.text();
        }
    }

    void addMessage(ByteSource& bytes, const Record& record, std::uint64_t piece) {
        constexpr std::uint64_t kHead = 2 + 4 + 8 + 8;  // channel, number, times of recording and sending
        StoredMessage message;
        const std::uint64_t some = std::min(record.size, kHead + message.head.size());
        FieldReader in(bytes.read(record.data, some));
        Channel& channel = channels_[in.get<std::uint16_t>()];
        in.skip(kHead - 2);
        const std::string_view first = in.bytes(in.left());
        std::copy(first.begin(), first.end(), message.head.begin());
        message.piece = piece;
        message.offset = record.data + kHead;
        message.size = record.size - kHead;
        channel.count++;
        if (channel.topic.empty() || isReadType(channel.type)) channel.messages.push_back(message);
    }

    FileBytes file_;
    ChunkCache chunks_;
    std::map<std::uint16_t, std::string> schemas_;
    std::map<std::uint16_t, Channel> channels_;
};

}  // namespace

std::unique_ptr<MessageStore> openMcap(const std::string& path) {
    return std::make_unique<Mcap>(path);
}

}  // namespace roevo
