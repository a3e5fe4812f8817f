#include "recordings/dataset_reader.h"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <numeric>
#include <stdexcept>
#include <utility>

#include "evaluation/association.h"
#include "programs/program.h"
#include "programs/text.h"
#include "recordings/bags/bag_dataset.h"
#include "recordings/depth_scale.h"
#include "recordings/eth3d.h"
#include "recordings/facts.h"
#include "recordings/icl.h"
#include "recordings/lens.h"
#include "recordings/phone.h"
#include "recordings/plain.h"
#include "recordings/scannet.h"
#include "recordings/sensor_files.h"
#include "recordings/seven_scenes.h"
#include "recordings/time_units.h"
#include "recordings/tum.h"
#include "roevo/camera/depth_registration.h"
#include "roevo_mrpt/image_conversions.h"
#include "roevo_mrpt/observation_converter.h"

namespace fs = std::filesystem;

namespace roevo {
namespace {

constexpr std::size_t kMostEmpty = 30;     // images without any depth before that is said
constexpr double kUnitsOfFloats = 5000;    // per metre, that depth images of floats are rounded to
constexpr double kUnitsOfIntegers = 1000;  // per metre, where nobody tells: mm

struct Format {
    const char* name;
    bool (*recognises)(const std::string& folder);
    DatasetDescription (*load)(const std::string& folder, const DatasetOptions& options);
    const char* needs;
    /// Turns the ground truth of this format into poses as GroundTruth wants them; null: it has those.
    void (*convert_truth)(DatasetDescription& dataset) = nullptr;
};

/// The more particular layouts come first.
const Format kFormats[] = {
    {"7scenes", &isSevenScenesFolder, &loadSevenScenes, "frame-000000.color.png, .depth.png, .pose.txt"},
    {"eth3d", &isEth3dFolder, &loadEth3d, "calibration.txt and associated.txt, or rgb.txt and depth.txt"},
    {"scannet", &isScanNetFolder, &loadScanNet, "color/, depth/ and intrinsic/intrinsic_color.txt"},
    {"stray", &isStrayFolder, &loadStray, "rgb/ (or rgb.mp4), depth/, camera_matrix.csv and odometry.csv"},
    {"record3d", &isRecord3dFolder, &loadRecord3d, "rgb/, depth/ and metadata or metadata.json with K"},
    {"icl", &isIclFolder, &loadIcl, "associations.txt with whole numbers for times, files named alike",
     &convertIclTruth},
    {"tum", &isTumFolder, &loadTum, "rgb.txt and depth.txt, or associations.txt"},
    {"plain", &isPlainFolder, &loadPlain,
     "camera.txt or another calibration, rgb/ or color/, and depth/, with numbers or times for names"},
    {"bag", &isBag, &loadBag,
     "a .bag of ROS 1; of ROS 2 .db3 or .mcap, or the folder of metadata.yaml with them"},
};

/// With the rights that opening a file has (access() looks at the real user's).
bool isPermitted(const std::string& path, int rights) {
    return faccessat(AT_FDCWD, path.c_str(), rights, AT_EACCESS) == 0;
}

/// A folder one level down that would have been right: people often give the parent.
std::string betterFolder(const std::string& folder) {
    std::string better;
    for (const auto& entry : fs::directory_iterator(folder, fs::directory_options::skip_permission_denied)) {
        std::error_code unreadable;
        const std::string path = entry.path().string();
        if (!entry.is_directory(unreadable) || !isPermitted(path, R_OK | X_OK)) continue;
        for (const Format& format : kFormats) {
            try {
                if (format.recognises(path) && (better.empty() || path < better)) better = path;
            } catch (const std::exception&) {
                // A guess need not say what keeps it from looking
            }
        }
    }
    return better;
}

}  // namespace

DatasetReader::DatasetReader(DatasetDescription description, bool tolerate_missing)
    : description_(std::move(description)) {
    if (description_.registration)
        T_colour_depth_ = colourFromDepthAsStored(description_.registration->T_colour_depth.inverse());
    too_far_.resize(description_.frames.size());
    checkFiles(tolerate_missing);
    checkDepthScale();
}

float DatasetReader::depthUnit() const {
    return roevo::depthUnit(description_.depth_scale);
}

void DatasetReader::checkFiles(bool tolerate_missing) {
    if (description_.images) return;
    std::size_t missing = 0;
    std::string first_missing;
    for (const DatasetEntry& frame : description_.frames)
        for (const std::string* file : {&frame.image, &frame.depth}) {
            std::error_code fault;
            const bool there = fs::is_regular_file(*file, fault);
            if (there && isPermitted(*file, R_OK)) continue;
            const bool forbidden = there || fault == std::errc::permission_denied;
            if (missing++ == 0) first_missing = *file + (forbidden ? " (no permission to read it)" : "");
        }
    if (missing == 0) return;
    const std::string text = std::to_string(missing) + " listed image(s) missing in " + description_.folder +
                             ", first: " + first_missing;
    if (!tolerate_missing || missing >= 2 * description_.frames.size()) throw std::runtime_error(text);
    description_.notes.push_back("warning: " + text);
}

const PinholeCamera& DatasetReader::depthCamera() const {
    return description_.registration ? description_.registration->depth_camera : camera();
}

void DatasetReader::checkDepthScale() {
    std::size_t empty = 0;
    bool settled = false;
    for (std::size_t i = 0; i < size() && empty < kMostEmpty; i++) {
        cv::Mat depth;
        try {
            depth = readStoredDepth(i);
        } catch (const std::runtime_error&) {
            if (i + 1 < size()) continue;
            throw;
        }
        checkSize(depth, depthCamera(), entry(i).depth);
        if (!settled) settleDepthScale(depth, entry(i).depth);
        settled = true;
        const double median_units = medianDepth(depth, description_.invalid_depth);
        if (median_units == 0) {
            ++empty;
            continue;
        }
        const double scale = floats_per_metre_ > 0 ? floats_per_metre_ : depthScale();
        const double median = median_units / scale;
        if (isPlausibleMedianDepth(median)) {
            noteFacts(depth, median);
            return;
        }
        char text[160];
        std::snprintf(text, sizeof text, "median depth %.3g m with depth_scale %g makes no sense", median,
                      scale);
        const std::string likely = likelyDepthScales(median_units);
        throw std::runtime_error(entry(i).depth + ": " + text + (likely.empty() ? "" : "; " + likely) +
                                 (description_.images
                                      ? ": is it depth? (--depth-topic)"
                                      : ": put the sensor's own into camera.txt, or give --depth-scale"));
    }
    if (empty > 0)
        description_.notes.push_back("warning: the first " + std::to_string(empty) +
                                     " depth images hold no depth at all");
}

/// What the numbers of depth images mean, by the first one.
void DatasetReader::settleDepthScale(const cv::Mat& first, const std::string& file) {
    double& scale = description_.depth_scale;
    if (first.depth() == CV_32F) {
        floats_per_metre_ = scale > 0 ? scale : 1;
        scale = kUnitsOfFloats;
        char text[120];
        std::snprintf(text, sizeof text, "depth images hold floats of %g per metre, rounded to 0.2 mm",
                      floats_per_metre_);
        description_.notes.emplace_back(text);
    } else if (scale == 0) {
        const std::string likely = likelyDepthScales(medianDepth(first, description_.invalid_depth));
        if (description_.format == "tum" || description_.format == "eth3d" || description_.format == "icl")
            throw std::runtime_error(
                file + ": nobody says what its numbers mean: give --depth-scale units_per_metre" +
                (likely.empty() ? "" : " (" + likely + ")"));
        scale = kUnitsOfIntegers;
        description_.notes.emplace_back("depth is taken as mm (depth_scale 1000), for " +
                                        description_.camera_source + " does not tell it; --depth-scale does");
    }
}

void DatasetReader::noteFacts(const cv::Mat& depth, double median_depth) {
    description_.notes.push_back(
        factsText(size(), camera(), depth.size(), medianStep(stampsOf(description_.frames)), median_depth));
}

void DatasetReader::checkSize(const cv::Mat& image, const PinholeCamera& camera,
                              const std::string& file) const {
    if (image.cols == camera.width && image.rows == camera.height) return;
    const bool is_depth = image.depth() != CV_8U && !description_.registration && !description_.images;
    // The file last, so that reasons alike are counted together
    throw std::runtime_error(
        "an image of " + sizeText(image.size()) + ", but the camera is " +
        sizeText({camera.width, camera.height}) +
        (is_depth ? " (if colour images have that size, too, camera.txt has the wrong one; a depth camera of "
                    "its own belongs into camera.txt: depth_width, …): "
                  : " (are the intrinsics those of another image size?): ") +
        file);
}

cv::Mat DatasetReader::readStoredDepth(std::size_t i) const {
    return description_.images ? description_.images->depth(i) : readAnyDepthFile(entry(i).depth);
}

cv::Mat DatasetReader::readDepth(std::size_t i) const {
    cv::Mat depth = readStoredDepth(i);
    checkSize(depth, depthCamera(), entry(i).depth);
    if ((depth.depth() == CV_32F) != (floats_per_metre_ > 0))
        throw std::runtime_error(entry(i).depth + (floats_per_metre_ > 0
                                                       ? " is of 16 bits, others hold floats"
                                                       : " holds floats, others are of 16 bits"));
    if (floats_per_metre_ > 0) return depthInUnits(depth, depthScale() / floats_per_metre_, too_far_[i]);
    if (description_.invalid_depth != 0) depth.setTo(0, depth == description_.invalid_depth);
    return depth;
}

cv::Mat DatasetReader::toFrameDepth(const cv::Mat& depth_u16) const {
    const cv::Mat depth = depthToMetres(depth_u16, depthUnit());
    if (!description_.registration) return depth;
    return registerDepth(depth, depthCamera(), camera(), T_colour_depth_);
}

cv::Mat DatasetReader::readImage(std::size_t i) const {
    cv::Mat image = description_.images ? description_.images->colour(i) : readColourFile(entry(i).image);
    checkSize(image, camera(), entry(i).image);
    return image;
}

RgbdFrame DatasetReader::readFrame(std::size_t i) const {
    RgbdFrame frame;
    frame.timestamp = entry(i).timestamp;
    const cv::Mat image = readImage(i);
    frame.grey = toGrey(image);
    if (image.channels() == 3) frame.colour = image;
    frame.depth = toFrameDepth(readDepth(i));
    return frame;
}

std::string DatasetReader::warning() const {
    if (description_.images) return description_.images->warning();
    const std::size_t all = std::accumulate(too_far_.begin(), too_far_.end(), std::size_t{0});
    return all == 0 ? "" : tooFarText(all);
}

std::string DatasetReader::summary() const {
    const PinholeCamera& c = camera();
    char text[256];
    std::snprintf(text, sizeof text, "camera %dx%d fx %g fy %g cx %g cy %g, %s, depth_scale %g, from ",
                  c.width, c.height, c.fx, c.fy, c.cx, c.cy,
                  c.isDistorted() ? ("with " + lensText(c)).c_str() : "no lens distortion", depthScale());
    std::string lines = text + description_.camera_source + "\n" + description_.association.toText();
    for (const std::string& note : notes()) lines += "\n" + note;
    return lines;
}

std::vector<std::string> DatasetReader::notes() const {
    std::vector<std::string> notes = description_.notes;
    if (const std::string truth = groundTruth().toText(); !truth.empty()) notes.push_back(truth);
    if (!description_.imu_source.empty()) notes.push_back("inertial sensor: " + description_.imu_source);
    return notes;
}

namespace {

/// Checks that there is something that can be read. @return whether it is a folder
bool requireInput(const std::string& input, const DatasetOptions& options) {
    const bool is_bag = options.format == "bag" || isBag(input);
    std::error_code fault;
    if (!is_bag && !fs::exists(input, fault)) {
        if (fault && fault != std::errc::no_such_file_or_directory)
            throw std::runtime_error("cannot read folder " + input + ": " + fault.message());
        throw std::runtime_error("dataset folder not found: " + input);
    }
    if (options.topics.any() && !is_bag) throw UsageError("topics are for bags, and " + input + " is none");
    options.folder.check();
    if (const auto given = options.folder.options(); is_bag && !given.empty())
        throw UsageError(given[0].first + " is for folders, and " + input + " is a bag");
    const bool is_folder = fs::is_directory(input, fault);
    if (!is_folder && !is_bag)
        throw std::runtime_error(input + " is not a folder, nor a ROS bag (.bag, .db3, .mcap)");
    if (is_folder && !isPermitted(input, R_OK | X_OK))
        throw std::runtime_error("cannot read folder " + input + ": " + std::strerror(errno));
    return is_folder;
}

void checkFrameRate(double chosen, const DatasetDescription& found) {
    if (!(chosen > 0) || chosen == found.frame_rate) return;
    throw UsageError("--frame-rate is for images that are numbered, and those of " + found.folder +
                     (found.frame_rate > 0
                          ? " have " + plainNumber(found.frame_rate) + " Hz by their layout, " + found.format
                          : " have times"));
}

DatasetDescription load(const Format& format, const std::string& folder, const DatasetOptions& options) {
    DatasetDescription out = format.load(folder, options);
    if (const double scale = options.folder.depth_scale; scale > 0) out.depth_scale = scale;
    settleCount(out, options.folder.frame_rate > 0 ? options.folder.frame_rate : out.told_rate);
    checkFrameRate(options.folder.frame_rate, out);
    if (!options.ground_truth.empty()) out.ground_truth = readNamedGroundTruth(options.ground_truth);
    if (format.convert_truth && !out.ground_truth.poses.empty()) format.convert_truth(out);
    settleClock(out);
    return out;
}

}  // namespace

DatasetReader openDataset(const std::string& folder, const DatasetOptions& options) {
    std::string wanted = requireInput(folder, options) || options.format != "auto" ? options.format : "bag";
    if (wanted == "auto" && !options.folder.associations.empty()) wanted = "tum";
    std::string names, needs;
    for (const Format& format : kFormats) {
        names += std::string(names.empty() ? "" : ", ") + format.name;
        needs += std::string(needs.empty() ? "" : "; ") + format.name + ": " + format.needs;
        if (wanted == format.name || (wanted == "auto" && format.recognises(folder)))
            return DatasetReader(load(format, folder, options), options.tolerate_missing);
    }
    if (wanted != "auto")
        throw std::runtime_error("unknown dataset format '" + wanted + "' (known: auto, " + names + ")");
    const std::string better = betterFolder(folder);
    throw std::runtime_error("no dataset recognised in " + folder +
                             (better.empty() ? " (known layouts and what each needs: " + needs + ")"
                                             : "; did you mean " + better + "?"));
}

std::vector<std::string> datasetFormats() {
    std::vector<std::string> names = {"auto"};
    for (const Format& format : kFormats) names.emplace_back(format.name);
    return names;
}

}  // namespace roevo
