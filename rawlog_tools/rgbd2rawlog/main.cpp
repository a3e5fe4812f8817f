// rgbd2rawlog: an RGB-D dataset folder as an MRPT rawlog, lossless unless told otherwise.
#include <CLI/CLI.hpp>
#include <Eigen/Geometry>
#include <cstdio>
#include <filesystem>
#include <memory>

#include "output_check.h"
#include "programs/atomic_file.h"
#include "programs/memory_peak.h"
#include "programs/program.h"
#include "recordings/dataset_reader.h"
#include "recordings/depth_times.h"
#include "rgbd2rawlog/convert.h"
#include "rgbd2rawlog/verify.h"
#include "roevo_mrpt/file_copy.h"
#include "roevo_mrpt/rawlog_writer.h"

namespace roevo {
namespace {

namespace fs = std::filesystem;

constexpr char kName[] = "rgbd2rawlog";

constexpr char kFooter[] =
    "T is either seconds after the first frame (--from 12.5) or, with @ before it, a time stamp of the\n"
    "dataset (--from @1305031453.36); both limits are inclusive.\n"
    "Ground truth goes to <stem>_groundtruth.txt beside the rawlog, time stamps of depth images that are "
    "not\n"
    "those of the colour images to <stem>_depth_times.txt, inertial samples into the rawlog.\n"
    "Example:\n"
    "  rgbd2rawlog --input rgbd_dataset_freiburg1_desk --output fr1_desk.rawlog --verify";

struct Settings {
    std::string input, output;
    DatasetOptions dataset;
    ConvertOptions convert;
    bool verify = false;
};

std::optional<int> parse(int argc, char** argv, Settings& settings) {
    std::string from, to;
    CLI::App app(
        "Turns an RGB-D dataset folder into an MRPT rawlog: depth lossless inside, colour files beside it as "
        "they are.",
        kName);
    app.add_option("--input", settings.input, "Dataset folder")->required();
    app.add_option("--output", settings.output, "Rawlog to write; images go to <stem>_Images beside it")
        ->required();
    app.add_option("--format", settings.dataset.format, "Dataset format")
        ->capture_default_str()
        ->check(CLI::IsMember(datasetFormats()));
    app.add_option("--max-dt", settings.dataset.max_time_difference,
                   "Largest time between a colour and its depth image, s")
        ->capture_default_str()
        ->check(CLI::Range(0.0, 10.0));
    app.add_option("--from", from, "Leave out what comes before this moment")->type_name("T");
    app.add_option("--to", to, "Leave out what comes after this moment")->type_name("T");
    app.add_option("--every", settings.convert.selection.every, "Take each N-th frame only")
        ->type_name("N")
        ->check(CLI::Range(1, 1000000));
    app.add_flag("--externalize-depth", settings.convert.externalize_depth,
                 "Depth in files of MRPT's binary format beside the rawlog instead of inside; lossless, too");
    app.add_option("--jpeg", settings.convert.jpeg_quality,
                   "Store colour as JPEG of this quality: smaller, but LOSSY")
        ->type_name("Q")
        ->check(CLI::Range(1, 100));
    app.add_flag("--verify", settings.verify,
                 "Read the rawlog back before it gets its name and compare every depth value, time stamp, "
                 "image, inertial sample and the intrinsics");
    app.add_flag("--skip-bad", settings.convert.skip_bad,
                 "Leave out frames whose images cannot be used, instead of failing");
    app.footer(kFooter);
    if (auto code = parseCommandLine(app, argc, argv)) return code;
    if (fs::path(settings.output).extension() != ".rawlog")
        throw UsageError("--output must end in .rawlog: " + settings.output);
    if (!from.empty()) settings.convert.selection.from = parseTimeLimit(from, "--from");
    if (!to.empty()) settings.convert.selection.to = parseTimeLimit(to, "--to");
    return std::nullopt;
}

/// A line of a TUM trajectory, with more decimals than the 9 of our own results: nothing is to be lost.
std::string exactTumLine(const StampedPose& pose) {
    const Eigen::Vector3d t = pose.T_world_camera.translation();
    const Eigen::Quaterniond q(pose.T_world_camera.linear());
    char line[256];
    std::snprintf(line, sizeof line, "%.6f %.12f %.12f %.12f %.12f %.12f %.12f %.12f\n", pose.timestamp,
                  t.x(), t.y(), t.z(), q.x(), q.y(), q.z(), q.w());
    return line;
}

/// The ground truth under a temporary name, to be put in place after the rawlog; null when there is none.
std::unique_ptr<AtomicFile> prepareGroundTruth(const GroundTruth& truth, const std::string& path) {
    if (truth.poses.empty()) return nullptr;
    auto file = std::make_unique<AtomicFile>(path);
    if (truth.copyable) {
        copyFile(truth.file, file->temporaryPath());
        return file;
    }
    for (const StampedPose& pose : truth.poses) file->stream() << exactTumLine(pose);
    return file;
}

void printVerified(const VerifyResult& checked) {
    std::printf(
        "verified: %zu frames, %zu depth values, %zu inertial samples, stamps, grey images and intrinsics: 0 "
        "differences\n",
        checked.frames, checked.depth_values, checked.imu_samples);
    if (checked.lowest_psnr > 0)
        std::printf("verified: JPEG images as encoded, %.1f dB or better against the originals\n",
                    checked.lowest_psnr);
}

void printConverted(const Settings& settings, const ConvertResult& result) {
    for (const std::string& line : result.left_out) std::printf("left out: %s\n", line.c_str());
    std::printf("%s: %zu frames written, %zu left out", settings.output.c_str(), result.written.size(),
                result.left_out.size());
    if (!result.imu.empty()) std::printf(", %zu inertial samples", result.imu.size());
    std::printf("\n");
    if (settings.convert.jpeg_quality > 0)
        std::printf("colour is lossy: JPEG of quality %d\n", settings.convert.jpeg_quality);
}

void printSpeed(const ConvertResult& result) {
    const auto frames = static_cast<double>(result.written.size());
    std::printf("speed: %.1f frames/s; decoding the images alone %.1f frames/s; memory at most %.0f MB\n",
                frames / result.seconds, frames / result.decode_seconds, memoryPeakMb());
}

int run(int argc, char** argv) {
    Settings settings;
    if (auto code = parse(argc, argv, settings)) return *code;

    checkOutputFolder(settings.output);
    settings.dataset.tolerate_missing = settings.convert.skip_bad;
    const DatasetReader dataset = openDataset(settings.input, settings.dataset);
    std::printf("%s\n", dataset.summary().c_str());
    const std::string truth_path = RawlogWriter::groundTruthFile(settings.output);
    const auto truth = prepareGroundTruth(dataset.groundTruth(), truth_path);
    std::unique_ptr<AtomicFile> depth_times;
    const auto check = [&](const ConvertResult& result, const std::string& rawlog) {
        if (settings.verify) printVerified(verifyRawlog(dataset, settings.convert, result, rawlog));
        const std::string text = depthTimesText(dataset, result.written);
        if (text.empty()) return;
        depth_times = std::make_unique<AtomicFile>(depthTimesFile(settings.output));
        depth_times->stream() << text << std::flush;
        if (!depth_times->stream())
            throw std::runtime_error("cannot write " + depth_times->path() + ": disk full?");
    };
    const ConvertResult result = convertToRawlog(dataset, settings.output, settings.convert, check);
    for (AtomicFile* file : {truth.get(), depth_times.get()})
        if (file != nullptr) file->commit();
    printConverted(settings, result);
    if (truth)
        std::printf("ground truth: %s\n", truth_path.c_str());
    else
        warnOfForeignGroundTruth(kName, settings.output);
    if (depth_times)
        std::printf("times of the depth images: %s\n", depth_times->path().c_str());
    else
        warnOfForeignFile(kName, depthTimesFile(settings.output), "depth times");
    printSpeed(result);
    return 0;
}

}  // namespace
}  // namespace roevo

int main(int argc, char** argv) {
    return roevo::runProgram(roevo::kName, [&] { return roevo::run(argc, argv); });
}
