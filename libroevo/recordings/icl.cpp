#include "recordings/icl.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <map>
#include <stdexcept>

#include "programs/text.h"
#include "recordings/given_camera.h"
#include "recordings/handedness.h"
#include "recordings/image_lists.h"
#include "recordings/numbered_files.h"
#include "recordings/sensor_files.h"
#include "recordings/text_list.h"
#include "recordings/time_units.h"
#include "roevo_mrpt/time_conversions.h"

namespace fs = std::filesystem;

namespace roevo {
namespace {

constexpr double kRenderedRate = 30;  // Hz, the rate at which the dataset was rendered

std::vector<fs::path> trajectoriesIn(const fs::path& folder) {
    std::vector<fs::path> found;
    for (const auto& entry : fs::directory_iterator(folder))
        if (entry.path().extension() == ".freiburg") found.push_back(entry.path());
    std::sort(found.begin(), found.end());
    return found;
}

/// "7 depth/7.png 7 rgb/7.png": numbers for times, which the files are named by.
bool isNumbered(const fs::path& associations) {
    for (const TextLine& line : readTextLines(associations.string())) {
        if (line.words.size() != 4) return false;
        for (const std::size_t i : {0, 2}) {
            const auto index = wholeNumber(line.words[i]);
            const auto name = wholeNumber(fs::path(line.words[i + 1]).stem().string());
            if (!index || index != name) return false;
        }
        return true;
    }
    return false;
}

/// Whether anything but the numbering speaks for ICL-NUIM, as its camera must not be given to other data:
/// its ground truth, or depth named before colour in the list.
bool isSurelyIcl(const fs::path& folder) {
    if (!trajectoriesIn(folder).empty()) return true;
    const fs::path associations = folder / "associations.txt";
    if (fs::exists(associations))
        for (const TextLine& line : readTextLines(associations.string()))
            return line.words.size() > 1 && line.words[1].find("depth") != std::string::npos;
    return false;
}

CameraDescription customaryCamera(const std::string& folder, const DatasetOptions& options) {
    if (options.format != "icl" && !isSurelyIcl(folder))
        throw std::runtime_error("no intrinsics: " + folder +
                                 " counts frames as ICL-NUIM does, but nothing else says that it is: write "
                                 "camera.txt (or give --format icl for ICL-NUIM's camera)");
    CameraDescription out;
    out.camera = {640, 480, 481.2, 480.0, 319.5, 239.5, {}};
    out.source = "the published ICL-NUIM camera (fy = -480 there: rows are counted downwards here, so +480)";
    return out;
}

/// Frames whose time is that of a pose, to the microsecond.
std::size_t framesWithPose(const DatasetDescription& dataset) {
    std::size_t count = 0;
    for (const DatasetEntry& frame : dataset.frames)
        for (const StampedPose& pose : dataset.ground_truth.poses)
            if (pose.timestamp == frame.timestamp) {
                count++;
                break;
            }
    return count;
}

void findGroundTruth(DatasetDescription& out) {
    const fs::path folder(out.folder);
    auto files = trajectoriesIn(folder);
    if (files.empty() && fs::exists(folder / "groundtruth.txt")) files.push_back(folder / "groundtruth.txt");
    if (files.empty()) return;
    if (files.size() > 1) {
        out.notes.push_back(
            "ground truth: " + std::to_string(files.size()) + " trajectories (" +
            files[0].filename().string() + ", " + files[1].filename().string() +
            " …), none taken: leave only this sequence's in the folder, or name it by --ground-truth");
        return;
    }
    out.ground_truth = readGroundTruth(files[0].string());
}

}  // namespace

void convertIclTruth(DatasetDescription& out) {
    GroundTruth& truth = out.ground_truth;
    truth.copyable = false;
    const double first = truth.poses.front().timestamp, last = truth.poses.back().timestamp;
    const bool as_published = numbersToSeconds(out);
    settleClock(out);

    HandednessResult told = compareHandedness(out);
    if (!told.decided) told.mirrored = as_published;
    char text[300];
    if (told.mirrored) mirrorY(truth.poses);
    std::snprintf(
        text, sizeof text,
        "entries %g to %g, for %zu of %zu frames; %s (%s: depth misses by %.2g %% as it is, %.2g %% "
        "mirrored)",
        first, last, framesWithPose(out), out.frames.size(),
        told.mirrored ? "left-handed, mirrored in y to fit the positive fy" : "right-handed, taken as it is",
        told.decided   ? "told by the depth images"
        : as_published ? "assumed as published, the depth images do not tell"
                       : "the depth images do not tell, and its times are not the published numbers",
        100 * told.error_as_is, 100 * told.error_mirrored);
    truth.note = text;
}

bool isIclFolder(const std::string& folder_name) {
    const fs::path folder(folder_name);
    for (const char* list : {"rgb.txt", "depth.txt"})
        if (fs::exists(folder / list)) return false;
    if (fs::is_regular_file(folder / "associations.txt")) return isNumbered(folder / "associations.txt");
    return fs::is_directory(folder / "rgb") && fs::is_directory(folder / "depth") &&
           !trajectoriesIn(folder).empty();
}

DatasetDescription loadIcl(const std::string& folder_name, const DatasetOptions& options) {
    const fs::path folder(folder_name);
    DatasetDescription out;
    out.folder = folder_name;
    out.format = "icl";
    const auto given = givenCamera(folder_name, options.folder);
    out.frame_rate = frameRate({}, given, kRenderedRate);
    if (fs::exists(folder / "associations.txt")) {
        readAssociations("associations.txt", options.max_time_difference, out);
        for (const DatasetEntry& frame : out.frames)
            if (!isFrameNumber(frame.timestamp) || !isFrameNumber(frame.depth_timestamp))
                throw std::runtime_error((folder / "associations.txt").string() +
                                         ": ICL-NUIM counts frames in whole numbers; these are times "
                                         "(--format tum reads them)");
        for (DatasetEntry& frame : out.frames) {
            frame.timestamp /= out.frame_rate;
            frame.depth_timestamp /= out.frame_rate;
        }
    } else if (fs::is_directory(folder / "rgb") && fs::is_directory(folder / "depth")) {
        const NamedImages colours = imagesIn(folder / "rgb"), depths = imagesIn(folder / "depth");
        requireImages(colours, (folder / "rgb").string());
        requireImages(depths, (folder / "depth").string());
        pairByName(colours, depths, out.frame_rate, options.max_time_difference, out);
        if (!(out.frame_rate > 0))
            throw std::runtime_error(
                folder_name +
                ": ICL-NUIM counts frames in whole numbers; its images are named by times "
                "(--format plain reads them)");
        out.notes.push_back("no associations.txt: colour and depth were paired by file name");
    } else {
        throw std::runtime_error(folder_name + " has no associations.txt, nor rgb/ and depth/");
    }
    finishFrames(out);
    out.notes.push_back("times are frame numbers at " + plainNumber(out.frame_rate) + " Hz");
    setCamera(given ? *given : customaryCamera(folder_name, options), out);
    if (options.ground_truth.empty()) findGroundTruth(out);
    return out;
}

}  // namespace roevo
