#include "recordings/plain.h"

#include <filesystem>
#include <stdexcept>

#include "recordings/camera_file.h"
#include "recordings/image_lists.h"
#include "recordings/numbered_files.h"
#include "recordings/sensor_files.h"

namespace fs = std::filesystem;

namespace roevo {
namespace {

constexpr double kUsualRate = 30;  // Hz

/// The folder of colour images, or an empty path.
fs::path colourFolder(const fs::path& folder) {
    for (const char* name : {"rgb", "color", "colour", "images"})
        if (fs::is_directory(folder / name)) return folder / name;
    return {};
}

}  // namespace

bool isPlainFolder(const std::string& folder_name) {
    const fs::path folder(folder_name);
    return fs::is_directory(folder / "depth") && !colourFolder(folder).empty();
}

DatasetDescription loadPlain(const std::string& folder_name, const DatasetOptions&) {
    const fs::path folder(folder_name);
    DatasetDescription out;
    out.folder = folder_name;
    out.format = "plain";
    if (!isPlainFolder(folder_name))
        throw std::runtime_error(folder_name + " has no folder depth/ with rgb/ or color/ beside it");
    const auto camera = cameraFileIn(folder_name);
    if (!camera)
        throw std::runtime_error(
            "no intrinsics: " + folder_name +
            " has no camera.txt; write it with width, height, fx, fy, cx, cy, depth_scale "
            "(and frame_rate, where images are numbered)");
    setCamera(*camera, out);
    std::string times =
        pairByName(colourFolder(folder), folder / "depth", camera->frame_rate.value_or(kUsualRate), out);
    if (!camera->frame_rate && times.find("Hz") != std::string::npos)
        times += " (assumed; frame_rate in camera.txt sets it)";
    out.notes.push_back(times);
    finishFrames(out);
    out.ground_truth = readGroundTruth((folder / "groundtruth.txt").string());
    return out;
}

}  // namespace roevo
