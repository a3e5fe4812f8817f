#include "roevo_mrpt/observation_converter.h"

#include <mrpt/io/CMemoryStream.h>
#include <mrpt/obs/CObservation3DRangeScan.h>
#include <mrpt/serialization/CArchive.h>

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <iterator>
#include <opencv2/imgproc.hpp>
#include <stdexcept>

#include "camera/off_centre.h"
#include "embedded_jpegs.h"
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
    const bool in_file = scan.intensityImage.isExternallyStored();
    if (!scan.hasIntensityImage || (!in_file && scan.intensityImage.isEmpty()))
        throw std::runtime_error(EmbeddedJpegs::isReplacement(scan.intensityImage)
                                     ? "the observation's colour image is damaged"
                                     : "the observation has no colour or grey image");
    // Not through CImage: it would keep the pixels in memory, and report a damaged file with a stack trace.
    if (in_file) return readColourFile(scan.intensityImage.getExternalStorageFileAbsolutePath());
    const cv::Mat image = scan.intensityImage.asCvMatRef();
    const bool rgb = scan.intensityImage.getChannelsOrder().rfind("RGB", 0) == 0;
    cv::Mat bgr;
    if (image.channels() == 3 && rgb)
        cv::cvtColor(image, bgr, cv::COLOR_RGB2BGR);
    else if (image.channels() == 4)
        cv::cvtColor(image, bgr, rgb ? cv::COLOR_RGBA2BGR : cv::COLOR_BGRA2BGR);
    else
        return image;
    return bgr;
}

cv::Mat depthOf(const CObservation3DRangeScan& scan, const PinholeCamera& depth_camera) {
    const auto& range = scan.rangeImage;
    if (scan.rangeImage_isExternallyStored() && range.rows() == 0) {
        const std::string file = scan.rangeImage_getExternalStorageFileAbsolutePath("");
        std::error_code error;
        const bool there = std::filesystem::exists(file, error);
        if (error) throw std::runtime_error("cannot read range image (" + error.message() + "): " + file);
        throw std::runtime_error(
            (there ? "cannot read range image (damaged): " : "range image file not found: ") + file);
    }
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

/// A damaged rawlog may hold any bytes in place of a pose. @throws std::runtime_error
void checkRigid(const mrpt::poses::CPose3D& pose, const char* name) {
    constexpr double kFarthest = 1e8;    // m; coordinates of a national grid are within
    constexpr double kTolerance = 1e-4;  // of each element; old recordings have rotations in single precision
    Eigen::Matrix3d R;
    for (int r = 0; r < 3; r++)
        for (int c = 0; c < 3; c++) R(r, c) = pose.getRotationMatrix()(r, c);
    // Not "any is larger": nothing is larger than what is not a number
    const bool near =
        std::abs(pose.x()) < kFarthest && std::abs(pose.y()) < kFarthest && std::abs(pose.z()) < kFarthest;
    const bool rotation =
        ((R * R.transpose() - Eigen::Matrix3d::Identity()).array().abs() < kTolerance).all() &&
        R.determinant() > 0;
    if (!near || !rotation)
        throw std::runtime_error(std::string("the observation's ") + name +
                                 " is not rigid (a rotation and a translation): damaged recording");
}

/// Which would turn the colour camera away from the depth camera: it stands for no difference between the
/// two. So some programs write it, and so MRPT reads old recordings.
bool hasNoColourPose(const CObservation3DRangeScan& scan) {
    return scan.relativePoseIntensityWRTDepth == mrpt::poses::CPose3D();
}

/// Where the colour camera is on the sensor, whose x axis is the depth camera's view.
mrpt::poses::CPose3D colourOnSensor(const CObservation3DRangeScan& scan) {
    return hasNoColourPose(scan) ? relativePoseOfColour(Pose::Identity())
                                 : scan.relativePoseIntensityWRTDepth;
}

void checkColourPose(const CObservation3DRangeScan& scan) {
    checkRigid(scan.relativePoseIntensityWRTDepth, "pose of the colour camera");
    constexpr double kLeastCosine = 0.5;  // of 60 degrees
    const double cosine = colourOnSensor(scan).getRotationMatrix()(0, 2);
    if (cosine < kLeastCosine)
        throw std::runtime_error(
            "the observation's relativePoseIntensityWRTDepth turns the colour camera " +
            std::to_string(std::lround(std::acos(std::max(cosine, -1.0)) * 180 / M_PI)) +
            " degrees away from the depth camera; of cameras that look alike it is (0, 0, 0, "
            "-90, 0, -90 degrees)");
}

bool camerasCoincide(const CObservation3DRangeScan& scan, const PinholeCamera& depth_camera,
                     const PinholeCamera& colour_camera) {
    return depth_camera == colour_camera &&
           (hasNoColourPose(scan) || scan.doDepthAndIntensityCamerasCoincide());
}

/// MRPT takes the size of the range image for that of its camera, whatever was stored, and leaves the rest.
void checkIsOfThisSize(const PinholeCamera& depth_camera, const PinholeCamera& colour_camera) {
    constexpr double kMostOff = 0.25;
    if (depth_camera == colour_camera) return;  // which is warned of
    if (offCentre(depth_camera) > kMostOff)
        throw std::runtime_error("the depth camera's principal point is far from the middle of its " +
                                 std::to_string(depth_camera.width) + "x" +
                                 std::to_string(depth_camera.height) +
                                 " pixels: its intrinsics are those of another image size");
}

}  // namespace

PinholeCamera colourCameraOf(const CObservation3DRangeScan& scan) {
    return fromMrptCamera(scan.cameraParamsIntensity, "colour camera");
}

PinholeCamera depthCameraOf(const CObservation3DRangeScan& scan) {
    return fromMrptCamera(scan.cameraParams, "depth camera");
}

bool depthIsAsStored(const CObservation3DRangeScan& scan) {
    return scan.range_is_depth && camerasCoincide(scan, depthCameraOf(scan), colourCameraOf(scan));
}

Pose colourFromDepthAsStored(const Pose& T_depth_colour) {
    mrpt::io::CMemoryStream memory;
    auto archive = mrpt::serialization::archiveFrom(memory);
    archive << relativePoseOfColour(T_depth_colour);
    memory.Seek(0);
    mrpt::poses::CPose3D stored;
    archive >> stored;
    return colourFromDepth(stored);
}

bool isMountedOnRobot(const CObservation3DRangeScan& scan) {
    constexpr double kTolerance = 1e-9;  // m, rad: stored as double, but often computed
    return !toEigen(scan.sensorPose).isApprox(Pose::Identity(), kTolerance);
}

Pose cameraOnRobot(const CObservation3DRangeScan& scan) {
    return toEigen(scan.sensorPose) * toEigen(colourOnSensor(scan));
}

std::vector<StampedPose> robotTrajectory(const std::vector<StampedPose>& camera_trajectory,
                                         const std::vector<StampedPose>& mounts) {
    std::vector<StampedPose> robot = camera_trajectory;
    auto mount = mounts.begin();
    for (StampedPose& pose : robot) {
        while (std::next(mount) != mounts.end() && std::next(mount)->timestamp <= pose.timestamp) ++mount;
        pose.T_world_camera =
            mounts.front().T_world_camera * pose.T_world_camera * mount->T_world_camera.inverse();
    }
    return robot;
}

RgbdFrame toRgbdFrame(const CObservation3DRangeScan& scan) {
    const PinholeCamera colour_camera = colourCameraOf(scan);
    const PinholeCamera depth_camera = depthCameraOf(scan);

    checkRigid(scan.sensorPose, "sensor pose");
    checkColourPose(scan);

    RgbdFrame frame;
    frame.timestamp = fromMrptTime(scan.timestamp);
    const cv::Mat image = imageOf(scan);
    checkSize(image.cols, image.rows, colour_camera, "colour");
    frame.grey = toGrey(image);
    if (image.channels() == 3) frame.colour = image;

    frame.depth = depthOf(scan, depth_camera);
    checkIsOfThisSize(depth_camera, colour_camera);
    if (!camerasCoincide(scan, depth_camera, colour_camera))
        frame.depth =
            registerDepth(frame.depth, depth_camera, colour_camera, colourFromDepth(colourOnSensor(scan)));
    return frame;
}

CObservation3DRangeScan toScan(const RgbdFrame& frame, const PinholeCamera& camera,
                               const Pose& T_robot_camera) {
    constexpr double kUnitsPerMetre = 5000, kMost = 65535;
    CObservation3DRangeScan scan;
    scan.timestamp = toMrptTime(frame.timestamp);
    scan.sensorLabel = "RGBD";
    scan.sensorPose = sensorPoseFromOptical(T_robot_camera);
    scan.cameraParams = scan.cameraParamsIntensity = toMrptCamera(camera, scan.sensorLabel);
    scan.range_is_depth = true;
    scan.rangeUnits = depthUnit(kUnitsPerMetre);
    scan.maxRange = static_cast<float>(kMost) * scan.rangeUnits;
    scan.hasRangeImage = !frame.depth.empty();
    scan.rangeImage_setSize(frame.depth.rows, frame.depth.cols);
    for (int v = 0; v < frame.depth.rows; v++)
        for (int u = 0; u < frame.depth.cols; u++) {
            const double units = std::round(frame.depth.at<float>(v, u) * kUnitsPerMetre);
            scan.rangeImage(v, u) =
                units >= 0 && units <= kMost ? static_cast<std::uint16_t>(units) : std::uint16_t{0};
        }
    scan.hasIntensityImage = true;
    scan.intensityImageChannel = CObservation3DRangeScan::CH_VISIBLE;
    scan.intensityImage =
        mrpt::img::CImage(frame.colour.empty() ? frame.grey : frame.colour, mrpt::img::DEEP_COPY);
    return scan;
}

}  // namespace roevo
