#include "recordings/phone.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <vector>

#include "recordings/facts.h"
#include "recordings/given_camera.h"
#include "recordings/image_lists.h"
#include "recordings/image_sizes.h"
#include "recordings/numbered_files.h"
#include "recordings/text_list.h"
#include "roevo_mrpt/time_conversions.h"

namespace fs = std::filesystem;

namespace roevo {
namespace {

constexpr double kPhoneRate = 60;  // Hz
constexpr double kQuaternionTolerance = 0.05;
constexpr char kWhose[] = "ARKit's poses, which are an estimate themselves";

/// From numbers x y z and a quaternion x y z w. @throws std::runtime_error
Pose poseOf(const Eigen::Vector3d& position, const Eigen::Quaterniond& rotation, const std::string& where) {
    if (!(std::abs(rotation.norm() - 1) < kQuaternionTolerance) || !position.allFinite())
        throw std::runtime_error(where + ": not a pose (the quaternion has not length 1)");
    return Pose(rotation.normalized(), position);
}

/// Images of rgb/ and depth/ by their numbers, without times.
void readPairs(const DatasetOptions& options, DatasetDescription& out) {
    const fs::path folder(out.folder);
    const NamedImages colours = imagesIn(folder / "rgb"), depths = imagesIn(folder / "depth");
    requireImages(colours, (folder / "rgb").string());
    requireImages(depths, (folder / "depth").string());
    pairByName(colours, depths, 1, options.max_time_difference, out);
}

/// Sets a camera; without a depth camera of its own, depth is of the same view in another size.
void setPhoneCamera(const CameraDescription& camera, DatasetDescription& out) {
    setCamera(camera, out);
    if (out.registration) return;
    const cv::Size size = depthSize(out.frames);
    if (size.width == out.camera.width && size.height == out.camera.height) return;
    const double x = static_cast<double>(size.width) / out.camera.width,
                 y = static_cast<double>(size.height) / out.camera.height;
    if (!(std::abs(x / y - 1) < 0.02))
        throw std::runtime_error(
            out.frames.front().depth + " is " + sizeText(size) + ", and colour " +
            sizeText({out.camera.width, out.camera.height}) +
            ": not the same view; is colour of another size than the camera's file says?");
    DepthRegistration registration;
    const PinholeCamera& c = out.camera;
    registration.depth_camera = c.undistorted();
    registration.depth_camera.width = size.width;
    registration.depth_camera.height = size.height;
    registration.depth_camera.fx = c.fx * x, registration.depth_camera.cx = (c.cx + 0.5) * x - 0.5;
    registration.depth_camera.fy = c.fy * y, registration.depth_camera.cy = (c.cy + 0.5) * y - 0.5;
    out.registration = registration;
    out.notes.emplace_back("depth is of colour's view in another size, and enlarged when a frame is read");
}

/// Lines of "timestamp, frame, x, y, z, qx, qy, qz, qw" by number of the frame.
std::map<long long, StampedPose> readOdometry(const std::string& file) {
    std::map<long long, StampedPose> out;
    for (const TextLine& line : readTable(file)) {
        const std::string where = file + ":" + std::to_string(line.number);
        std::vector<double> v;
        for (const std::string& word : line.words) v.push_back(parseNumber(word, where));
        if (v.size() < 9)
            throw std::runtime_error(where + ": expected timestamp, frame, x, y, z, qx, qy, qz, qw, found " +
                                     std::to_string(v.size()) + " numbers");
        if (!(v[1] >= 0 && v[1] < 1e9)) throw std::runtime_error(where + ": the frame's number is none");
        out[static_cast<long long>(v[1])] = {
            v[0], poseOf({v[2], v[3], v[4]}, Eigen::Quaterniond(v[8], v[5], v[6], v[7]), where)};
    }
    if (out.empty()) throw std::runtime_error(file + " has no poses");
    return out;
}

CameraDescription readCameraMatrix(const std::string& file) {
    const auto m = readNumbers(file, 9, "a 3x3 matrix");
    CameraDescription out;
    out.camera = {0, 0, m[0], m[4], m[2], m[5], {}};
    out.depth_scale = 1000;
    out.source = "camera_matrix.csv";
    return out;
}

/// Record3D's metadata, or a null value when it is none.
nlohmann::json readMetadata(const fs::path& folder) {
    for (const char* name : {"metadata.json", "metadata"}) {
        std::ifstream in(folder / name);
        if (!in || fs::is_directory(folder / name)) continue;
        auto json = nlohmann::json::parse(in, nullptr, false);
        if (json.is_object() && json.contains("K") && json.contains("w")) return json;
    }
    return {};
}

}  // namespace

bool isStrayFolder(const std::string& folder) {
    return fs::exists(fs::path(folder) / "camera_matrix.csv") &&
           fs::exists(fs::path(folder) / "odometry.csv");
}

DatasetDescription loadStray(const std::string& folder_name, const DatasetOptions& options) {
    const fs::path folder(folder_name);
    DatasetDescription out;
    out.folder = folder_name;
    out.format = "stray";
    if (!isStrayFolder(folder_name))
        throw std::runtime_error(folder_name + " has no camera_matrix.csv and odometry.csv");
    if (!fs::is_directory(folder / "rgb"))
        throw std::runtime_error(
            folder_name + " has no rgb/: take the images out of rgb.mp4 first: mkdir rgb && ffmpeg -i " +
            "rgb.mp4 -start_number 0 -vsync 0 rgb/%06d.png");
    readPairs(options, out);
    out.frame_rate = 0;
    const std::string file = (folder / "odometry.csv").string();
    const auto odometry = readOdometry(file);
    std::vector<DatasetEntry> timed;
    for (DatasetEntry entry : out.frames) {
        const auto pose = odometry.find(static_cast<long long>(entry.timestamp));
        if (pose == odometry.end()) continue;
        entry.timestamp = entry.depth_timestamp = pose->second.timestamp;
        timed.push_back(entry);
    }
    if (timed.empty()) throw std::runtime_error(file + " has none of the images' numbers");
    if (timed.size() < out.frames.size())
        out.notes.push_back(std::to_string(out.frames.size() - timed.size()) +
                            " pairs have no line in odometry.csv, and are left out");
    out.frames = std::move(timed);
    finishFrames(out);
    const auto given = givenCamera(folder_name, options.folder);
    setPhoneCamera(given ? *given : readCameraMatrix((folder / "camera_matrix.csv").string()), out);
    for (const auto& [number, pose] : odometry) out.ground_truth.poses.push_back(pose);
    std::stable_sort(out.ground_truth.poses.begin(), out.ground_truth.poses.end(),
                     [](const StampedPose& a, const StampedPose& b) { return a.timestamp < b.timestamp; });
    for (StampedPose& pose : out.ground_truth.poses) pose.timestamp = roundToMicroseconds(pose.timestamp);
    out.ground_truth.file = file;
    out.ground_truth.note = kWhose;
    return out;
}

bool isRecord3dFolder(const std::string& folder_name) {
    const fs::path folder(folder_name);
    return fs::is_directory(folder / "rgb") && fs::is_directory(folder / "depth") &&
           !readMetadata(folder).is_null();
}

DatasetDescription loadRecord3d(const std::string& folder_name, const DatasetOptions& options) {
    DatasetDescription out;
    out.folder = folder_name;
    out.format = "record3d";
    const auto metadata = readMetadata(folder_name);
    if (metadata.is_null())
        throw std::runtime_error(folder_name + " has no metadata or metadata.json with K, w and h");
    const std::string where = folder_name + ": metadata";
    const auto camera = givenCamera(folder_name, options.folder);
    if (!camera) throw std::runtime_error(where + ": no camera in it");
    readPairs(options, out);
    const double rate = frameRate(options.folder, camera, kPhoneRate);
    try {
        const auto poses = metadata.value("poses", std::vector<std::vector<double>>());
        const Pose T_arkit_optical(Eigen::Quaterniond(0, 1, 0, 0),
                                   Eigen::Vector3d::Zero());  // y up, z backwards
        for (std::size_t i = 0; i < poses.size(); i++) {
            const auto& v = poses[i];
            if (v.size() != 7) throw std::runtime_error(where + ": poses are qx qy qz qw x y z");
            out.ground_truth.poses.push_back(
                {roundToMicroseconds(static_cast<double>(i) / rate),
                 poseOf({v[4], v[5], v[6]}, Eigen::Quaterniond(v[3], v[0], v[1], v[2]), where) *
                     T_arkit_optical});
        }
    } catch (const nlohmann::json::exception& error) {
        throw std::runtime_error(where + ": " + error.what());
    }
    out.frame_rate = rate;
    for (DatasetEntry& entry : out.frames) entry.timestamp = entry.depth_timestamp = entry.timestamp / rate;
    finishFrames(out);
    out.notes.push_back("times are frame numbers at " + std::to_string(rate).substr(0, 5) + " Hz");
    setPhoneCamera(*camera, out);
    if (out.ground_truth.poses.empty()) return out;
    out.ground_truth.file = folder_name;
    out.ground_truth.note = kWhose;
    return out;
}

}  // namespace roevo
