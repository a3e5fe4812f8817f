#pragma once
/// Files of messages as recorders write them, made from the formats' specifications.

#include <bzlib.h>
#include <lz4frame.h>
#include <sqlite3.h>
#include <zlib.h>
#include <zstd.h>

#include <fstream>
#include <map>
#include <stdexcept>
#include <string>
#include <vector>

#include "tools/ros_messages.h"

namespace roevo::test {

struct RecordedMessage {
    std::string topic, type;  ///< "sensor_msgs/Image"
    std::string bytes;
};
using Recording = std::vector<RecordedMessage>;

inline std::string compress(const std::string& method, const std::string& bytes) {
    std::string out;
    if (method == "bz2") {
        out.resize(bytes.size() + bytes.size() / 50 + 1000);
        auto size = static_cast<unsigned>(out.size());
        BZ2_bzBuffToBuffCompress(out.data(), &size, const_cast<char*>(bytes.data()),
                                 static_cast<unsigned>(bytes.size()), 9, 0, 0);
        out.resize(size);
    } else if (method == "lz4") {
        out.resize(LZ4F_compressFrameBound(bytes.size(), nullptr));
        out.resize(LZ4F_compressFrame(out.data(), out.size(), bytes.data(), bytes.size(), nullptr));
    } else if (method == "zstd") {
        out.resize(ZSTD_compressBound(bytes.size()));
        out.resize(ZSTD_compress(out.data(), out.size(), bytes.data(), bytes.size(), 3));
    } else {
        out = bytes;
    }
    return out;
}

inline void writeBytes(const std::string& path, const std::string& bytes) {
    std::ofstream(path, std::ios::binary) << bytes;
}

/// http://wiki.ros.org/Bags/Format/2.0, a chunk for every three messages.
class Ros1BagBytes {
  public:
    explicit Ros1BagBytes(const Recording& recording, const std::string& compression = "none") {
        std::map<std::string, std::uint32_t> connections;
        std::string chunk, all;
        const auto endChunk = [&] {
            if (chunk.empty()) return;
            all += record({{"op", "\5"}, {"compression", compression}, {"size", number(chunk.size())}},
                          compress(compression, chunk));
            all += record({{"op", "\4"}, {"ver", number(1)}, {"conn", number(0)}, {"count", number(0)}}, "");
            chunk.clear();
        };
        std::size_t count = 0;
        for (const RecordedMessage& message : recording) {
            const auto [place, added] =
                connections.emplace(message.topic, static_cast<std::uint32_t>(connections.size()));
            const std::string id = number(place->second);
            const std::string connection =
                record({{"op", "\7"}, {"conn", id}, {"topic", message.topic}},
                       fields({{"topic", message.topic}, {"type", message.type}, {"md5sum", "*"}}));
            if (added) chunk += connection, index_ += connection;
            chunk += record({{"op", "\2"}, {"conn", id}, {"time", std::string(8, '\1')}}, message.bytes);
            if (++count % 3 == 0) endChunk();
        }
        endChunk();
        const std::string first = "#ROSBAG V2.0\n";
        const std::size_t head = 4096;
        bytes_ = first + header(first.size() + head + all.size(), connections.size(), head);
        bytes_ += all + index_;
    }
    const std::string& bytes() const { return bytes_; }

  private:
    using Fields = std::vector<std::pair<std::string, std::string>>;

    static std::string number(std::uint64_t value, std::size_t size = 4) {
        return {reinterpret_cast<const char*>(&value), size};
    }
    static std::string fields(const Fields& all) {
        std::string out;
        for (const auto& [name, value] : all)
            out += number(name.size() + 1 + value.size()) + name + "=" + value;
        return out;
    }
    static std::string record(const Fields& head, const std::string& data) {
        const std::string text = fields(head);
        return number(text.size()) + text + number(data.size()) + data;
    }
    /// Padded to `size` bytes.
    static std::string header(std::uint64_t index, std::size_t connections, std::size_t size) {
        const Fields all = {{"op", "\3"},
                            {"index_pos", number(index, 8)},
                            {"conn_count", number(connections)},
                            {"chunk_count", number(1)}};
        const std::size_t empty = record(all, "").size();
        return record(all, std::string(size - empty, ' '));
    }

    std::string bytes_, index_;
};

/// https://mcap.dev/spec
class McapBytes {
  public:
    /// @param compression  of chunks of three messages; "no chunks": none
    /// @param encoding     of the messages: "cdr" or "ros1"
    explicit McapBytes(const Recording& recording, const std::string& compression = "",
                       const std::string& encoding = "cdr") {
        const std::string magic("\x89MCAP0\r\n", 8);
        bytes_ = magic + record(1, text("ros2") + text("test"));
        std::map<std::string, std::uint16_t> channels;
        std::string chunk;
        const auto endChunk = [&] {
            if (compression == "no chunks") {
                bytes_ += chunk;
            } else if (!chunk.empty()) {
                const std::string packed = compress(compression, chunk);
                const auto crc =
                    crc32(0, reinterpret_cast<const Bytef*>(chunk.data()), static_cast<uInt>(chunk.size()));
                bytes_ += record(6, number(1, 8) + number(2, 8) + number(chunk.size(), 8) + number(crc, 4) +
                                        text(compression) + number(packed.size(), 8) + packed);
                bytes_ += record(7, number(0, 2) + number(0, 4));
            }
            chunk.clear();
        };
        std::size_t count = 0;
        for (const RecordedMessage& message : recording) {
            const auto [place, added] =
                channels.emplace(message.topic, static_cast<std::uint16_t>(channels.size() + 1));
            const std::string id = number(place->second, 2);
            if (added) {
                std::string type = message.type;
                if (encoding == "cdr") type.insert(type.find('/'), "/msg");
                chunk += record(3, id + text(type) + text("ros2msg") + text("the definition"));
                chunk += record(4, id + id + text(message.topic) + text(encoding) + number(0, 4));
            }
            chunk += record(5, id + number(count, 4) + number(1, 8) + number(1, 8) + message.bytes);
            if (++count % 3 == 0) endChunk();
        }
        endChunk();
        bytes_ += record(15, number(0, 4));
        bytes_ += record(2, number(0, 8) + number(0, 8) + number(0, 4)) + magic;
    }
    const std::string& bytes() const { return bytes_; }

  private:
    static std::string number(std::uint64_t value, std::size_t size) {
        return {reinterpret_cast<const char*>(&value), size};
    }
    static std::string text(const std::string& value) { return number(value.size(), 4) + value; }
    static std::string record(char op, const std::string& content) {
        return op + number(content.size(), 8) + content;
    }

    std::string bytes_;
};

/// The tables of rosbag2_storage_sqlite3.
inline void writeSqliteBag(const std::string& path, const Recording& recording,
                           const std::string& encoding = "cdr") {
    sqlite3* database = nullptr;
    const auto run = [&](const std::string& command) {
        if (sqlite3_exec(database, command.c_str(), nullptr, nullptr, nullptr) != SQLITE_OK)
            throw std::runtime_error(sqlite3_errmsg(database));
    };
    sqlite3_open(path.c_str(), &database);
    run("CREATE TABLE topics(id INTEGER PRIMARY KEY, name TEXT NOT NULL, type TEXT NOT NULL, "
        "serialization_format TEXT NOT NULL, offered_qos_profiles TEXT NOT NULL);"
        "CREATE TABLE messages(id INTEGER PRIMARY KEY, topic_id INTEGER NOT NULL, "
        "timestamp INTEGER NOT NULL, data BLOB NOT NULL);"
        "CREATE INDEX timestamp_idx ON messages (timestamp ASC); BEGIN");
    std::map<std::string, int> ids;
    for (const RecordedMessage& message : recording) {
        const auto [place, added] = ids.emplace(message.topic, static_cast<int>(ids.size() + 1));
        std::string type = message.type;
        type.insert(type.find('/'), "/msg");
        if (added)
            run("INSERT INTO topics VALUES(" + std::to_string(place->second) + ",'" + message.topic + "','" +
                type + "','" + encoding + "','')");
        sqlite3_stmt* insert = nullptr;
        sqlite3_prepare_v2(database, "INSERT INTO messages(topic_id, timestamp, data) VALUES(?, 1, ?)", -1,
                           &insert, nullptr);
        sqlite3_bind_int(insert, 1, place->second);
        sqlite3_bind_blob(insert, 2, message.bytes.data(), static_cast<int>(message.bytes.size()),
                          SQLITE_STATIC);
        sqlite3_step(insert);
        sqlite3_finalize(insert);
    }
    run("COMMIT");
    sqlite3_close(database);
}

}  // namespace roevo::test
