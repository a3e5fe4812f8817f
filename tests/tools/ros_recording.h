#pragma once
/// Small recordings for tests of bags: a simulated one, and one of a few tiny images.

#include <cmath>
#include <filesystem>
#include <opencv2/imgcodecs.hpp>

#include "recordings/dataset_reader.h"
#include "support/images.h"
#include "support/run_program.h"
#include "tools/ros_containers.h"

namespace roevo::test {

inline const std::string kColour = "/camera/rgb/image_color", kDepth = "/camera/depth_registered/image",
                         kColourInfo = "/camera/rgb/camera_info",
                         kDepthInfo = "/camera/depth_registered/camera_info";

inline PinholeCamera tinyCamera(double fx = 60) {
    PinholeCamera camera;
    camera.width = 40, camera.height = 32;
    camera.fx = fx, camera.fy = 61, camera.cx = 15.5, camera.cy = 11.5;
    camera.distortion = {0.1, -0.2, 0.001, 0.002, 0.3};
    return camera;
}
inline double tinyStamp(int i) {
    return 1305031453.25 + i / 8.;
}
/// A colour image in BGR of which every pixel is different.
inline cv::Mat tinyColour(int i, int channels = 3) {
    cv::Mat image(32, 40, CV_8UC(channels));
    for (int v = 0; v < image.rows; v++)
        for (int k = 0; k < image.cols * channels; k++)
            image.ptr(v)[k] = static_cast<std::uint8_t>(7 * v + 3 * k + 11 * i);
    return image;
}
/// Depth in millimetres with holes.
inline cv::Mat tinyDepth(int i) {
    cv::Mat image(32, 40, CV_16UC1);
    for (int v = 0; v < image.rows; v++)
        for (int u = 0; u < image.cols; u++)
            image.at<std::uint16_t>(v, u) =
                static_cast<std::uint16_t>((u + v) % 9 == 0 ? 0 : 500 + 97 * u + 31 * v + i);
    return image;
}

/// An ordinary recording with aligned depth.
inline Recording tinyRecording(Encoding encoding, int frames = 3) {
    Recording out{{kColourInfo, "sensor_msgs/CameraInfo", infoMessage(encoding, "rgb", tinyCamera())},
                  {"/rosout", "rosgraph_msgs/Log", "what nobody reads"}};
    for (int i = 0; i < frames; i++) {
        out.push_back({kColour, "sensor_msgs/Image",
                       imageMessage(encoding, tinyStamp(i), "rgb", tinyColour(i), "bgr8")});
        out.push_back({kDepth, "sensor_msgs/Image",
                       imageMessage(encoding, tinyStamp(i), "rgb", tinyDepth(i), "16UC1")});
    }
    return out;
}

/// The frames of a dataset as messages: bgr8, and 32FC1 in metres, which loses nothing.
inline Recording recordingOf(const DatasetReader& dataset, Encoding encoding) {
    Recording out{{kColourInfo, "sensor_msgs/CameraInfo", infoMessage(encoding, "rgb", dataset.camera())}};
    for (std::size_t i = 0; i < dataset.size(); i++) {
        cv::Mat metres;
        dataset.readDepth(i).convertTo(metres, CV_32FC1, 1 / dataset.depthScale());
        out.push_back(
            {kColour, "sensor_msgs/Image",
             imageMessage(encoding, dataset.entry(i).timestamp, "rgb", dataset.readImage(i), "bgr8")});
        out.push_back({kDepth, "sensor_msgs/Image",
                       imageMessage(encoding, dataset.entry(i).depth_timestamp, "rgb", metres, "32FC1")});
    }
    return out;
}

/// A kind of file, and how to write it.
struct BagKind {
    const char* name;
    Encoding encoding;
    const char* ending;
    std::string (*write)(const std::string& path, const Recording& recording);  ///< returns the input
};

template <char kMethod>
std::string writeRos1(const std::string& path, const Recording& recording) {
    writeBytes(path, Ros1BagBytes(recording, kMethod == 'l'   ? "lz4"
                                             : kMethod == 'b' ? "bz2"
                                                              : "none")
                         .bytes());
    return path;
}
template <char kMethod>
std::string writeMcap(const std::string& path, const Recording& recording) {
    const std::string method = kMethod == 'l'   ? "lz4"
                               : kMethod == 'z' ? "zstd"
                               : kMethod == 'o' ? "no chunks"
                                                : "";
    writeBytes(path, McapBytes(recording, method, kMethod == '1' ? "ros1" : "cdr").bytes());
    return path;
}
inline std::string writeDb3(const std::string& path, const Recording& recording) {
    std::filesystem::remove(path);
    writeSqliteBag(path, recording);
    return path;
}
/// As `ros2 bag record` leaves it: a folder, here of two files.
template <bool kMcap>
std::string writeFolder(const std::string& path, const Recording& recording) {
    std::filesystem::create_directories(path);
    const std::string ending = kMcap ? ".mcap" : ".db3";
    const auto middle = recording.begin() + static_cast<std::ptrdiff_t>(recording.size() / 2);
    const auto write = kMcap ? &writeMcap<'z'> : &writeDb3;
    write(path + "/walk_0" + ending, Recording(recording.begin(), middle));
    write(path + "/walk_1" + ending, Recording(middle, recording.end()));
    writeBytes(path + "/metadata.yaml",
               "rosbag2_bagfile_information:\n  version: 5\n  relative_file_paths:\n    - walk_0" + ending +
                   "\n    - walk_1" + ending + "\n  duration:\n    nanoseconds: 1\n");
    return path;
}

/// The bytes of an image file. @param ending  such as ".png"
inline std::string encoded(const std::string& ending, const cv::Mat& image) {
    std::vector<std::uint8_t> bytes;
    cv::imencode(ending, image, bytes);
    return {bytes.begin(), bytes.end()};
}

inline const std::vector<BagKind> kBagKinds = {
    {"Ros1", Encoding::kRos1, ".bag", &writeRos1<'n'>},
    {"Ros1Lz4", Encoding::kRos1, ".bag", &writeRos1<'l'>},
    {"Ros1Bz2", Encoding::kRos1, ".bag", &writeRos1<'b'>},
    {"Sqlite", Encoding::kCdrLittle, ".db3", &writeDb3},
    {"SqliteBigEndian", Encoding::kCdrBig, ".db3", &writeDb3},
    {"Mcap", Encoding::kCdrLittle, ".mcap", &writeMcap<'n'>},
    {"McapLz4", Encoding::kCdrLittle, ".mcap", &writeMcap<'l'>},
    {"McapZstd", Encoding::kCdrBig, ".mcap", &writeMcap<'z'>},
    {"McapWithoutChunks", Encoding::kCdrLittle, ".mcap", &writeMcap<'o'>},
    {"McapOfRos1", Encoding::kRos1, ".mcap", &writeMcap<'1'>},
    {"SqliteFolder", Encoding::kCdrLittle, "", &writeFolder<false>},
    {"McapFolder", Encoding::kCdrLittle, "", &writeFolder<true>},
};

}  // namespace roevo::test
