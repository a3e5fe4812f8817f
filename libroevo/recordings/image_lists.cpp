#include "recordings/image_lists.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <stdexcept>
#include <utility>

#include "evaluation/association.h"
#include "recordings/text_list.h"
#include "recordings/time_units.h"
#include "roevo_mrpt/time_conversions.h"

namespace fs = std::filesystem;

namespace roevo {

void matchEntries(const std::vector<ListEntry>& colours, const std::vector<ListEntry>& depths,
                  double max_difference, DatasetDescription& out) {
    const auto colour = stampsOf(colours), depth = stampsOf(depths);
    for (const StampMatch& match : associateStamps(colour, depth, max_difference)) {
        const ListEntry &c = colours[match.first], &d = depths[match.second];
        out.frames.push_back({c.timestamp, d.timestamp, c.file, d.file});
    }
    if (out.frames.empty()) {
        char text[200];
        std::snprintf(text, sizeof text,
                      ": no colour image has a depth image within %g s (%zu colour, %zu depth images, "
                      "closest pair %.3g s apart)",
                      max_difference, colour.size(), depth.size(), smallestDifference(colour, depth));
        throw std::runtime_error(out.folder + text);
    }
    out.association.dropped_colour = colour.size() - out.frames.size();
    out.association.dropped_depth = depth.size() - out.frames.size();
}

namespace {

/// sortByTime() of what a list has, with a warning where many stamps are there more than once.
/// @throws std::runtime_error where most are
template <class Entry>
void sortList(const std::string& file, std::vector<Entry>& entries, DatasetDescription& out) {
    const std::size_t listed = entries.size();
    sortByTime(entries, out.association);
    const std::size_t repeated = listed - entries.size();
    const std::string lines = std::to_string(repeated) + " of " + std::to_string(listed) + " lines";
    if (2 * entries.size() < listed)
        throw std::runtime_error(file + ": " + lines +
                                 " repeat a time stamp: was it written with too few digits?");
    if (10 * repeated >= listed)
        out.notes.push_back("warning: " + lines + " of " + fs::path(file).filename().string() +
                            " repeat a time stamp and are left out: was it written with too few digits?");
}

}  // namespace

void matchLists(const std::string& colour_list, const std::string& depth_list, double max_difference,
                DatasetDescription& out) {
    const auto read = [&](const std::string& name) {
        const std::string file = (fs::path(out.folder) / name).string();
        auto entries = readStampedList(file);
        if (entries.empty()) throw std::runtime_error(file + " lists no images");
        const double unit = unitOfImages(stampsOf(entries), out);
        for (ListEntry& entry : entries) {
            entry.timestamp /= unit;
            entry.file = (fs::path(out.folder) / entry.file).string();
        }
        sortList(file, entries, out);
        return entries;
    };
    const auto colours = read(colour_list), depths = read(depth_list);
    matchEntries(colours, depths, max_difference, out);
}

namespace {

DatasetEntry pairOn(const TextLine& line, const fs::path& folder, const std::string& where) {
    if (line.words.size() != 4)
        throw std::runtime_error(where + ": expected 'timestamp image timestamp depth_image'");
    DatasetEntry entry{parseNumber(line.words[0], where), parseNumber(line.words[2], where),
                       (folder / parseFileName(line.words[1], where)).string(),
                       (folder / parseFileName(line.words[3], where)).string()};
    if (line.words[1].find("depth") != std::string::npos &&
        line.words[3].find("depth") == std::string::npos) {
        std::swap(entry.timestamp, entry.depth_timestamp);
        std::swap(entry.image, entry.depth);
    }
    return entry;
}

}  // namespace

void readAssociations(const std::string& file_name, double max_difference, DatasetDescription& out) {
    const std::string file = (fs::path(out.folder) / file_name).string();
    std::vector<DatasetEntry> pairs;
    for (const TextLine& line : readTable(file))
        pairs.push_back(pairOn(line, out.folder, file + ":" + std::to_string(line.number)));
    if (pairs.empty()) throw std::runtime_error(file + " lists no images");
    const double unit = out.format == "icl" ? 1 : unitOfImages(stampsOf(pairs), out);  // which counts frames
    sortList(file, pairs, out);
    double closest = INFINITY;
    for (DatasetEntry& entry : pairs) {
        entry.timestamp /= unit;
        entry.depth_timestamp /= unit;
        const double difference = std::abs(entry.timestamp - entry.depth_timestamp);
        closest = std::min(closest, difference);
        if (difference > max_difference) {
            ++out.association.dropped_colour;
            ++out.association.dropped_depth;
            continue;
        }
        out.frames.push_back(std::move(entry));
    }
    if (!out.frames.empty()) return;
    char text[120];
    std::snprintf(text, sizeof text, ": no pair is within %g s, the closest is %.3g s apart", max_difference,
                  closest);
    throw std::runtime_error(file + text);
}

void finishFrames(DatasetDescription& out) {
    AssociationReport& report = out.association;
    for (DatasetEntry& frame : out.frames) {
        frame.timestamp = roundToMicroseconds(frame.timestamp);
        frame.depth_timestamp = roundToMicroseconds(frame.depth_timestamp);
    }
    sortByTime(out.frames, report);
    report.largest_difference = report.largest_gap = 0;
    for (std::size_t i = 0; i < out.frames.size(); i++) {
        const DatasetEntry& frame = out.frames[i];
        report.largest_difference =
            std::max(report.largest_difference, std::abs(frame.timestamp - frame.depth_timestamp));
        if (i > 0)
            report.largest_gap = std::max(report.largest_gap, frame.timestamp - out.frames[i - 1].timestamp);
    }
    report.matched = out.frames.size();
}

}  // namespace roevo
