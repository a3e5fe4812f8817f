#include "recordings/numbered_files.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstdio>
#include <map>
#include <stdexcept>

namespace fs = std::filesystem;

namespace roevo {
namespace {

bool isDigit(char c) {
    return c >= '0' && c <= '9';
}

/// Image files by name without ending. Hidden files (of file managers) are none.
std::map<std::string, std::string> imagesIn(const fs::path& folder) {
    std::map<std::string, std::string> images;
    std::error_code fault;
    const fs::directory_iterator entries(folder, fault);
    if (fault) throw std::runtime_error("cannot read folder " + folder.string() + ": " + fault.message());
    for (const auto& entry : entries) {
        std::string ending = entry.path().extension().string();
        std::transform(ending.begin(), ending.end(), ending.begin(),
                       [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
        const bool image = ending == ".png" || ending == ".jpg" || ending == ".jpeg" || ending == ".ppm" ||
                           ending == ".pgm" || ending == ".tif" || ending == ".tiff" || ending == ".bmp";
        if (image && entry.path().filename().string().front() != '.')
            images[entry.path().stem().string()] = entry.path().string();
    }
    if (images.empty()) throw std::runtime_error(folder.string() + " has no images in it");
    return images;
}

/// Digits, a point, digits.
std::optional<double> decimalNumber(const std::string& word) {
    const std::size_t point = word.find('.');
    if (point == std::string::npos || point == 0 || point + 1 == word.size()) return std::nullopt;
    for (std::size_t i = 0; i < word.size(); i++)
        if (i != point && !isDigit(word[i])) return std::nullopt;
    return std::stod(word);
}

/// The digits that a name ends with.
std::optional<long long> trailingNumber(const std::string& name) {
    std::size_t begin = name.size();
    while (begin > 0 && isDigit(name[begin - 1])) begin--;
    return wholeNumber(name.substr(begin));
}

constexpr long long kFirstStamp = 1000000000;  // of ten digits: no recording has so many frames
constexpr double kYear2100 = 4.1e9;            // s

double secondsFromStamp(long long stamp) {
    double seconds = static_cast<double>(stamp), unit = 1;
    while (seconds / unit > kYear2100) unit *= 1000;
    return seconds / unit;
}

}  // namespace

std::optional<long long> wholeNumber(const std::string& word) {
    if (word.empty() || word.size() > 18 + 1 || !std::all_of(word.begin(), word.end(), isDigit))
        return std::nullopt;
    try {
        return std::stoll(word);
    } catch (const std::out_of_range&) {
        return std::nullopt;
    }
}

std::string pairByName(const fs::path& colour_folder, const fs::path& depth_folder, double rate,
                       DatasetDescription& out) {
    const auto colours = imagesIn(colour_folder), depths = imagesIn(depth_folder);
    bool numbers = false, stamps = false;
    for (const auto& [name, file] : colours) {
        const auto depth = depths.find(name);
        if (depth == depths.end()) continue;
        DatasetEntry entry;
        if (const auto seconds = decimalNumber(name)) {
            entry.timestamp = *seconds;
            stamps = true;
        } else if (const auto number = trailingNumber(name)) {
            const bool stamp = *number >= kFirstStamp;
            entry.timestamp = stamp ? secondsFromStamp(*number) : static_cast<double>(*number) / rate;
            (stamp ? stamps : numbers) = true;
        } else {
            throw std::runtime_error(file + ": no time in its name: expected a number or a time in seconds");
        }
        if (numbers && stamps)
            throw std::runtime_error(file + ": some images are named by number, others by time");
        entry.depth_timestamp = entry.timestamp;
        entry.image = file;
        entry.depth = depth->second;
        out.frames.push_back(std::move(entry));
    }
    if (out.frames.empty())
        throw std::runtime_error("no image in " + colour_folder.string() + " has the name of one in " +
                                 depth_folder.string() + " (" +
                                 fs::path(colours.begin()->second).filename().string() + ", " +
                                 fs::path(depths.begin()->second).filename().string() + " …)");
    out.association.dropped_colour = colours.size() - out.frames.size();
    out.association.dropped_depth = depths.size() - out.frames.size();
    // By name "10" comes before "9": that is no disorder of a list
    std::stable_sort(out.frames.begin(), out.frames.end(),
                     [](const DatasetEntry& a, const DatasetEntry& b) { return a.timestamp < b.timestamp; });
    char text[100];
    std::snprintf(text, sizeof text, "times are frame numbers at %g Hz", rate);
    return numbers ? text : "times are in the file names";
}

}  // namespace roevo
