#include "benchmark_list.h"

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <set>
#include <stdexcept>
#include <utility>

#include "input/excerpt.h"
#include "input/regular_file.h"
#include "programs/program.h"

namespace roevo {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;

constexpr char kOurs[] = "ROEVO-TR+BA";

Json parseFile(const std::string& file) {
    requireRegularInput(file);
    errno = 0;
    std::ifstream in(file);
    if (!in) throw std::runtime_error("cannot read " + file + ": " + std::strerror(errno ? errno : ENOENT));
    try {
        return Json::parse(in);
    } catch (const Json::exception& e) {
        throw std::runtime_error(file + " is no JSON: " + excerpt(e.what(), 160));  // it quotes what it read
    }
}

/// One entry of the list; its messages say where they come from.
class Entry {
  public:
    Entry(const Json& json, std::string where) : json_(json), where_(std::move(where)) {
        if (!json_.is_object()) fail("it is no object");
    }

    [[noreturn]] void fail(const std::string& what) const { throw std::runtime_error(where_ + ": " + what); }

    const Json& at(const char* key) const {
        const auto found = json_.find(key);
        if (found == json_.end()) fail("the key '" + std::string(key) + "' is missing");
        return *found;
    }

    /// Empty for null.
    std::string text(const char* key) const {
        const Json& value = at(key);
        if (value.is_null()) return {};
        if (!value.is_string()) fail("'" + std::string(key) + "' is no text");
        return value.get<std::string>();
    }

    std::optional<double> paperAte() const {
        const auto paper = json_.find("paper");
        if (paper == json_.end() || !paper->is_object()) return std::nullopt;
        const Json& figure = paper->value("ate_cm", Json::object()).value(kOurs, Json());
        return figure.is_number() ? std::optional(figure.get<double>()) : std::nullopt;
    }

    using Range = std::pair<std::size_t, std::size_t>;
    std::vector<Range> segments(const Json& frames) const {
        std::vector<Range> ranges;
        const bool several = frames.is_array() && !frames.empty() && frames[0].is_array();
        for (const Json& range : several ? frames : Json::array({frames})) {
            if (!range.is_array() || range.size() != 2 || !range[0].is_number_unsigned() ||
                !range[1].is_number_unsigned() || range[0] >= range[1])
                fail("'truncation.frames' is no range [begin, end) of frames, nor a list of such");
            ranges.emplace_back(range[0], range[1]);
        }
        return ranges;
    }

  private:
    const Json& json_;
    std::string where_;
};

// Where the sequence lies below `data`; empty when nowhere. `tried` gets what was looked for.
std::string findOnDisk(const fs::path& data, const std::string& name, const std::string& folder,
                       std::string& tried) {
    std::vector<std::string> candidates;
    if (!folder.empty()) candidates = {folder, folder + ".rawlog"};
    candidates.push_back(name + ".rawlog");
    if (folder.empty()) candidates.push_back(name);
    for (const std::string& candidate : candidates) {
        std::error_code ignored;
        if (fs::exists(data / candidate, ignored)) return (data / candidate).string();
        tried += (tried.empty() ? "" : ", ") + candidate;
    }
    return {};
}

void addSequence(const Entry& entry, SequenceInput sequence, BenchmarkList& list) {
    const Json& truncation = entry.at("truncation");
    if (truncation.is_null()) {
        sequence.paper_ate_cm = entry.paperAte();
        list.sequences.push_back(sequence);
        return;
    }
    if (!truncation.is_object() || !truncation.contains("frames")) entry.fail("'truncation' has no 'frames'");
    if (truncation.contains("note") && truncation["note"].is_string()) sequence.note = truncation["note"];
    if (truncation["frames"].is_null()) {
        sequence.note += (sequence.note.empty() ? "" : " ") +
                         std::string("The whole sequence was run; the paper's figure is not comparable.");
        list.sequences.push_back(sequence);
        return;
    }
    const auto segments = entry.segments(truncation["frames"]);
    for (const auto& [begin, end] : segments) {
        SequenceInput segment = sequence;
        segment.skip = begin;
        segment.first = end - begin;
        if (segments.size() == 1)
            segment.paper_ate_cm = entry.paperAte();
        else
            segment.name += "_" + std::to_string(begin) + "_" + std::to_string(end);
        list.sequences.push_back(segment);
    }
}

}  // namespace

BenchmarkList readBenchmarkList(const std::string& file, const std::string& data) {
    const Json json = parseFile(file);
    std::error_code ignored;
    if (!fs::is_directory(data, ignored))
        throw std::runtime_error("--data " + data + ": there is no such folder");
    const Entry top(json, file);
    const Json& entries = top.at("sequences");
    if (!entries.is_array() || entries.empty()) top.fail("'sequences' is no list, or an empty one");

    BenchmarkList list;
    std::set<std::string> names, run_names;
    for (std::size_t i = 0; i < entries.size(); ++i) {
        const std::string where = file + ": sequence " + std::to_string(i + 1);
        const std::string name = Entry(entries[i], where).text("name");
        const Entry entry(entries[i], where + " ('" + excerpt(name) + "')");
        if (name.empty() || name[0] == '.' || name.find('/') != std::string::npos)
            entry.fail("its name cannot be that of a folder");
        if (!names.insert(name).second) entry.fail("there is another one of that name");

        SequenceInput sequence;
        sequence.name = name;
        sequence.expected_ground_truth = entry.text("ground_truth");
        const std::string folder = entry.text("folder");
        std::string tried;
        sequence.input = findOnDisk(data, name, folder, tried);
        BenchmarkList found;
        addSequence(entry, sequence, found);  // even if it is missing: a fault of the list should be seen
        for (const SequenceInput& one : found.sequences)  // parts, too: each has a folder of that name
            if (!run_names.insert(one.name).second)
                entry.fail("what is run of it would be called '" + excerpt(one.name) +
                           "', and there is another one");
        if (sequence.input.empty())
            list.missing.push_back(name + ": not in " + data + " (" + tried + ")");
        else
            list.sequences.insert(list.sequences.end(), found.sequences.begin(), found.sequences.end());
    }
    return list;
}

}  // namespace roevo
