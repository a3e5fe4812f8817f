#include "tools/folder_writer.h"

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include "programs/text.h"
#include "recordings/camera_file.h"
#include "support/run_program.h"

namespace roevo::test {

namespace fs = std::filesystem;

FolderWriter::FolderWriter(const DatasetReader& from, const fs::path& to) : from_(from), to_(to) {
    fs::create_directories(to);
}

long FolderWriter::number(std::size_t i) const {
    return std::lround(30 * time(i));
}

cv::Mat FolderWriter::millimetres(std::size_t i) const {
    cv::Mat out;
    depth(i).convertTo(out, CV_16U, 0.2);
    return out;
}

void FolderWriter::image(const std::string& name, const cv::Mat& image) const {
    fs::create_directories((to_ / name).parent_path());
    ASSERT_TRUE(cv::imwrite((to_ / name).string(), image)) << name;
}

void FolderWriter::text(const std::string& name, const std::string& text) const {
    fs::create_directories((to_ / name).parent_path());
    writeFile(to_ / name, text);
}

void FolderWriter::cameraFile(const std::string& more) const {
    text("camera.txt", cameraFileText(camera(), 5000, {}, allDigits) + more);
}

void FolderWriter::copyTruth() const {
    fs::copy_file(truth().file, to_ / "groundtruth.txt");
}

void FolderWriter::images(const Name& colour_name, const Name& depth_name) const {
    for (std::size_t i = 0; i < size(); i++) {
        image(colour_name(i), colour(i));
        image(depth_name(i), depth(i));
    }
}

std::string format(const char* pattern, double value) {
    char text[100];
    std::snprintf(text, sizeof text, pattern, value);
    return text;
}

std::string format(const char* pattern, long value) {
    char text[100];
    std::snprintf(text, sizeof text, pattern, value);
    return text;
}

std::string format(const char* pattern, const PinholeCamera& c) {
    char text[2000];
    std::snprintf(text, sizeof text, pattern, c.width, c.height, c.fx, c.fy, c.cx, c.cy);
    return text;
}

namespace {

void npyFile(const fs::path& file, const cv::Mat& image, const char* type) {
    std::string head = std::string("{'descr': '") + type + "', 'fortran_order': False, 'shape': (" +
                       std::to_string(image.rows) + ", " + std::to_string(image.cols) + "), }";
    head.resize(118, ' ');
    head[117] = '\n';
    fs::create_directories(file.parent_path());
    std::ofstream out(file, std::ios::binary);
    out << std::string("\x93NUMPY\x01\x00\x76\x00", 10) << head;
    out.write(reinterpret_cast<const char*>(image.data),
              static_cast<std::streamsize>(image.total() * image.elemSize()));
}

}  // namespace

Arguments writeArrays(const DatasetReader& from, const fs::path& to, int depth_type, const char* type) {
    const FolderWriter out(from, to);
    for (std::size_t i = 0; i < out.size(); i++) {
        out.image(format("rgb/%05ld.png", out.number(i)), out.colour(i));
        cv::Mat image = out.depth(i);
        if (depth_type != CV_16U) out.metres(i).convertTo(image, depth_type);
        npyFile(to / format("depth/%05ld.npy", out.number(i)), image, type);
    }
    out.copyTruth();
    out.cameraFile();
    if (depth_type == CV_16U) return {};
    return {"--depth-scale", "1"};
}

cv::Mat halved(const cv::Mat& image) {
    cv::Mat out;
    cv::resize(image, out, {}, 0.5, 0.5, cv::INTER_NEAREST);
    return out;
}

/// What a camera with a lens would have seen: bilinear, depth of the nearest pixel; black where the ideal
/// image ends.
Arguments writeThroughLens(const DatasetReader& from, const fs::path& to, const PinholeCamera& lens) {
    const FolderWriter out(from, to);
    PinholeCamera camera = out.camera();
    camera.distortion = lens.distortion;
    camera.denominator = lens.denominator;
    camera.lens = lens.lens;
    cv::Mat x(camera.height, camera.width, CV_32FC1), y = x.clone();
    for (int v = 0; v < camera.height; v++)
        for (int u = 0; u < camera.width; u++) {
            const Eigen::Vector2d ideal = camera.undistortPixel({u, v});
            x.at<float>(v, u) = static_cast<float>(ideal.x());
            y.at<float>(v, u) = static_cast<float>(ideal.y());
        }
    for (std::size_t i = 0; i < out.size(); i++) {
        cv::Mat colour, depth;
        cv::remap(out.colour(i), colour, x, y, cv::INTER_LINEAR, cv::BORDER_REPLICATE);
        cv::remap(out.depth(i), depth, x, y, cv::INTER_NEAREST);
        out.image(format("rgb/%05ld.png", out.number(i)), colour);
        out.image(format("depth/%05ld.png", out.number(i)), depth);
    }
    out.copyTruth();
    out.text("camera.txt", cameraFileText(camera, 5000, {"frame_rate: 30"}, allDigits));
    return {};
}

namespace {

std::string poseText(const Pose& pose) {
    std::string out;
    for (int row = 0; row < 4; row++)
        for (int column = 0; column < 4; column++)
            out += allDigits(pose.matrix()(row, column)) + (column < 3 ? " " : "\n");
    return out;
}

}  // namespace

Arguments writeScanNet(const DatasetReader& from, const fs::path& to) {
    const FolderWriter out(from, to);
    for (std::size_t i = 0; i < out.size(); i++) {
        out.image(format("color/%ld.jpg", out.number(i)), out.colour(i));
        out.image(format("depth/%ld.png", out.number(i)), halved(out.millimetres(i)));
        out.text(format("pose/%ld.txt", out.number(i)), poseText(out.truth().poses[i].T_world_camera));
    }
    const auto intrinsic = [&](const PinholeCamera& c) {
        char text[400];
        std::snprintf(text, sizeof text, "%.17g 0 %.17g 0\n0 %.17g %.17g 0\n0 0 1 0\n0 0 0 1\n", c.fx, c.cx,
                      c.fy, c.cy);
        return std::string(text);
    };
    PinholeCamera depth = out.camera();
    for (double* value : {&depth.fx, &depth.fy, &depth.cx, &depth.cy}) *value /= 2;
    out.text("intrinsic/intrinsic_color.txt", intrinsic(out.camera()));
    out.text("intrinsic/intrinsic_depth.txt", intrinsic(depth));
    out.text("intrinsic/extrinsic_color.txt", poseText(Pose::Identity()));
    out.text("intrinsic/extrinsic_depth.txt", poseText(Pose::Identity()));
    return {};
}

namespace {

/// Every pixel of a depth image that is half as large is the mean of four, as that of a view in another size.
cv::Mat smallView(const cv::Mat& metres) {
    cv::Mat out;
    cv::resize(metres, out, {}, 0.5, 0.5, cv::INTER_AREA);
    cv::Mat known, all;
    cv::threshold(metres, known, 0, 1, cv::THRESH_BINARY);
    cv::resize(known, all, {}, 0.5, 0.5, cv::INTER_AREA);
    out.setTo(0, all < 1);
    return out;
}

}  // namespace

Arguments writeStray(const DatasetReader& from, const fs::path& to) {
    const FolderWriter out(from, to);
    std::string odometry = "timestamp, frame, x, y, z, qx, qy, qz, qw\n";
    for (std::size_t i = 0; i < out.size(); i++) {
        const std::string name = format("%06ld.png", static_cast<long>(i));
        cv::Mat depth;
        smallView(out.metres(i)).convertTo(depth, CV_16U, 1000);
        out.image("rgb/" + name, out.colour(i));
        out.image("depth/" + name, depth);
        const Pose& pose = out.truth().poses[i].T_world_camera;
        const Eigen::Quaterniond q(pose.linear());
        odometry += stampText(out.time(i)) + ", " + format("%06ld", static_cast<long>(i));
        for (const double v : {pose.translation().x(), pose.translation().y(), pose.translation().z(), q.x(),
                               q.y(), q.z(), q.w()})
            odometry += ", " + allDigits(v);
        odometry += "\n";
    }
    const PinholeCamera& c = out.camera();
    out.text("odometry.csv", odometry);
    out.text("camera_matrix.csv", allDigits(c.fx) + ", 0.0, " + allDigits(c.cx) + "\n0.0, " +
                                      allDigits(c.fy) + ", " + allDigits(c.cy) + "\n0.0, 0.0, 1.0\n");
    return {};
}

Arguments writeRecord3d(const DatasetReader& from, const fs::path& to) {
    setenv("OPENCV_IO_ENABLE_OPENEXR", "1", 0);
    const FolderWriter out(from, to);
    std::string poses;
    for (std::size_t i = 0; i < out.size(); i++) {
        out.image(format("rgb/%ld.png", static_cast<long>(i)), out.colour(i));
        out.image(format("depth/%ld.exr", static_cast<long>(i)), smallView(out.metres(i)));
        // ARKit's camera has y up and looks backwards
        Pose flip = Pose::Identity();
        flip.setRotation(Eigen::Vector3d(1, -1, -1).asDiagonal().toDenseMatrix());
        const Pose pose = out.truth().poses[i].T_world_camera * flip;
        const Eigen::Quaterniond q(pose.linear());
        poses += poses.empty() ? "[" : ", [";
        for (const double v : {q.x(), q.y(), q.z(), q.w(), pose.translation().x(), pose.translation().y()})
            poses += allDigits(v) + ", ";
        poses += allDigits(pose.translation().z()) + "]";
    }
    out.text(
        "metadata.json",
        format("{\"w\": %d, \"h\": %d, \"K\": [%.17g, 0, 0, 0, %.17g, 0, %.17g, %.17g, 1], \"fps\": 30, ",
               out.camera()) +
            "\"poses\": [" + poses + "]}");
    return {};
}

}  // namespace roevo::test
