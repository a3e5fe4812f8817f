#include "recordings/depth_times.h"

#include <algorithm>
#include <filesystem>
#include <functional>
#include <stdexcept>

#include "evaluation/association.h"
#include "programs/text.h"
#include "recordings/text_list.h"
#include "roevo_mrpt/time_conversions.h"

namespace fs = std::filesystem;

namespace roevo {

std::string depthTimesFile(const std::string& rawlog) {
    const fs::path path(rawlog);
    return (path.parent_path() / (path.stem().string() + "_depth_times.txt")).string();
}

std::string depthTimesText(const DatasetReader& dataset, const std::vector<std::size_t>& frames) {
    std::string text =
        "# time stamps of the rawlog's depth images\n# timestamp of the frame (colour), of its depth\n";
    bool differ = false;
    for (const std::size_t i : frames) {
        const DatasetEntry& entry = dataset.entry(i);
        differ = differ || entry.timestamp != entry.depth_timestamp;
        text += stampText(entry.timestamp) + " " + stampText(entry.depth_timestamp) + "\n";
    }
    return differ ? text : "";
}

std::optional<double> DepthTimes::of(double colour_timestamp) const {
    const auto found = times.find(roundToMicroseconds(colour_timestamp));
    return found == times.end() ? std::nullopt : std::optional(found->second);
}

DepthTimes readDepthTimes(const std::string& rawlog) {
    DepthTimes out;
    const std::string file = depthTimesFile(rawlog);
    std::error_code unreadable;
    if (!fs::exists(file, unreadable)) return out;
    out.file = file;
    try {
        for (const TextLine& line : readTextLines(file)) {
            const std::string where = file + ":" + std::to_string(line.number);
            if (line.words.size() != 2)
                throw std::runtime_error(where + ": expected two time stamps, found " +
                                         std::to_string(line.words.size()) + " words");
            const double colour = roundToMicroseconds(parseNumber(line.words[0], where));
            const double depth = roundToMicroseconds(parseNumber(line.words[1], where));
            if (!out.times.emplace(colour, depth).second)
                throw std::runtime_error(where + ": this stamp was there before");
        }
    } catch (const std::runtime_error& error) {
        out.times.clear();
        out.fault = error.what();
    }
    return out;
}

std::string depthTimesFault(const std::vector<double>& colour,
                            const std::vector<std::optional<double>>& depth) {
    const auto missing = std::count(depth.begin(), depth.end(), std::nullopt);
    if (missing > 0)
        return "it lacks " + std::to_string(missing) + " of the " + std::to_string(depth.size()) +
               " frames: is it of another recording?";
    std::vector<double> stamps;
    for (const auto& stamp : depth) stamps.push_back(*stamp);
    if (std::adjacent_find(stamps.begin(), stamps.end(), std::greater_equal<>()) != stamps.end())
        return "its depth stamps do not ascend with the frames'";
    const auto matches = associateStamps(colour, stamps, DatasetOptions().max_time_difference);
    const bool same = matches.size() == colour.size() &&
                      std::all_of(matches.begin(), matches.end(),
                                  [](const StampMatch& match) { return match.first == match.second; });
    return same ? "" : "whoever reads the folder would pair its images in another way";
}

}  // namespace roevo
