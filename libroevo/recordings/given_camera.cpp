#include "recordings/given_camera.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <opencv2/core.hpp>
#include <stdexcept>
#include <vector>

#include "camera/lens_terms.h"
#include "camera/off_centre.h"
#include "recordings/calibration_file.h"
#include "recordings/image_sizes.h"
#include "recordings/lens.h"

namespace fs = std::filesystem;

namespace roevo {
namespace {

CameraDescription chosenCamera(const FolderChoice& choice) {
    CameraDescription out;
    PinholeCamera& camera = out.camera;
    camera.fx = choice.intrinsics[0], camera.fy = choice.intrinsics[1];
    camera.cx = choice.intrinsics[2], camera.cy = choice.intrinsics[3];
    if (choice.fisheye.empty())
        setLens("", choice.distortion, camera);
    else
        setLens("fisheye", choice.fisheye, camera);
    out.depth_scale = choice.depth_scale;
    out.source = "the command line";
    return out;
}

bool isSameCamera(const PinholeCamera& a, const PinholeCamera& b) {
    const auto near = [](double x, double y) { return std::abs(x - y) <= 1e-3 * std::abs(x) + 1e-3; };
    const bool sizes = a.width == 0 || b.width == 0 || (a.width == b.width && a.height == b.height);
    bool lenses = a.lens == b.lens || !(a.isDistorted() || b.isDistorted());
    for (std::size_t i = 0; i < 8; i++) lenses = lenses && near(lensTerm(a, i), lensTerm(b, i));
    return sizes && lenses && near(a.fx, b.fx) && near(a.fy, b.fy) && near(a.cx, b.cx) && near(a.cy, b.cy);
}

std::string shortText(const PinholeCamera& camera) {
    char text[120];
    std::snprintf(text, sizeof text, "%dx%d fx %g fy %g cx %g cy %g", camera.width, camera.height, camera.fx,
                  camera.fy, camera.cx, camera.cy);
    return text + (", " + lensText(camera));
}

/// Calibrations of other programs in the folder, by name.
std::vector<CameraDescription> calibrationsIn(const fs::path& folder) {
    std::vector<fs::path> files;
    for (const fs::path& place : {folder, folder / "intrinsic", folder / "calibration"}) {
        std::error_code fault;
        for (const auto& entry : fs::directory_iterator(place, fault))
            if (entry.is_regular_file(fault) && mayBeCalibration(entry.path().string()))
                files.push_back(entry.path());
    }
    std::sort(files.begin(), files.end());
    std::vector<CameraDescription> found;
    for (const fs::path& file : files)
        if (auto camera = readCalibrationFile(file.string())) {
            camera->source = file.lexically_relative(folder).string();
            found.push_back(*camera);
        }
    return found;
}

/// One camera of several descriptions that agree. What one does not say, another may.
std::optional<CameraDescription> agreed(const std::string& folder,
                                        const std::vector<CameraDescription>& all) {
    if (all.empty()) return std::nullopt;
    CameraDescription out = all.front();
    for (const CameraDescription& other : all) {
        const bool scales_differ =
            out.depth_scale > 0 && other.depth_scale > 0 && out.depth_scale != other.depth_scale;
        if (!isSameCamera(out.camera, other.camera) || scales_differ)
            throw std::runtime_error(
                folder + ": two intrinsics that differ: " + out.source + " (" + shortText(out.camera) +
                ") and " + other.source + " (" + shortText(other.camera) + ")" +
                (scales_differ ? ", with other depth scales" : "") +
                ": leave only the one of the colour camera in the folder, or give --intrinsics");
        if (out.camera.width == 0)
            out.camera.width = other.camera.width, out.camera.height = other.camera.height;
        if (!(out.depth_scale > 0)) out.depth_scale = other.depth_scale;
        if (!out.frame_rate) out.frame_rate = other.frame_rate;
    }
    return out;
}

}  // namespace

std::optional<CameraDescription> givenCamera(const std::string& folder, const FolderChoice& choice) {
    if (!choice.intrinsics.empty()) return chosenCamera(choice);
    const fs::path own = fs::path(folder) / "camera.txt";
    if (!fs::exists(own)) return agreed(folder, calibrationsIn(folder));
    CameraDescription out = readCameraFile(own.string());
    for (const CameraDescription& other : calibrationsIn(folder))
        if (!isSameCamera(out.camera, other.camera))
            out.notes.push_back(other.source + " says " + shortText(other.camera) + ": camera.txt counts");
    return out;
}

double frameRate(const FolderChoice& choice, const std::optional<CameraDescription>& camera, double usual) {
    return choice.frame_rate > 0 ? choice.frame_rate : camera ? camera->frame_rate.value_or(usual) : usual;
}

void setCamera(const CameraDescription& camera, DatasetDescription& out) {
    out.camera = camera.camera;
    out.depth_scale = camera.depth_scale;
    out.camera_source = camera.source;
    out.registration = camera.registration;
    out.told_rate = camera.frame_rate.value_or(0);
    out.notes.insert(out.notes.end(), camera.notes.begin(), camera.notes.end());
    if (out.camera.width == 0) {
        const cv::Size size = colourSize(out.frames);
        out.camera.width = size.width;
        out.camera.height = size.height;
        out.camera_source += ", size from the images";
    }
    if (const std::string fault = out.camera.check(); !fault.empty())
        throw std::runtime_error(out.folder + ": " + camera.source + ": " + fault);
    constexpr double kMostOff = 0.15;
    if (camera.camera.width == 0 && offCentre(out.camera) > kMostOff)
        throw std::runtime_error(
            out.folder + ": " + camera.source + " says " + shortText(out.camera) +
            ": the principal point is far from the middle: intrinsics of images of "
            "another size? If they are right, say so by a camera.txt with width and height");
}

std::string noIntrinsics(const std::string& folder, const std::string& layout) {
    return "no intrinsics: " + folder + " has no camera.txt" + layout +
           "; write it with width, height, fx, fy, cx, cy, depth_scale, put a calibration of ROS, ORB-SLAM, "
           "Open3D or RealSense there (.yaml, .json), or give --intrinsics fx fy cx cy --depth-scale "
           "units_per_metre";
}

}  // namespace roevo
