#include "datasets/tum.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <stdexcept>

#include "datasets/camera_file.h"
#include "datasets/sensor_files.h"
#include "datasets/text_list.h"
#include "roevo_mrpt/time_conversions.h"

namespace fs = std::filesystem;

namespace roevo {
namespace {

struct Lists {
    std::vector<ListEntry> colour, depth;
};

std::vector<double> stamps(const std::vector<ListEntry>& list) {
    std::vector<double> out;
    for (const ListEntry& entry : list) out.push_back(entry.timestamp);
    return out;
}

/// Smallest difference between any two stamps of the lists, for the message when nothing matches.
double smallestDifference(const std::vector<double>& a, const std::vector<double>& b) {
    double smallest = INFINITY;
    for (const double t : a) {
        const auto next = std::lower_bound(b.begin(), b.end(), t);
        if (next != b.end()) smallest = std::min(smallest, *next - t);
        if (next != b.begin()) smallest = std::min(smallest, t - *(next - 1));
    }
    return smallest;
}

void matchLists(const fs::path& folder, const Lists& lists, double max_difference, DatasetDescription& out) {
    const auto colour = stamps(lists.colour), depth = stamps(lists.depth);
    for (const StampMatch& match : associateStamps(colour, depth, max_difference)) {
        const ListEntry &c = lists.colour[match.first], &d = lists.depth[match.second];
        out.frames.push_back(
            {c.timestamp, d.timestamp, (folder / c.file).string(), (folder / d.file).string()});
    }
    if (out.frames.empty()) {
        char text[200];
        std::snprintf(text, sizeof text,
                      ": no colour image has a depth image within %g s (%zu colour, %zu depth images, "
                      "closest pair %.3g s apart)",
                      max_difference, colour.size(), depth.size(), smallestDifference(colour, depth));
        throw std::runtime_error(folder.string() + text);
    }
    out.association.dropped_colour = colour.size() - out.frames.size();
    out.association.dropped_depth = depth.size() - out.frames.size();
}

/// Pairs that somebody else matched: "t file t file", colour first or depth first.
void readAssociations(const fs::path& folder, const fs::path& file, DatasetDescription& out) {
    for (const TextLine& line : readTextLines(file.string())) {
        const std::string where = file.string() + ":" + std::to_string(line.number);
        if (line.words.size() != 4)
            throw std::runtime_error(where + ": expected 'timestamp image timestamp depth_image'");
        DatasetEntry entry{parseNumber(line.words[0], where), parseNumber(line.words[2], where),
                           (folder / line.words[1]).string(), (folder / line.words[3]).string()};
        if (line.words[1].rfind("depth", 0) == 0) {
            std::swap(entry.timestamp, entry.depth_timestamp);
            std::swap(entry.image, entry.depth);
        }
        out.frames.push_back(std::move(entry));
    }
    if (out.frames.empty()) throw std::runtime_error(file.string() + " lists no images");
    const auto earlier = [](const DatasetEntry& a, const DatasetEntry& b) {
        return a.timestamp < b.timestamp;
    };
    const auto same = [](const DatasetEntry& a, const DatasetEntry& b) { return a.timestamp == b.timestamp; };
    std::stable_sort(out.frames.begin(), out.frames.end(), earlier);
    const auto last = std::unique(out.frames.begin(), out.frames.end(), same);
    out.association.duplicates += static_cast<std::size_t>(out.frames.end() - last);
    out.frames.erase(last, out.frames.end());
}

CameraDescription findCamera(const fs::path& folder) {
    if (fs::exists(folder / "camera.txt")) return readCameraFile((folder / "camera.txt").string());
    const std::string name = fs::weakly_canonical(folder).filename().string();
    if (auto found = tumCameraNamedIn(name)) {
        found->source += " (named by the folder)";
        return *found;
    }
    for (const char* list : {"rgb.txt", "depth.txt", "groundtruth.txt"})
        if (auto found = tumCameraNamedIn(readHeaderComments((folder / list).string()))) {
            found->source += std::string(" (named by ") + list + ")";
            return *found;
        }
    throw std::runtime_error(
        "no intrinsics: " + folder.string() +
        " has no camera.txt and is not named as a freiburg1, 2 or 3 sequence; write camera.txt with width, "
        "height, fx, fy, cx, cy, depth_scale");
}

}  // namespace

bool isTumFolder(const std::string& folder) {
    for (const char* list : {"rgb.txt", "depth.txt", "associations.txt"})
        if (fs::is_regular_file(fs::path(folder) / list)) return true;
    return false;
}

DatasetDescription loadTum(const std::string& folder_name, const DatasetOptions& options) {
    const fs::path folder(folder_name);
    DatasetDescription out;
    out.folder = folder_name;
    out.format = "tum";

    const bool has_colour = fs::exists(folder / "rgb.txt"), has_depth = fs::exists(folder / "depth.txt");
    if (has_colour && has_depth) {
        Lists lists;
        lists.colour = readStampedList((folder / "rgb.txt").string(), out.association.duplicates);
        lists.depth = readStampedList((folder / "depth.txt").string(), out.association.duplicates);
        matchLists(folder, lists, options.max_time_difference, out);
    } else if (fs::exists(folder / "associations.txt")) {
        readAssociations(folder, folder / "associations.txt", out);
    } else {
        throw std::runtime_error(folder_name + " has no " + (has_colour ? "depth.txt" : "rgb.txt") +
                                 ": not a whole TUM sequence");
    }

    for (std::size_t i = 0; i < out.frames.size(); i++) {
        DatasetEntry& frame = out.frames[i];
        frame.timestamp = roundToMicroseconds(frame.timestamp);
        frame.depth_timestamp = roundToMicroseconds(frame.depth_timestamp);
        AssociationReport& report = out.association;
        report.largest_difference =
            std::max(report.largest_difference, std::abs(frame.timestamp - frame.depth_timestamp));
        if (i > 0)
            report.largest_gap = std::max(report.largest_gap, frame.timestamp - out.frames[i - 1].timestamp);
    }
    out.association.matched = out.frames.size();

    const CameraDescription camera = findCamera(folder);
    out.camera = camera.camera;
    out.depth_scale = camera.depth_scale;
    out.camera_source = camera.source;
    out.ground_truth = readGroundTruth((folder / "groundtruth.txt").string());
    readAccelerometer((folder / "accelerometer.txt").string(), out);
    return out;
}

}  // namespace roevo
