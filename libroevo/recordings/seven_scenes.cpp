#include "recordings/seven_scenes.h"

#include <filesystem>
#include <map>
#include <optional>
#include <stdexcept>

#include "programs/text.h"
#include "recordings/camera_file.h"
#include "recordings/given_camera.h"
#include "recordings/image_lists.h"
#include "recordings/numbered_files.h"
#include "recordings/pose_files.h"

namespace fs = std::filesystem;

namespace roevo {
namespace {

constexpr double kRate = 30;  // Hz, of the Kinect
constexpr double kUnitsPerMetre = 1000;
constexpr std::uint16_t kInvalidDepth = 65535;

struct FrameFiles {
    std::string colour, depth, pose;
};

/// frame-000012.color.png -> 12 and ".color.png".
std::optional<std::pair<long long, std::string>> parseName(const std::string& name) {
    const std::string prefix = "frame-";
    const std::size_t point = name.find('.');
    if (name.rfind(prefix, 0) != 0 || point == std::string::npos) return std::nullopt;
    const auto number = wholeNumber(name.substr(prefix.size(), point - prefix.size()));
    if (!number) return std::nullopt;
    return std::pair(*number, name.substr(point));
}

std::map<long long, FrameFiles> filesIn(const fs::path& folder) {
    std::map<long long, FrameFiles> frames;
    for (const auto& entry : fs::directory_iterator(folder)) {
        const auto parsed = parseName(entry.path().filename().string());
        if (!parsed) continue;
        FrameFiles& frame = frames[parsed->first];
        if (parsed->second == ".color.png" || parsed->second == ".color.jpg")
            frame.colour = entry.path().string();
        if (parsed->second == ".depth.png") frame.depth = entry.path().string();
        if (parsed->second == ".pose.txt") frame.pose = entry.path().string();
    }
    return frames;
}

/// Others name their files alike, and bring a camera in a file of their own, or colour as JPEG: 7-Scenes'
/// camera must not be given to them.
bool isSurelySevenScenes(const fs::path& folder) {
    for (const fs::path& place : {folder, folder / ".."})
        for (const char* file : {"info.txt", "_info.txt", "camera-intrinsics.txt"})
            if (fs::exists(place / file)) return false;
    for (const auto& entry : fs::directory_iterator(folder)) {
        const auto parsed = parseName(entry.path().filename().string());
        if (parsed && parsed->second == ".color.jpg") return false;
    }
    return true;
}

/// @param T_depth_colour  from the camera whose poses are wanted to the one that the files speak of
void readPoses(const std::map<long long, FrameFiles>& frames, const Pose& T_depth_colour,
               DatasetDescription& out) {
    std::size_t missing = 0;
    std::map<double, std::string> poses;
    for (const auto& [number, files] : frames) {
        if (!files.pose.empty())
            poses[static_cast<double>(number) / out.frame_rate] = files.pose;
        else if (!files.colour.empty() && !files.depth.empty())
            missing++;
    }
    if (missing > 0)
        out.notes.push_back(std::to_string(missing) + " of " + std::to_string(out.frames.size()) +
                            " frames have no frame-N.pose.txt: no ground truth for them");
    GroundTruth& truth = out.ground_truth;
    truth = readPoseFiles(poses, out.folder, T_depth_colour);
    if (truth.file.empty()) return;
    const std::string whose = out.registration
                                  ? "KinectFusion's poses of the depth camera, moved to the colour camera"
                                  : "taken as poses of the colour camera";
    truth.note = whose + (truth.note.empty() ? "" : ", " + truth.note);
}

}  // namespace

PinholeCamera sevenScenesColourCamera() {
    return {640, 480, 525, 525, 320, 240, {}};
}

DepthRegistration sevenScenesRegistration() {
    DepthRegistration out;
    out.depth_camera = {640, 480, 585, 585, 320, 240, {}};
    Eigen::Matrix3d rotation;
    rotation << 9.9996518012567637e-01, 2.6765126468950343e-03, -7.9041012313000904e-03,  //
        -2.7409311281316700e-03, 9.9996302803027592e-01, -8.1504520778013286e-03,         //
        7.8819942130445332e-03, 8.1718328771890631e-03, 9.9993554558014031e-01;
    out.T_colour_depth.setRotation(Eigen::Quaterniond(rotation).normalized().toRotationMatrix());
    out.T_colour_depth.translation() << -2.5558943178152542e-02, 1.0109636268061706e-04,
        2.0318321729487039e-03;
    return out;
}

bool isSevenScenesFolder(const std::string& folder) {
    for (const auto& entry : fs::directory_iterator(folder)) {
        const auto parsed = parseName(entry.path().filename().string());
        if (parsed && parsed->second.rfind(".color.", 0) == 0) return true;
    }
    return false;
}

DatasetDescription loadSevenScenes(const std::string& folder, const DatasetOptions& options) {
    DatasetDescription out;
    out.folder = folder;
    out.format = "7scenes";
    const auto frames = filesIn(folder);
    const auto given = givenCamera(folder, options.folder);
    out.frame_rate = frameRate({}, given, kRate);
    for (const auto& [number, files] : frames) {
        if (files.colour.empty() != files.depth.empty())
            (files.colour.empty() ? out.association.dropped_depth : out.association.dropped_colour)++;
        if (files.colour.empty() || files.depth.empty()) continue;
        const double time = static_cast<double>(number) / out.frame_rate;
        out.frames.push_back({time, time, files.colour, files.depth});
    }
    if (out.frames.empty())
        throw std::runtime_error(folder + " has no frame-000000.color.png with its frame-000000.depth.png");
    finishFrames(out);
    out.notes.push_back("times are frame numbers at " + plainNumber(out.frame_rate) + " Hz");
    out.invalid_depth = kInvalidDepth;

    if (given) {
        setCamera(*given, out);
        if (!out.registration)
            out.notes.push_back("depth is taken as registered to colour, because there is " +
                                std::string(options.folder.intrinsics.empty() ? "a " : "") + given->source);
    } else {
        if (options.format != "7scenes" && !isSurelySevenScenes(folder))
            throw std::runtime_error(
                "no intrinsics: " + folder +
                " names its files as 7-Scenes does, but is of another dataset "
                "(BundleFusion, 3DMatch): write camera.txt (or give --format 7scenes for "
                "7-Scenes' camera)");
        CameraDescription customary;
        customary.camera = sevenScenesColourCamera();
        customary.depth_scale = kUnitsPerMetre;
        customary.source = "the customary 7-Scenes camera (assumed: the dataset publishes none for colour)";
        setCamera(customary, out);
        out.registration = sevenScenesRegistration();
        out.notes.push_back(
            "depth is of the published depth camera f 585 c (320, 240) and registered to colour when a frame "
            "is "
            "read, the pose of one to the other assumed from another Kinect v1 (baseline 25.6 mm)");
    }
    readPoses(frames, out.registration ? out.registration->T_colour_depth.inverse() : Pose::Identity(), out);
    return out;
}

}  // namespace roevo
