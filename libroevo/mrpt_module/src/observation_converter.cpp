#include "roevo_mrpt/observation_converter.h"

#include <mrpt/obs/CObservation3DRangeScan.h>

#include <opencv2/imgproc.hpp>
#include <stdexcept>

#include "roevo/camera/depth_registration.h"
#include "roevo_mrpt/camera_conversions.h"
#include "roevo_mrpt/image_conversions.h"
#include "roevo_mrpt/pose_conversions.h"
#include "roevo_mrpt/time_conversions.h"

namespace roevo {
namespace {

using mrpt::obs::CObservation3DRangeScan;

void checkSize(int width, int height, const PinholeCamera& camera, const std::string& what) {
    if (width == camera.width && height == camera.height) return;
    throw std::runtime_error("the " + what + " image is " + std::to_string(width) + "x" +
                             std::to_string(height) + ", but its intrinsics are for " +
                             std::to_string(camera.width) + "x" + std::to_string(camera.height));
}

/// The scan's image, shared where it is in memory; grey or BGR.
cv::Mat imageOf(const CObservation3DRangeScan& scan) {
    if (!scan.hasIntensityImage) throw std::runtime_error("the observation has no colour or grey image");
    // Not through CImage: it would keep the pixels in memory, and report a damaged file with a stack trace.
    if (scan.intensityImage.isExternallyStored())
        return readColourFile(scan.intensityImage.getExternalStorageFileAbsolutePath());
    cv::Mat image = scan.intensityImage.asCvMatRef();
    if (image.channels() == 3 && scan.intensityImage.getChannelsOrder() == "RGB")
        cv::cvtColor(image, image, cv::COLOR_RGB2BGR);
    return image;
}

cv::Mat depthOf(const CObservation3DRangeScan& scan, const PinholeCamera& depth_camera) {
    const auto& range = scan.rangeImage;
    if (!scan.hasRangeImage || range.rows() == 0)
        throw std::runtime_error("the observation has no range image");
    if (!(scan.rangeUnits > 0)) throw std::runtime_error("the observation's rangeUnits is not above 0");
    const int rows = static_cast<int>(range.rows()), cols = static_cast<int>(range.cols());
    checkSize(cols, rows, depth_camera, "range");
    const cv::Mat view(rows, cols, CV_16UC1, const_cast<std::uint16_t*>(&range(0, 0)));
    cv::Mat depth = depthToMetres(view, scan.rangeUnits);
    if (!scan.range_is_depth) rangeToDepth(depth, depth_camera);
    return depth;
}

}  // namespace

PinholeCamera colourCameraOf(const CObservation3DRangeScan& scan) {
    return fromMrptCamera(scan.cameraParamsIntensity, "colour camera");
}

RgbdFrame toRgbdFrame(const CObservation3DRangeScan& scan) {
    const PinholeCamera colour_camera = colourCameraOf(scan);
    const PinholeCamera depth_camera = fromMrptCamera(scan.cameraParams, "depth camera");

    RgbdFrame frame;
    frame.timestamp = fromMrptTime(scan.timestamp);
    const cv::Mat image = imageOf(scan);
    checkSize(image.cols, image.rows, colour_camera, "colour");
    frame.grey = toGrey(image);
    if (image.channels() == 3) frame.colour = image;

    frame.depth = depthOf(scan, depth_camera);
    if (depth_camera != colour_camera || !scan.doDepthAndIntensityCamerasCoincide()) {
        const Pose T_depthsensor_colour = toEigen(scan.relativePoseIntensityWRTDepth);
        frame.depth = registerDepth(frame.depth, depth_camera, colour_camera,
                                    T_depthsensor_colour.inverse() * sensorFromOptical());
    }
    return frame;
}

}  // namespace roevo
