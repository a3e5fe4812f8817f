// ROS 2 bags in SQLite: the tables topics(id, name, type, serialization_format, …) and messages(id, topic_id,
// timestamp, data).
#include <sqlite3.h>

#include <algorithm>
#include <filesystem>
#include <map>
#include <stdexcept>

#include "input/excerpt.h"
#include "recordings/bags/byte_source.h"
#include "recordings/bags/message_store.h"

namespace fs = std::filesystem;

namespace roevo {
namespace {

struct Close {
    void operator()(sqlite3* database) const { sqlite3_close(database); }
    void operator()(sqlite3_stmt* statement) const { sqlite3_finalize(statement); }
    void operator()(sqlite3_blob* blob) const { sqlite3_blob_close(blob); }
};

class SqliteBag : public MessageStore {
  public:
    explicit SqliteBag(const std::string& path) : path_(path) {
        std::error_code fault;
        file_size_ = fs::file_size(path, fault);
        try {
            open();
            readTopics();
            readMessages();
        } catch (const std::runtime_error& error) {
            throw std::runtime_error(path + ": truncated or damaged bag of SQLite, or none of ROS 2 (" +
                                     error.what() +
                                     "): copy it again, or run `ros2 bag reindex` on its folder");
        }
    }

    std::string_view read(const StoredMessage& message) override {
        bytes_.resize(openBlob(static_cast<sqlite3_int64>(message.piece)));
        readBlob(bytes_.data(), bytes_.size());
        return bytes_;
    }

  private:
    void open() {
        // Without a journal beside it the file is all there is, and neither locks nor files of ours are
        // wanted
        const bool journal = fs::exists(path_ + "-wal");
        if (!journal) checkLength();
        std::string uri = "file:";
        for (const char c : fs::absolute(path_).string()) {
            constexpr char kDigits[] = "0123456789abcdef";
            const auto byte = static_cast<unsigned char>(c);
            uri += {'%', kDigits[byte >> 4], kDigits[byte & 15]};
        }
        sqlite3* opened = nullptr;
        const int state = sqlite3_open_v2((uri + (journal ? "?mode=ro" : "?mode=ro&immutable=1")).c_str(),
                                          &opened, SQLITE_OPEN_READONLY | SQLITE_OPEN_URI, nullptr);
        database_.reset(opened);
        check(state);
        // What is in the file is not trusted: neither its lengths nor code in its schema
        constexpr std::uint64_t kLargest = 1'000'000'000;
        sqlite3_limit(opened, SQLITE_LIMIT_LENGTH, static_cast<int>(std::min(kLargest, file_size_ + 4096)));
        sqlite3_db_config(opened, SQLITE_DBCONFIG_TRUSTED_SCHEMA, 0, nullptr);
        sqlite3_db_config(opened, SQLITE_DBCONFIG_DEFENSIVE, 1, nullptr);
        for (const char* table : {"topics", "messages"}) {
            prepare("SELECT 1 FROM sqlite_master WHERE type='table' AND name='" + std::string(table) + "'");
            if (!step()) throw std::runtime_error(std::string("it has no table '") + table + "'");
        }
    }

    /// The head tells size and number of the pages, where it is up to date. SQLite takes missing ends for
    /// zeros.
    void checkLength() const {
        const std::string head(FileBytes(path_).read(0, 100));
        const auto number = [&](std::size_t at, std::size_t size) {
            std::uint64_t value = 0;
            for (std::size_t i = 0; i < size; i++)
                value = value << 8 | static_cast<unsigned char>(head[at + i]);
            return value;
        };
        const std::uint64_t page = number(16, 2) == 1 ? 65536 : number(16, 2), pages = number(28, 4);
        const bool up_to_date = number(24, 4) == number(92, 4);
        if (up_to_date && page * pages > file_size_) throw std::runtime_error("it ends too early");
    }

    void readTopics() {
        prepare("SELECT id, name, type, serialization_format FROM topics");
        while (step()) {
            const std::string encoding = text(3);
            if (encoding != "cdr" && isReadType(plainType(text(2))))
                throw std::runtime_error("topic " + excerpt(text(1)) + " is written as '" +
                                         excerpt(encoding) + "', not as cdr");
            StoredTopic& made = topic(text(1), text(2), encoding);
            ids_[sqlite3_column_int64(statement_.get(), 0)] =
                static_cast<std::size_t>(&made - topics_.data());
        }
    }

    void readMessages() {
        prepare("SELECT rowid, topic_id FROM messages ORDER BY rowid");
        while (step()) {
            const sqlite3_int64 row = sqlite3_column_int64(statement_.get(), 0);
            const auto id = ids_.find(sqlite3_column_int64(statement_.get(), 1));
            if (id == ids_.end()) continue;  // of nothing that is told
            StoredTopic& topic = topics_[id->second];
            topic.count++;
            if (!isReadType(topic.type)) continue;
            StoredMessage message;
            message.piece = static_cast<std::uint64_t>(row);
            try {
                message.size = openBlob(row);
                readBlob(message.head.data(), std::min<std::uint64_t>(message.head.size(), message.size));
            } catch (const std::runtime_error& error) {
                addDamage("row " + std::to_string(row) + ": " + error.what());
                blob_.reset();
                continue;
            }
            topic.messages.push_back(message);
        }
    }

    /// @return its size
    std::size_t openBlob(sqlite3_int64 row) {
        if (blob_ && sqlite3_blob_reopen(blob_.get(), row) != SQLITE_OK) blob_.reset();
        if (!blob_) {
            sqlite3_blob* opened = nullptr;
            const int state = sqlite3_blob_open(database_.get(), "main", "messages", "data", row, 0, &opened);
            blob_.reset(opened);
            check(state);
        }
        const auto size = static_cast<std::uint64_t>(sqlite3_blob_bytes(blob_.get()));
        if (size > file_size_) throw std::runtime_error("a message longer than the file");
        return size;
    }

    void readBlob(char* to, std::size_t count) {
        check(sqlite3_blob_read(blob_.get(), to, static_cast<int>(count), 0));
    }

    void prepare(const std::string& query) {
        sqlite3_stmt* made = nullptr;
        const int state = sqlite3_prepare_v2(database_.get(), query.c_str(), -1, &made, nullptr);
        statement_.reset(made);
        check(state);
    }

    /// Whether there is another row.
    bool step() {
        const int state = sqlite3_step(statement_.get());
        if (state != SQLITE_DONE && state != SQLITE_ROW) check(state);
        return state == SQLITE_ROW;
    }

    std::string text(int column) const {
        const auto* value = sqlite3_column_text(statement_.get(), column);
        const int size = sqlite3_column_bytes(statement_.get(), column);
        return value == nullptr
                   ? std::string()
                   : std::string(reinterpret_cast<const char*>(value), static_cast<std::size_t>(size));
    }

    void check(int state) const {
        if (state == SQLITE_NOMEM) throw std::bad_alloc();
        if (state != SQLITE_OK)
            // Its words may hold what the file holds
            throw std::runtime_error(
                excerpt(database_ ? sqlite3_errmsg(database_.get()) : sqlite3_errstr(state)));
    }

    std::string path_;
    std::uint64_t file_size_ = 0;
    std::unique_ptr<sqlite3, Close> database_;  // before what is of it
    std::unique_ptr<sqlite3_stmt, Close> statement_;
    std::unique_ptr<sqlite3_blob, Close> blob_;
    std::map<sqlite3_int64, std::size_t> ids_;  ///< positions in topics_
    std::string bytes_;
};

}  // namespace

std::unique_ptr<MessageStore> openSqliteBag(const std::string& path) {
    return std::make_unique<SqliteBag>(path);
}

}  // namespace roevo
