#include "recordings/numbered_files.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstdio>
#include <ctime>
#include <regex>
#include <stdexcept>
#include <vector>

#include "evaluation/association.h"
#include "recordings/image_lists.h"
#include "recordings/time_units.h"

namespace fs = std::filesystem;

namespace roevo {
namespace {

constexpr double kFirstStamp = 1e9;    // of ten digits: no recording has so many frames
constexpr double kLargestStep = 1000;  // frames that are left out between two
// What a count behind whole seconds looks like, read as their decimals
constexpr double kShortestStep = 1e-4, kBetweenSeconds = 0.5;  // s

bool isDigit(char c) {
    return c >= '0' && c <= '9';
}

struct NamedNumber {
    double value = 0;
    bool decimal = false;   ///< a time, with decimals or as a date
    std::size_t begin = 0;  ///< where it stands in the name
};

/// Where the digits begin that end before `end`.
std::size_t beginOfDigits(const std::string& name, std::size_t end) {
    while (end > 0 && isDigit(name[end - 1])) end--;
    return end;
}

/// A date at the end of a name's numbers ("20240517_123046_033333", "2024-05-17 12-30-46.03"): seconds since
/// 1970.
std::optional<NamedNumber> dateIn(const std::string& name) {
    static const std::regex date(
        "(?:^|[^0-9])((?:19|20)[0-9]{2})[-_.]?(0[1-9]|1[0-2])[-_.]?(0[1-9]|[12][0-9]|3[01])[-_. T]?"
        "([01][0-9]|2[0-3])[-_.:h]?([0-5][0-9])[-_.:m]?([0-5][0-9])"
        "(?:\\.([0-9]+)|[-_]?([0-9]{3}|[0-9]{6}|[0-9]{9}))?[^0-9]*$");
    std::smatch part;
    if (!std::regex_search(name, part, date)) return std::nullopt;
    std::tm day{};
    day.tm_year = std::stoi(part.str(1)) - 1900;
    day.tm_mon = std::stoi(part.str(2)) - 1;
    day.tm_mday = std::stoi(part.str(3));
    day.tm_hour = std::stoi(part.str(4));
    day.tm_min = std::stoi(part.str(5));
    day.tm_sec = std::stoi(part.str(6));
    const double decimals = std::stod("0." + part.str(7) + part.str(8) + "0");
    return NamedNumber{static_cast<double>(timegm(&day)) + decimals, true,
                       static_cast<std::size_t>(part.position(1))};
}

/// Seconds and their decimals as two numbers ("1305031453_359").
std::optional<NamedNumber> secondsIn(const std::string& name) {
    static const std::regex seconds("(?:^|[^0-9])([0-9]{10})[-_]([0-9]{3}|[0-9]{6})[^0-9]*$");
    std::smatch part;
    if (!std::regex_search(name, part, seconds)) return std::nullopt;
    return NamedNumber{std::stod(part.str(1) + "." + part.str(2)), true,
                       static_cast<std::size_t>(part.position(1))};
}

/// The last number in a name, with its decimals. Seconds and nanoseconds of a stamp ("1305031453_359684000")
/// are one.
std::optional<NamedNumber> lastNumber(const std::string& name) {
    constexpr std::size_t kSeconds = 10, kNanoseconds = 9, kLongest = 60;  // digits
    std::size_t end = name.size();
    while (end > 0 && !isDigit(name[end - 1])) end--;
    NamedNumber out;
    out.begin = beginOfDigits(name, end);
    if (out.begin == end) return std::nullopt;
    std::string digits = name.substr(out.begin, std::min(end - out.begin, kLongest));
    if (const std::size_t begin = out.begin; begin > 1) {
        const std::size_t whole = beginOfDigits(name, begin - 1);
        const char between = name[begin - 1];
        out.decimal = whole < begin - 1 &&
                      (between == '.' || ((between == '_' || between == '-') &&
                                          begin - 1 - whole == kSeconds && end - begin == kNanoseconds));
        if (out.decimal) {
            digits = name.substr(whole, std::min(begin - 1 - whole, kLongest)) + "." + digits;
            out.begin = whole;
        }
    }
    out.value = std::stod(digits);
    return out;
}

/// What all names end with from a letter or sign on: "_640x480".
std::string commonEnding(const NamedImages& files) {
    std::string ending = files.begin()->first;
    for (const auto& [name, file] : files) {
        const auto differing =
            std::mismatch(ending.rbegin(), ending.rend(), name.rbegin(), name.rend()).first;
        ending.erase(ending.begin(), differing.base());
    }
    ending.erase(ending.begin(), std::find_if_not(ending.begin(), ending.end(), isDigit));
    return ending;
}

/// A name's numbers before a place in it.
std::vector<double> numbersBefore(const std::string& name, std::size_t end) {
    std::vector<double> out;
    for (auto number = lastNumber(name.substr(0, end)); number;
         number = lastNumber(name.substr(0, number->begin)))
        out.push_back(number->value);
    return out;
}

/// One kind of image, ascending.
struct Numbered {
    std::vector<ListEntry> images;  ///< with the number where the time belongs
    bool stamps = false;            ///< the numbers are times

    Numbered(const NamedImages& files, AssociationReport& report) {
        for (const auto& [name, file] : files)
            if (!lastNumber(name))
                throw std::runtime_error(file +
                                         ": no time in its name: expected a number or a time in seconds");
        const std::string ending = commonEnding(files);
        const auto beforeEnding = [&](const std::string& name) {
            return lastNumber(name.substr(0, name.size() - ending.size()));
        };
        if (!take(files, dateIn) && !take(files, lastNumber) && !take(files, secondsIn) &&
            !take(files, beforeEnding))
            throw std::runtime_error(
                files.begin()->second +
                ": which number in its name is the time? By the last one, others of these "
                "images go forward and back: name them by one number or time, or list "
                "them (rgb.txt and depth.txt, or --associations)");
        // By name "10" comes before "9": that is no disorder of a list
        std::stable_sort(images.begin(), images.end(),
                         [](const ListEntry& a, const ListEntry& b) { return a.timestamp < b.timestamp; });
        sortByTime(images, report);
        if (2 * images.size() < files.size())
            throw std::runtime_error(images.front().file + ": " + std::to_string(files.size()) +
                                     " images like it have but " + std::to_string(images.size()) +
                                     " different times in their names");
        const bool far_apart = images.size() > 1 && images.back().timestamp - images.front().timestamp >
                                                        kLargestStep * static_cast<double>(images.size() - 1);
        stamps = decimal || far_apart || images.back().timestamp >= kFirstStamp;
    }

    void toSeconds(double rate, DatasetDescription& out) {
        const double unit = stamps ? unitOfImages(stampsOf(images), out) : rate;
        for (ListEntry& image : images) image.timestamp /= unit;
    }

  private:
    bool decimal = false;

    /// Reads all names in one way. @return false where that cannot be: one has no such number; another number
    /// goes back in the order of those that are not surely times or a count; or a count stands behind dates
    template <class Read>
    bool take(const NamedImages& files, const Read& read) {
        images.clear();
        decimal = false;
        std::string by_number;  // the first that is
        std::vector<std::pair<double, std::vector<double>>> order;
        for (const auto& [name, file] : files) {
            const std::optional<NamedNumber> number = read(name);
            if (!number) return false;
            decimal = decimal || number->decimal;
            if (!number->decimal && number->value < kFirstStamp && by_number.empty()) by_number = file;
            images.push_back({number->value, file});
            order.emplace_back(number->value, numbersBefore(name, number->begin));
        }
        if (decimal && !by_number.empty())
            throw std::runtime_error(by_number + ": some images are named by number, others by time");
        std::sort(order.begin(), order.end());
        const bool times = order.front().first >= kFirstStamp;
        bool count = !decimal, counted_behind = decimal, together = false;
        for (std::size_t i = 1; i < order.size(); i++) {
            const double step = order[i].first - order[i - 1].first;
            count = count && step == 1;
            together = together || (step > 0 && step < kShortestStep);
            counted_behind = counted_behind && step > 0 && (step < kShortestStep || step > kBetweenSeconds);
        }
        if (counted_behind && together) return false;
        for (std::size_t i = 1; i < order.size() && !times && !count; i++) {
            const auto &before = order[i - 1].second, &now = order[i].second;
            if (order[i].first == order[i - 1].first && now != before) return false;
            for (std::size_t k = 0; k < std::min(before.size(), now.size()); k++)
                if (now[k] < before[k]) return false;
        }
        return true;
    }
};

/// Whether it is plain that numbers belong together that are not the same: both without gaps, as many of
/// each.
bool areOneApart(const std::vector<ListEntry>& colours, const std::vector<ListEntry>& depths) {
    const auto unbroken = [](const std::vector<ListEntry>& images) {
        return images.back().timestamp - images.front().timestamp == static_cast<double>(images.size() - 1);
    };
    return colours.size() == depths.size() && unbroken(colours) && unbroken(depths) &&
           std::abs(colours.front().timestamp - depths.front().timestamp) == 1;
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

NamedImages imagesIn(const fs::path& folder) {
    NamedImages images;
    std::error_code fault;
    const fs::directory_iterator entries(folder, fault);
    if (fault) throw std::runtime_error("cannot read folder " + folder.string() + ": " + fault.message());
    constexpr const char* kEndings[] = {".png", ".jpg",  ".jpeg", ".ppm", ".pgm",
                                        ".tif", ".tiff", ".bmp",  ".exr", ".npy"};
    for (const auto& entry : entries) {
        std::string ending = entry.path().extension().string();
        std::transform(ending.begin(), ending.end(), ending.begin(),
                       [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
        const bool image = std::find(std::begin(kEndings), std::end(kEndings), ending) != std::end(kEndings);
        if (!image || entry.path().filename().string().front() == '.') continue;
        const auto [at, fresh] = images.emplace(entry.path().stem().string(), entry.path().string());
        if (!fresh) at->second = std::min(at->second, entry.path().string());  // in whatever order they come
    }
    return images;
}

void requireImages(const NamedImages& images, const std::string& place) {
    if (images.empty()) throw std::runtime_error(place + " has no images in it");
}

std::string pairByName(const NamedImages& colour_files, const NamedImages& depth_files, double rate,
                       double max_difference, DatasetDescription& out) {
    Numbered colours(colour_files, out.association), depths(depth_files, out.association);
    if (colours.stamps != depths.stamps)
        throw std::runtime_error(depths.images.front().file +
                                 ": some images are named by number, others by time (" +
                                 fs::path(colours.images.front().file).filename().string() + ")");
    if (!colours.stamps && areOneApart(colours.images, depths.images))
        out.notes.push_back(
            "warning: as many colour as depth images, and one kind is numbered from one more than the other: "
            "if the first ones belong together, every pair is a frame off; number both alike");
    colours.toSeconds(rate, out);
    depths.toSeconds(rate, out);
    matchEntries(colours.images, depths.images, colours.stamps ? max_difference : 0, out);
    out.frame_rate = colours.stamps ? 0 : rate;
    char text[100];
    std::snprintf(text, sizeof text, "times are frame numbers at %g Hz", rate);
    return colours.stamps ? "times are in the file names" : text;
}

}  // namespace roevo
