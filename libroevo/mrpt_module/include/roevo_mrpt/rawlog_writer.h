#pragma once
#include <Eigen/Core>
#include <memory>
#include <opencv2/core/mat.hpp>
#include <optional>
#include <string>

#include "roevo/camera/pinhole_camera.h"
#include "roevo/types.h"

namespace mrpt::serialization {
class CSerializable;
}

namespace roevo {

/// A depth camera that is not the colour camera.
struct DepthCamera {
    PinholeCamera camera;
    Pose T_depth_colour = Pose::Identity();  ///< optical frames, metres
};

struct RawlogWriterOptions {
    std::string sensor_label = "RGBD";
    float range_units = 1.f / 5000;  ///< metres per unit of the depth image
    int gz_level = 1;                ///< 0 (none) to 9
    bool externalize_depth = false;  ///< depth as files of MRPT's own binary format, lossless as well
    int jpeg_quality = 0;            ///< 1 to 100: images given to add() become JPEG (lossy); 0: PNG
    std::string imu_label = "IMU";
    std::optional<DepthCamera> depth_camera;  ///< none: depth is registered to the colour camera
};

/// Writes an observations-only rawlog of CObservation3DRangeScan: depth inside the file (lossless, uint16),
/// or in files beside it, colour as external files in `<stem>_Images` beside it. Nothing appears under the
/// final names before finish(); until then everything is in "<path>.part/".
class RawlogWriter {
  public:
    /// @param path    "….rawlog"; an older rawlog there is replaced, with its images, when finish() is called
    /// @param camera  of the colour images, and of depth where options name no other
    /// @throws std::runtime_error when the path cannot be written, or when `<stem>_Images` exists without its
    /// rawlog.
    RawlogWriter(const std::string& path, const PinholeCamera& camera,
                 const RawlogWriterOptions& options = {});
    /// Without finish(), removes what was written.
    ~RawlogWriter();
    RawlogWriter(const RawlogWriter&) = delete;
    RawlogWriter& operator=(const RawlogWriter&) = delete;

    /// Adds a frame, writing its image as PNG or JPEG.
    /// @param timestamp        seconds, kept to the microsecond
    /// @param depth_u16        CV_16UC1 in range_units, 0 where unknown, of its camera's size
    /// @param colour_or_grey   CV_8UC3 (BGR) or CV_8UC1 of the camera's size
    void add(double timestamp, const cv::Mat& depth_u16, const cv::Mat& colour_or_grey);

    /// Adds a frame whose image is an existing file; it is hard-linked or copied, never re-encoded.
    void addFile(double timestamp, const cv::Mat& depth_u16, const std::string& image_file);

    /// Adds a CObservationIMU, in the sensor's own axes. Call in the order of time.
    /// @param acceleration      m/s^2
    /// @param angular_velocity  rad/s
    void addImu(double timestamp, const Eigen::Vector3d& acceleration,
                const std::optional<Eigen::Vector3d>& angular_velocity = std::nullopt);

    /// Adds whatever else a rawlog may hold: an observation, or an action, then a sensory frame.
    void add(const mrpt::serialization::CSerializable& object);

    /// Links or copies an image for an object that is added. @return the name that the object refers to it by
    std::string addImageFile(const std::string& image_file);

    /// Ends the file, which can then be read, and checked, under temporaryPath().
    /// @throws std::runtime_error when the disk is full.
    void close();
    std::string temporaryPath() const;

    /// Closes the rawlog and moves it and its images into place. @throws std::runtime_error when the disk is
    /// full.
    void finish();

    /// Where the external images of a rawlog belong: `<dir>/<stem>_Images`.
    static std::string imagesDirectory(const std::string& rawlog_path);

    /// Where the ground truth of a rawlog belongs: `<dir>/<stem>_groundtruth.txt`.
    static std::string groundTruthFile(const std::string& rawlog_path);

  private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace roevo
