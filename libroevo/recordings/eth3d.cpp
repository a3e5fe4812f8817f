#include "recordings/eth3d.h"

#include <filesystem>
#include <stdexcept>

#include "recordings/camera_file.h"
#include "recordings/given_camera.h"
#include "recordings/image_lists.h"
#include "recordings/sensor_files.h"
#include "recordings/text_list.h"
#include "recordings/tum.h"

namespace fs = std::filesystem;

namespace roevo {
namespace {

CameraDescription readCalibration(const std::string& file) {
    if (!fs::exists(file))
        throw std::runtime_error(
            "no intrinsics: calibration.txt is missing, which ETH3D SLAM sequences have "
            "beside associated.txt: one line 'fx fy cx cy': " +
            file);
    const auto lines = readTextLines(file);
    if (lines.size() != 1 || lines[0].words.size() != 4)
        throw std::runtime_error("no intrinsics: " + file + " must have one line 'fx fy cx cy'");
    const std::string where = file + ":" + std::to_string(lines[0].number);
    CameraDescription out;
    PinholeCamera& camera = out.camera;
    double* const values[] = {&camera.fx, &camera.fy, &camera.cx, &camera.cy};
    for (std::size_t i = 0; i < 4; i++) *values[i] = parseNumber(lines[0].words[i], where);
    out.source = "calibration.txt";
    return out;
}

}  // namespace

bool isEth3dFolder(const std::string& folder) {
    // No other layout has associated.txt of its own, but users write one for sequences of TUM, too
    if (!fs::is_regular_file(fs::path(folder) / "calibration.txt"))
        return fs::is_regular_file(fs::path(folder) / "associated.txt") &&
               !(isTumFolder(folder) && findTumCamera(folder));
    for (const char* list : {"associated.txt", "rgb.txt", "depth.txt"})
        if (fs::is_regular_file(fs::path(folder) / list)) return true;
    return false;
}

DatasetDescription loadEth3d(const std::string& folder_name, const DatasetOptions& options) {
    const fs::path folder(folder_name);
    DatasetDescription out;
    out.folder = folder_name;
    out.format = "eth3d";
    const bool has_lists = fs::exists(folder / "rgb.txt") && fs::exists(folder / "depth.txt");
    if (fs::exists(folder / "associated.txt")) {
        readAssociations("associated.txt", options.max_time_difference, out);
    } else if (has_lists) {
        matchLists("rgb.txt", "depth.txt", options.max_time_difference, out);
    } else {
        throw std::runtime_error(folder_name +
                                 " has no associated.txt, nor both rgb.txt and depth.txt: get the RGB-D part "
                                 "of the sequence, too");
    }
    finishFrames(out);
    const auto given = givenCamera(folder_name, options.folder);
    setCamera(given ? *given : readCalibration((folder / "calibration.txt").string()), out);
    out.ground_truth = readGroundTruth((folder / "groundtruth.txt").string());
    readImu((folder / "imu.txt").string(), out);
    return out;
}

}  // namespace roevo
