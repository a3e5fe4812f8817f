#include "recordings/scannet.h"

#include <filesystem>
#include <stdexcept>
#include <vector>

#include "recordings/given_camera.h"
#include "recordings/image_lists.h"
#include "recordings/image_sizes.h"
#include "recordings/numbered_files.h"
#include "recordings/pose_files.h"
#include "recordings/text_list.h"

namespace fs = std::filesystem;

namespace roevo {
namespace {

constexpr double kScanNetRate = 30;  // Hz
constexpr double kScanNetUnitsPerMetre = 1000;

/// The camera in the corner of a 4x4 matrix, without its size.
PinholeCamera readIntrinsic(const fs::path& file) {
    const auto m = readNumbers(file.string(), 16, "a 4x4 matrix");
    return {0, 0, m[0], m[5], m[2], m[6], {}};
}

/// Where a camera is, of which ScanNet's own say: in the same place.
void requireIdentity(const fs::path& file) {
    if (fs::exists(file) && !readPoseFile(file.string()).isApprox(Pose::Identity(), 1e-6))
        throw std::runtime_error(
            file.string() +
            ": is not the identity that ScanNet has there; write a camera.txt with the depth "
            "camera and depth_to_colour");
}

CameraDescription readCameras(const fs::path& folder, const DatasetDescription& dataset) {
    const fs::path place = folder / "intrinsic";
    CameraDescription out;
    out.camera = readIntrinsic(place / "intrinsic_color.txt");
    out.depth_scale = kScanNetUnitsPerMetre;
    out.source = "intrinsic/intrinsic_color.txt";
    if (!fs::exists(place / "intrinsic_depth.txt")) return out;
    for (const char* file : {"extrinsic_color.txt", "extrinsic_depth.txt"}) requireIdentity(place / file);
    DepthRegistration registration;
    registration.depth_camera = readIntrinsic(place / "intrinsic_depth.txt");
    const cv::Size size = depthSize(dataset.frames);
    registration.depth_camera.width = size.width;
    registration.depth_camera.height = size.height;
    out.registration = registration;
    out.notes.emplace_back(
        "depth is of intrinsic/intrinsic_depth.txt, and registered to colour when a frame is read");
    return out;
}

}  // namespace

bool isScanNetFolder(const std::string& folder_name) {
    const fs::path folder(folder_name);
    return fs::is_directory(folder / "color") && fs::is_directory(folder / "depth") &&
           fs::exists(folder / "intrinsic" / "intrinsic_color.txt");
}

DatasetDescription loadScanNet(const std::string& folder_name, const DatasetOptions& options) {
    const fs::path folder(folder_name);
    DatasetDescription out;
    out.folder = folder_name;
    out.format = "scannet";
    if (!isScanNetFolder(folder_name))
        throw std::runtime_error(folder_name + " has no color/, depth/ and intrinsic/intrinsic_color.txt");
    const NamedImages colours = imagesIn(folder / "color"), depths = imagesIn(folder / "depth");
    requireImages(colours, (folder / "color").string());
    requireImages(depths, (folder / "depth").string());
    const auto given = givenCamera(folder_name, options.folder);
    const double rate = frameRate(options.folder, given, kScanNetRate);
    out.notes.push_back(pairByName(colours, depths, rate, options.max_time_difference, out));
    finishFrames(out);
    setCamera(given ? *given : readCameras(folder, out), out);

    std::map<double, std::string> poses;
    std::error_code fault;
    for (const auto& entry : fs::directory_iterator(folder / "pose", fault))
        if (const auto number = wholeNumber(entry.path().stem().string()))
            poses[static_cast<double>(*number) / rate] = entry.path().string();
    out.ground_truth = readPoseFiles(poses, (folder / "pose").string(), Pose::Identity());
    return out;
}

}  // namespace roevo
