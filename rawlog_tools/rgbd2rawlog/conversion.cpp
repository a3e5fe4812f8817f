#include "rgbd2rawlog/conversion.h"

#include <Eigen/Geometry>
#include <cstdio>
#include <memory>

#include "input/excerpt.h"
#include "output_check.h"
#include "programs/atomic_file.h"
#include "programs/memory_peak.h"
#include "programs/output_folder.h"
#include "programs/text.h"
#include "recordings/depth_times.h"
#include "rgbd2rawlog/verify.h"
#include "roevo_mrpt/file_copy.h"
#include "roevo_mrpt/rawlog_writer.h"

namespace roevo {
namespace {

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
    file->close();
    return file;
}

void printVerified(const VerifyResult& checked) {
    std::printf("verified: %s, %s, %s, stamps, grey images and intrinsics: 0 differences\n",
                counted(checked.frames, "frame").c_str(),
                counted(checked.depth_values, "depth value").c_str(),
                counted(checked.imu_samples, "inertial sample").c_str());
    if (checked.lowest_psnr > 0)
        std::printf("verified: JPEG images as encoded, %.1f dB or better against the originals\n",
                    checked.lowest_psnr);
}

void printConverted(const ConversionSettings& settings, const ConvertResult& result,
                    const std::string& label) {
    for (const std::string& line : result.left_out) std::printf("left out: %s\n", line.c_str());
    std::printf("%s: %s written, %zu left out", settings.output.c_str(),
                counted(result.written.size(), "frame").c_str(), result.left_out.size());
    if (!result.imu.empty()) std::printf(", %s", counted(result.imu.size(), "inertial sample").c_str());
    if (!label.empty()) std::printf(", sensor label %s", excerpt(label).c_str());
    std::printf("\n");
    if (settings.convert.jpeg_quality > 0)
        std::printf("colour is lossy: JPEG of quality %d\n", settings.convert.jpeg_quality);
}

void printSpeed(const ConvertResult& result) {
    const auto frames = static_cast<double>(result.written.size());
    std::printf("speed: %.1f frames/s; decoding the images alone %.1f frames/s; memory at most %.0f MB\n",
                frames / result.seconds, frames / result.decode_seconds, memoryPeakMb());
}

}  // namespace

void convertRecording(const char* program, const ConversionSettings& settings) {
    checkOutputFolder(settings.output);
    DatasetOptions options = settings.dataset;
    options.tolerate_missing = settings.convert.skip_bad;
    const DatasetReader dataset = openDataset(settings.input, options);
    std::printf("%s\n", dataset.summary().c_str());
    const std::string truth_path = RawlogWriter::groundTruthFile(settings.output);
    keepInputs("--output", truth_path, {settings.dataset.ground_truth});
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
    if (dataset.description().registration)
        std::printf("depth has a camera of its own: both cameras are written\n");
    printConverted(settings, result, dataset.description().sensor_label);
    if (const std::string lost = dataset.warning(); !lost.empty()) std::printf("%s\n", lost.c_str());
    if (truth)
        std::printf("ground truth: %s\n", truth_path.c_str());
    else
        warnOfForeignGroundTruth(program, settings.output);
    if (depth_times)
        std::printf("times of the depth images: %s\n", depth_times->path().c_str());
    else
        warnOfForeignFile(program, depthTimesFile(settings.output), "depth times");
    printSpeed(result);
}

}  // namespace roevo
