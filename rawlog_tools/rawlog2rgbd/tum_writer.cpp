#include "rawlog2rgbd/tum_writer.h"

#include <algorithm>
#include <filesystem>

#include "programs/text.h"
#include "recordings/camera_file.h"
#include "recordings/depth_times.h"
#include "roevo_mrpt/file_copy.h"
#include "roevo_mrpt/image_conversions.h"

namespace fs = std::filesystem;

namespace roevo {
namespace {

/// Numbers after a blank each, with all their digits.
std::string numbersText(std::initializer_list<double> numbers) {
    std::string all;
    for (const double number : numbers) all += " " + allDigits(number);
    return all;
}

}  // namespace

TumWriter::TumWriter(const std::string& folder) : folder_(folder) {
    for (const char* part : {"rgb", "depth"}) folder_.makeFolder(part);
}

void TumWriter::add(double timestamp, std::optional<double> depth_timestamp, const cv::Mat& depth_u16,
                    const cv::Mat& image, const std::string& image_file) {
    const std::string ending = image_file.empty() ? ".png" : fs::path(image_file).extension().string();
    std::string depth_name = "depth/" + stampText(depth_timestamp.value_or(timestamp));
    while (fs::exists(folder_ / (depth_name + ".png"))) depth_name += "_";  // stamps of a foreign file
    const Row row{timestamp, depth_timestamp, "rgb/" + stampText(timestamp) + ending, depth_name + ".png"};
    const fs::path image_target = folder_ / row.image, depth_target = folder_ / row.depth;
    if (image_file.empty()) {
        writeImageFile(image_target.string(), image);
    } else {
        linkOrCopyFile(image_file, image_target.string());
    }
    writeImageFile(depth_target.string(), depth_u16);
    rows_.push_back(row);
}

void TumWriter::addImu(double timestamp, const Eigen::Vector3d& acceleration,
                       const std::optional<Eigen::Vector3d>& angular_velocity) {
    const std::string a = numbersText({acceleration.x(), acceleration.y(), acceleration.z()});
    if (!angular_velocity) {
        accelerometer_ += stampText(timestamp) + a + "\n";
        return;
    }
    const Eigen::Vector3d& w = *angular_velocity;
    imu_ += stampText(timestamp) + numbersText({w.x(), w.y(), w.z()}) + a + "\n";
}

void TumWriter::sortRows() {
    std::sort(rows_.begin(), rows_.end(),
              [](const Row& a, const Row& b) { return a.timestamp < b.timestamp; });
}

std::string TumWriter::ownDepthTimesFault() {
    sortRows();
    std::vector<double> colour;
    std::vector<std::optional<double>> depth;
    for (const Row& row : rows_) {
        colour.push_back(row.timestamp);
        depth.push_back(row.depth_timestamp);
    }
    return depthTimesFault(colour, depth);
}

void TumWriter::writeLists(bool own_depth_times) {
    sortRows();
    std::string rgb = "# color images\n# timestamp filename\n",
                depth = "# depth maps\n# timestamp filename\n";
    std::string pairs;
    for (const Row& row : rows_) {
        const std::string of_colour = stampText(row.timestamp) + " " + row.image;
        const std::string of_depth =
            stampText(own_depth_times ? row.depth_timestamp.value() : row.timestamp) + " " + row.depth;
        rgb += of_colour + "\n";
        depth += of_depth + "\n";
        pairs += of_colour + " " + of_depth + "\n";
    }
    folder_.write("rgb.txt", rgb);
    folder_.write("depth.txt", depth);
    folder_.write("associations.txt", pairs);
}

void TumWriter::finish(const TumCamera& camera, const std::string& ground_truth_file, bool own_depth_times) {
    writeLists(own_depth_times);
    folder_.write("camera.txt", cameraFileText(camera.camera, camera.depth_scale, camera.notes, plainNumber));
    if (!accelerometer_.empty())
        folder_.write("accelerometer.txt",
                      "# accelerometer data, m/s^2\n# timestamp ax ay az\n" + accelerometer_);
    if (!imu_.empty())
        folder_.write("imu.txt", "# inertial data, rad/s and m/s^2\n# timestamp wx wy wz ax ay az\n" + imu_);
    if (!ground_truth_file.empty()) copyFile(ground_truth_file, (folder_ / "groundtruth.txt").string());
    folder_.commit();
}

}  // namespace roevo
