#pragma once
#include <memory>
#include <opencv2/core/mat.hpp>
#include <string>

#include "roevo/camera/pinhole_camera.h"

namespace roevo {

struct RawlogWriterOptions {
    std::string sensor_label = "RGBD";
    float range_units = 1.f / 5000;  ///< metres per unit of the depth image
    int gz_level = 1;                ///< 0 (none) to 9
};

/// Writes an observations-only rawlog of CObservation3DRangeScan: depth inside the file (lossless, uint16),
/// colour as external files in <stem>_Images beside it. Nothing appears under the final names before
/// finish().
class RawlogWriter {
  public:
    /// @param path    "….rawlog"; an older rawlog there is replaced, with its images, when finish() is called
    /// @param camera  of depth and colour alike (depth is registered to colour)
    /// @throws std::runtime_error when the path cannot be written, or when <stem>_Images exists without its
    /// rawlog.
    RawlogWriter(const std::string& path, const PinholeCamera& camera,
                 const RawlogWriterOptions& options = {});
    /// Without finish(), removes what was written.
    ~RawlogWriter();
    RawlogWriter(const RawlogWriter&) = delete;
    RawlogWriter& operator=(const RawlogWriter&) = delete;

    /// Adds a frame, writing its image as PNG.
    /// @param timestamp        seconds, kept to the microsecond
    /// @param depth_u16        CV_16UC1 in range_units, 0 where unknown, of the camera's size
    /// @param colour_or_grey   CV_8UC3 (BGR) or CV_8UC1 of the camera's size
    void add(double timestamp, const cv::Mat& depth_u16, const cv::Mat& colour_or_grey);

    /// Adds a frame whose image is an existing file; it is hard-linked or copied, never re-encoded.
    void addFile(double timestamp, const cv::Mat& depth_u16, const std::string& image_file);

    /// Closes the rawlog and moves it and its images into place. @throws std::runtime_error when the disk is
    /// full.
    void finish();

    /// Where the external images of a rawlog belong: <dir>/<stem>_Images.
    static std::string imagesDirectory(const std::string& rawlog_path);

  private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace roevo
