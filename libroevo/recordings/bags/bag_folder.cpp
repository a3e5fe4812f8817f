// A recording of ROS 2 is a folder: metadata.yaml and one or more files, each with the messages of some time.
#include <algorithm>
#include <filesystem>
#include <fstream>
#include <stdexcept>

#include "input/regular_file.h"
#include "recordings/bags/message_store.h"

namespace fs = std::filesystem;

namespace roevo {
namespace {

constexpr char kMetadata[] = "metadata.yaml";

std::string stripped(std::string text) {
    const auto unwanted = [](char c) { return c == ' ' || c == '\t' || c == '\r' || c == '"' || c == '\''; };
    while (!text.empty() && unwanted(text.back())) text.pop_back();
    text.erase(text.begin(), std::find_if_not(text.begin(), text.end(), unwanted));
    return text;
}

/// The list "relative_file_paths" of metadata.yaml. Older recordings name the folder, too.
std::vector<std::string> listedFiles(const std::string& metadata) {
    std::vector<std::string> files;
    if (!otherThanFile(metadata).empty()) return files;
    std::ifstream in(metadata);
    bool inside = false;
    for (std::string line; std::getline(in, line);) {
        line = stripped(line);
        if (inside && line.rfind("- ", 0) == 0)
            files.push_back(fs::path(stripped(line.substr(2))).filename().string());
        else
            inside = line == "relative_file_paths:";
    }
    return files;
}

bool isPart(const fs::path& file) {
    return file.extension() == ".db3" || file.extension() == ".mcap";
}

/// In the order of their names, numbers by value: 9 before 10.
bool numericLess(const std::string& a, const std::string& b) {
    return a.size() != b.size() ? a.size() < b.size() : a < b;
}

/// @throws std::runtime_error when there are none, or one that is listed is missing
std::vector<std::string> partsOf(const std::string& folder) {
    std::vector<std::string> parts = listedFiles((fs::path(folder) / kMetadata).string());
    for (const std::string& part : parts) {
        if (fs::path(part).extension() == ".zstd")
            throw std::runtime_error(folder + ": " + part + " is compressed as a whole: run `unzstd` on it");
        if (!fs::exists(fs::path(folder) / part))
            throw std::runtime_error(folder + ": " + kMetadata + " lists " + part +
                                     ", which is not there: copy the whole folder");
    }
    if (parts.empty())
        for (const auto& entry : fs::directory_iterator(folder))
            if (isPart(entry.path())) parts.push_back(entry.path().filename().string());
    if (parts.empty())
        throw std::runtime_error(folder + " has neither .db3 nor .mcap files in it: no recording of ROS 2");
    std::sort(parts.begin(), parts.end(), numericLess);
    return parts;
}

/// Several files as one.
class BagFolder : public MessageStore {
  public:
    explicit BagFolder(const std::string& folder) {
        for (const std::string& part : partsOf(folder)) {
            const auto path = fs::path(folder) / part;
            parts_.push_back(path.extension() == ".mcap" ? openMcap(path.string())
                                                         : openSqliteBag(path.string()));
            for (const StoredTopic& from : parts_.back()->topics()) {
                StoredTopic& to = topic(from.name, from.type, from.encoding);
                to.count += from.count;
                for (StoredMessage message : from.messages) {
                    message.part = static_cast<std::uint32_t>(parts_.size() - 1);
                    to.messages.push_back(message);
                }
            }
            for (const std::string& damage : parts_.back()->damage()) addDamage(part + ", " + damage);
        }
    }

    std::string_view read(const StoredMessage& message) override {
        return parts_.at(message.part)->read(message);
    }

  private:
    std::vector<std::unique_ptr<MessageStore>> parts_;
};

}  // namespace

bool isBagFolder(const std::string& folder) {
    std::error_code unseen;
    if (!fs::is_directory(folder, unseen)) return false;
    for (fs::directory_iterator file(folder, unseen), end; !unseen && file != end; file.increment(unseen))
        if (isPart(file->path())) return true;
    return !listedFiles((fs::path(folder) / kMetadata).string()).empty();
}

std::unique_ptr<MessageStore> openBagFolder(const std::string& folder) {
    return std::make_unique<BagFolder>(folder);
}

}  // namespace roevo
