#include "recordings/seven_scenes.h"

#include <Eigen/LU>
#include <cmath>
#include <filesystem>
#include <map>
#include <optional>
#include <stdexcept>

#include "recordings/camera_file.h"
#include "recordings/image_lists.h"
#include "recordings/numbered_files.h"
#include "recordings/text_list.h"
#include "roevo_mrpt/time_conversions.h"

namespace fs = std::filesystem;

namespace roevo {
namespace {

constexpr double kRate = 30;  // Hz, of the Kinect
constexpr double kUnitsPerMetre = 1000;
constexpr double kRotationTolerance = 0.01;
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

/// A rigid 4x4 matrix. @throws std::runtime_error
Pose readPose(const std::string& file) {
    std::vector<double> values;
    for (const TextLine& line : readTextLines(file))
        for (const std::string& word : line.words)
            values.push_back(parseNumber(word, file + ":" + std::to_string(line.number)));
    if (values.size() != 16)
        throw std::runtime_error(file + ": expected a 4x4 matrix, found " + std::to_string(values.size()) +
                                 " numbers");
    const Eigen::Matrix4d matrix = Eigen::Map<Eigen::Matrix<double, 4, 4, Eigen::RowMajor>>(values.data());
    const Eigen::Matrix3d rotation = matrix.topLeftCorner<3, 3>();
    if (!(rotation * rotation.transpose()).isApprox(Eigen::Matrix3d::Identity(), kRotationTolerance) ||
        rotation.determinant() < 0)
        throw std::runtime_error(file + ": the matrix is not a rotation and a translation");
    Pose pose = Pose::Identity();
    pose.setRotation(Eigen::Quaterniond(rotation).normalized().toRotationMatrix());
    pose.translation() = matrix.topRightCorner<3, 1>();
    return pose;
}

/// @param T_depth_colour  from the camera whose poses are wanted to the one that the files speak of
void readPoses(const std::map<long long, FrameFiles>& frames, const Pose& T_depth_colour,
               DatasetDescription& out) {
    GroundTruth& truth = out.ground_truth;
    std::size_t unusable = 0, missing = 0;
    std::string first_fault;
    for (const auto& [number, files] : frames) {
        if (files.pose.empty()) {
            if (!files.colour.empty() && !files.depth.empty()) missing++;
            continue;
        }
        truth.file = out.folder;
        try {
            const Pose T_world_depth = readPose(files.pose);
            truth.poses.push_back(
                {roundToMicroseconds(static_cast<double>(number) / kRate), T_world_depth * T_depth_colour});
        } catch (const std::runtime_error& error) {
            if (unusable++ == 0) first_fault = error.what();
        }
    }
    if (missing > 0)
        out.notes.push_back(std::to_string(missing) + " of " + std::to_string(out.frames.size()) +
                            " frames have no frame-N.pose.txt: no ground truth for them");
    if (truth.file.empty()) return;
    truth.note = out.registration ? "KinectFusion's poses of the depth camera, moved to the colour camera"
                                  : "taken as poses of the colour camera";
    if (unusable > 0) truth.note += ", " + std::to_string(unusable) + " left out, first: " + first_fault;
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

DatasetDescription loadSevenScenes(const std::string& folder, const DatasetOptions&) {
    DatasetDescription out;
    out.folder = folder;
    out.format = "7scenes";
    const auto frames = filesIn(folder);
    for (const auto& [number, files] : frames) {
        if (files.colour.empty() != files.depth.empty())
            (files.colour.empty() ? out.association.dropped_depth : out.association.dropped_colour)++;
        if (files.colour.empty() || files.depth.empty()) continue;
        const double time = static_cast<double>(number) / kRate;
        out.frames.push_back({time, time, files.colour, files.depth});
    }
    if (out.frames.empty())
        throw std::runtime_error(folder + " has no frame-000000.color.png with its frame-000000.depth.png");
    finishFrames(out);
    out.notes.push_back("times are frame numbers at 30 Hz");
    out.invalid_depth = kInvalidDepth;

    if (const auto given = cameraFileIn(folder)) {
        setCamera(*given, out);
        out.notes.push_back("depth is taken as registered to colour, because there is a camera.txt");
    } else {
        setCamera({sevenScenesColourCamera(),
                   kUnitsPerMetre,
                   {},
                   "the customary 7-Scenes camera (assumed: the dataset publishes none for colour)"},
                  out);
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
