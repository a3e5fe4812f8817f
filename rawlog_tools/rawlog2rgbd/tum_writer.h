#pragma once
#include <Eigen/Core>
#include <opencv2/core/mat.hpp>
#include <optional>
#include <string>
#include <vector>

#include "programs/whole_folder.h"
#include "roevo/camera/pinhole_camera.h"

namespace roevo {

/// What camera.txt says.
struct TumCamera {
    PinholeCamera camera;
    double depth_scale = 5000;       ///< PNG units per metre
    std::vector<std::string> notes;  ///< "key: value" lines that readers pass over
};

/// Writes a folder in TUM RGB-D layout: rgb/, depth/, rgb.txt, depth.txt, associations.txt, camera.txt, and
/// what there is of accelerometer.txt, imu.txt and groundtruth.txt.
class TumWriter {
  public:
    /// @throws std::runtime_error when the folder exists and is not empty, or cannot be created
    explicit TumWriter(const std::string& folder);

    /// @param timestamp        s, not used before
    /// @param depth_timestamp  s, where the depth image has one of its own
    /// @param depth_u16   CV_16UC1
    /// @param image       CV_8UC3 (BGR) or CV_8UC1, becomes a PNG file
    /// @param image_file  if not empty, hard-linked or copied instead of writing `image`
    void add(double timestamp, std::optional<double> depth_timestamp, const cv::Mat& depth_u16,
             const cv::Mat& image, const std::string& image_file);

    /// Why the depth images' own stamps cannot be used, or "": see depthTimesFault() of the datasets.
    std::string ownDepthTimesFault();

    /// @param acceleration m/s^2 @param angular_velocity rad/s. Without it the sample goes to
    /// accelerometer.txt, with it to imu.txt (stamp, angular velocity, acceleration).
    void addImu(double timestamp, const Eigen::Vector3d& acceleration,
                const std::optional<Eigen::Vector3d>& angular_velocity);

    /// @param own_depth_times  depth.txt has the depth images' own stamps, not those of their colour images
    /// Writes the lists, takes a copy of the ground truth (empty: none) and gives the folder its name.
    /// @throws std::runtime_error when something cannot be written
    void finish(const TumCamera& camera, const std::string& ground_truth_file, bool own_depth_times);

  private:
    struct Row {
        double timestamp;
        std::optional<double> depth_timestamp;
        std::string image, depth;  ///< relative to the folder
    };

    void sortRows();
    void writeLists(bool own_depth_times);

    WholeFolder folder_;
    std::vector<Row> rows_;
    std::string accelerometer_, imu_;
};

}  // namespace roevo
