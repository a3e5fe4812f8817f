#pragma once
#include <mrpt/img/CImage.h>
#include <mrpt/io/CMemoryStream.h>
#include <mrpt/obs/CObservation3DRangeScan.h>
#include <mrpt/serialization/CArchive.h>

#include <opencv2/core.hpp>
#include <string>

#include "roevo_mrpt/camera_conversions.h"
#include "roevo_mrpt/time_conversions.h"

namespace roevo::test {

inline PinholeCamera smallCamera() {
    PinholeCamera camera;
    camera.width = 64;
    camera.height = 48;
    camera.fx = 60;
    camera.fy = 61;
    camera.cx = 31.2;
    camera.cy = 23.6;
    return camera;
}

/// Every value differs from its neighbours, and 0 (unknown) occurs.
inline cv::Mat patternDepth(const PinholeCamera& camera, int seed) {
    cv::Mat depth(camera.height, camera.width, CV_16UC1);
    cv::RNG rng(static_cast<std::uint64_t>(seed) + 1);
    for (int v = 0; v < depth.rows; v++)
        for (int u = 0; u < depth.cols; u++)
            depth.at<std::uint16_t>(v, u) = static_cast<std::uint16_t>(rng.uniform(0, 65536));
    depth.at<std::uint16_t>(3, 5) = 0;
    return depth;
}

inline cv::Mat patternColour(const PinholeCamera& camera, int seed) {
    cv::Mat colour(camera.height, camera.width, CV_8UC3);
    cv::RNG rng(static_cast<std::uint64_t>(seed) + 100);
    rng.fill(colour, cv::RNG::UNIFORM, 0, 256);
    return colour;
}

/// A scan with everything in memory.
inline mrpt::obs::CObservation3DRangeScan::Ptr makeScan(double timestamp, const PinholeCamera& camera,
                                                        const cv::Mat& depth, const cv::Mat& image,
                                                        const std::string& label = "RGBD") {
    auto scan = mrpt::obs::CObservation3DRangeScan::Create();
    scan->timestamp = toMrptTime(timestamp);
    scan->sensorLabel = label;
    scan->cameraParams = scan->cameraParamsIntensity = toMrptCamera(camera, label);
    scan->rangeUnits = 0.001f;
    scan->hasRangeImage = true;
    scan->rangeImage_setSize(depth.rows, depth.cols);
    for (int v = 0; v < depth.rows; v++)
        for (int u = 0; u < depth.cols; u++) scan->rangeImage(v, u) = depth.at<std::uint16_t>(v, u);
    scan->hasIntensityImage = true;
    scan->intensityImage = mrpt::img::CImage(image, mrpt::img::DEEP_COPY);
    return scan;
}

/// As a rawlog that is not compressed has it.
inline std::string bytesOf(const mrpt::serialization::CSerializable& object) {
    mrpt::io::CMemoryStream memory;
    auto archive = mrpt::serialization::archiveFrom(memory);
    archive << object;
    return {static_cast<const char*>(memory.getRawBufferData()), memory.getTotalBytesCount()};
}

/// While it lives, MRPT stores colour images in rawlogs as JPEG, as some robots do.
class ColourAsJpeg {
  public:
    ColourAsJpeg() { mrpt::img::CImage::DISABLE_JPEG_COMPRESSION(false); }
    ~ColourAsJpeg() { mrpt::img::CImage::DISABLE_JPEG_COMPRESSION(as_it_was_); }
    ColourAsJpeg(const ColourAsJpeg&) = delete;
    ColourAsJpeg& operator=(const ColourAsJpeg&) = delete;

  private:
    bool as_it_was_ = mrpt::img::CImage::DISABLE_JPEG_COMPRESSION();
};

}  // namespace roevo::test
