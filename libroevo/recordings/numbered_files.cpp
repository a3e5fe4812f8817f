#include "recordings/numbered_files.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstdio>
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

bool isDigit(char c) {
    return c >= '0' && c <= '9';
}

struct NamedNumber {
    double value = 0;
    bool decimal = false;
};

/// Where the digits begin that end before `end`.
std::size_t beginOfDigits(const std::string& name, std::size_t end) {
    while (end > 0 && isDigit(name[end - 1])) end--;
    return end;
}

/// The last number in a name, with its decimals. Seconds and nanoseconds of a stamp ("1305031453_359684000")
/// are one.
std::optional<NamedNumber> lastNumber(const std::string& name) {
    constexpr std::size_t kSeconds = 10, kNanoseconds = 9, kLongest = 60;  // digits
    std::size_t end = name.size();
    while (end > 0 && !isDigit(name[end - 1])) end--;
    std::size_t begin = beginOfDigits(name, end);
    if (begin == end) return std::nullopt;
    std::string digits = name.substr(begin, std::min(end - begin, kLongest));
    NamedNumber out;
    if (begin > 1) {
        const std::size_t whole = beginOfDigits(name, begin - 1);
        const char between = name[begin - 1];
        out.decimal = whole < begin - 1 &&
                      (between == '.' || ((between == '_' || between == '-') &&
                                          begin - 1 - whole == kSeconds && end - begin == kNanoseconds));
        if (out.decimal) digits = name.substr(whole, std::min(begin - 1 - whole, kLongest)) + "." + digits;
    }
    out.value = std::stod(digits);
    return out;
}

/// One kind of image, ascending.
struct Numbered {
    std::vector<ListEntry> images;  ///< with the number where the time belongs
    bool stamps = false;            ///< the numbers are times

    Numbered(const NamedImages& files, AssociationReport& report) {
        bool decimal = false;
        std::string by_number;  // the first that is
        for (const auto& [name, file] : files) {
            const auto number = lastNumber(name);
            if (!number)
                throw std::runtime_error(file +
                                         ": no time in its name: expected a number or a time in seconds");
            decimal = decimal || number->decimal;
            if (!number->decimal && number->value < kFirstStamp && by_number.empty()) by_number = file;
            images.push_back({number->value, file});
        }
        if (decimal && !by_number.empty())
            throw std::runtime_error(by_number + ": some images are named by number, others by time");
        // By name "10" comes before "9": that is no disorder of a list
        std::stable_sort(images.begin(), images.end(),
                         [](const ListEntry& a, const ListEntry& b) { return a.timestamp < b.timestamp; });
        sortByTime(images, report);
        const bool far_apart = images.size() > 1 && images.back().timestamp - images.front().timestamp >
                                                        kLargestStep * static_cast<double>(images.size() - 1);
        stamps = decimal || far_apart || images.back().timestamp >= kFirstStamp;
    }

    void toSeconds(double rate) {
        const double unit = stamps ? unitOfStamps(stampsOf(images)) : rate;
        for (ListEntry& image : images) image.timestamp /= unit;
    }
};

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
    colours.toSeconds(rate);
    depths.toSeconds(rate);
    matchEntries(colours.images, depths.images, colours.stamps ? max_difference : 0, out);
    out.frame_rate = colours.stamps ? 0 : rate;
    char text[100];
    std::snprintf(text, sizeof text, "times are frame numbers at %g Hz", rate);
    return colours.stamps ? "times are in the file names" : text;
}

}  // namespace roevo
