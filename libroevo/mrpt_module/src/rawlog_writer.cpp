#include "roevo_mrpt/rawlog_writer.h"

#include <mrpt/obs/CObservation3DRangeScan.h>
#include <mrpt/obs/CObservationIMU.h>

#include <array>
#include <cctype>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <opencv2/imgcodecs.hpp>
#include <stdexcept>

#include "gz_file.h"
#include "input/regular_file.h"
#include "roevo_mrpt/camera_conversions.h"
#include "roevo_mrpt/file_copy.h"
#include "roevo_mrpt/image_conversions.h"
#include "roevo_mrpt/pose_conversions.h"
#include "roevo_mrpt/time_conversions.h"

namespace fs = std::filesystem;

namespace roevo {
namespace {

std::string fileNamePart(std::string label) {
    for (char& c : label)
        if (!std::isalnum(static_cast<unsigned char>(c)) && c != '-' && c != '.') c = '_';
    return label;
}

void requireImage(const std::string& file) {
    if (!fs::is_regular_file(file)) throw std::runtime_error("image file not found: " + file);
}

}  // namespace

struct RawlogWriter::Impl {
    fs::path path, images;
    fs::path temporary, temporary_path, temporary_images;  // a folder, with the rawlog and its images in it
    PinholeCamera camera;
    RawlogWriterOptions options;
    mrpt::img::TCamera mrpt_camera;
    GzFile stream;
    bool closed = false, finished = false;

    void removeTemporaries() {
        if (!closed) stream.close();
        std::error_code ignored;
        fs::remove_all(temporary, ignored);
    }

    /// A name for the next file, unique even when stamps repeat.
    std::string nextName(double timestamp, const std::string& ending) const {
        std::array<char, 64> stamp{};
        std::snprintf(stamp.data(), stamp.size(), "_%.6f", timestamp);
        return unusedName(fileNamePart(options.sensor_label) + stamp.data(), ending);
    }

    std::string unusedName(const std::string& stem, const std::string& ending) const {
        std::string name = stem + ending;
        for (int i = 2; fs::exists(temporary_images / name); i++)
            name = stem + "_" + std::to_string(i) + ending;
        return name;
    }

    static void checkSize(const cv::Mat& image, const PinholeCamera& camera, const char* what) {
        if (image.cols != camera.width || image.rows != camera.height)
            throw std::runtime_error(std::string(what) + " is " + std::to_string(image.cols) + "x" +
                                     std::to_string(image.rows) + ", but the camera is " +
                                     std::to_string(camera.width) + "x" + std::to_string(camera.height));
    }

    void write(double timestamp, const cv::Mat& depth_u16, const std::string& image_name) {
        mrpt::obs::CObservation3DRangeScan scan;
        scan.timestamp = toMrptTime(timestamp);
        scan.sensorLabel = options.sensor_label;
        // The sensor sits on the robot's origin, x forward; the default relativePoseIntensityWRTDepth is the
        // turn to optical axes.
        scan.range_is_depth = true;
        scan.rangeUnits = options.range_units;
        scan.maxRange = 65535.f * options.range_units;
        scan.cameraParams = mrpt_camera;
        scan.cameraParamsIntensity = mrpt_camera;
        if (options.depth_camera) {
            scan.cameraParams = toMrptCamera(options.depth_camera->camera, options.sensor_label + "_depth");
            scan.relativePoseIntensityWRTDepth = relativePoseOfColour(options.depth_camera->T_depth_colour);
        }
        scan.hasRangeImage = true;
        scan.rangeImage_setSize(depth_u16.rows, depth_u16.cols);
        const size_t row_bytes = static_cast<size_t>(depth_u16.cols) * sizeof(std::uint16_t);
        for (int v = 0; v < depth_u16.rows; v++)
            std::memcpy(&scan.rangeImage(v, 0), depth_u16.ptr(v), row_bytes);
        scan.hasIntensityImage = true;
        scan.intensityImageChannel = mrpt::obs::CObservation3DRangeScan::CH_VISIBLE;
        scan.intensityImage.setExternalStorage(image_name);
        if (options.externalize_depth) externalizeDepth(scan, nextName(timestamp, "_RANGES.bin"));
        append(scan);
    }

    void externalizeDepth(mrpt::obs::CObservation3DRangeScan& scan, const std::string& name) const {
        const std::size_t values = static_cast<std::size_t>(scan.rangeImage.rows()) *
                                   static_cast<std::size_t>(scan.rangeImage.cols());
        bool whole = true;
        try {
            scan.rangeImage_convertToExternalStorage(name, (temporary_images / "").string());
        } catch (const std::exception&) {
            whole = false;  // MRPT's own words go over several lines
        }
        const std::size_t head = 2 * sizeof(std::uint32_t);  // rows, columns
        if (!whole || gzTrailerLength(temporary_images / name) != head + sizeof(std::uint16_t) * values)
            throw std::runtime_error("cannot write " + (images / name).string() + ": disk full?");
    }

    void append(const mrpt::serialization::CSerializable& object) {
        if (!stream.write(object)) throw std::runtime_error("cannot write " + path.string() + ": disk full?");
    }

    void checkDepth(const cv::Mat& depth_u16) const {
        if (depth_u16.type() != CV_16UC1)
            throw std::runtime_error("depth image must be 16-bit with one channel");
        checkSize(depth_u16, options.depth_camera ? options.depth_camera->camera : camera, "depth image");
    }
};

std::string RawlogWriter::imagesDirectory(const std::string& rawlog_path) {
    const fs::path path(rawlog_path);
    return (path.parent_path() / (path.stem().string() + "_Images")).string();
}

std::string RawlogWriter::groundTruthFile(const std::string& rawlog_path) {
    const fs::path path(rawlog_path);
    return (path.parent_path() / (path.stem().string() + "_groundtruth.txt")).string();
}

RawlogWriter::RawlogWriter(const std::string& path, const PinholeCamera& camera,
                           const RawlogWriterOptions& options)
    : impl_(std::make_unique<Impl>()) {
    if (const std::string fault = camera.check(); !fault.empty())
        throw std::runtime_error("cannot write a rawlog: " + fault);
    if (options.depth_camera)
        if (const std::string fault = options.depth_camera->camera.check(); !fault.empty())
            throw std::runtime_error("cannot write a rawlog: depth camera: " + fault);
    if (!(options.range_units > 0)) throw std::runtime_error("range_units must be above 0 m");
    Impl& m = *impl_;
    m.path = path;
    m.images = imagesDirectory(path);
    m.temporary = path + ".part";
    m.temporary_path = m.temporary / m.path.filename();
    m.temporary_images = m.temporary / m.images.filename();
    m.camera = camera;
    m.options = options;
    m.mrpt_camera = toMrptCamera(camera, options.sensor_label);

    requireReplaceable(m.path);
    if (fs::exists(m.images) && !fs::exists(m.path))
        throw std::runtime_error(m.images.string() +
                                 " exists, but its rawlog does not: move it away or choose another output");
    std::error_code error;
    fs::remove_all(m.temporary, error);  // of a run that was killed
    fs::create_directory(m.temporary, error);
    if (!error) fs::create_directory(m.temporary_images, error);
    if (error) throw std::runtime_error("cannot write " + m.path.string() + ": " + error.message());
    if (!m.stream.open(m.temporary_path, options.gz_level)) {
        fs::remove_all(m.temporary, error);
        throw std::runtime_error("cannot write " + m.path.string());
    }
}

RawlogWriter::~RawlogWriter() {
    if (!impl_->finished) impl_->removeTemporaries();
}

void RawlogWriter::add(double timestamp, const cv::Mat& depth_u16, const cv::Mat& colour_or_grey) {
    Impl& m = *impl_;
    m.checkDepth(depth_u16);
    if (colour_or_grey.type() != CV_8UC3 && colour_or_grey.type() != CV_8UC1)
        throw std::runtime_error("image must be 8-bit grey or BGR");
    m.checkSize(colour_or_grey, m.camera, "image");
    const int quality = m.options.jpeg_quality;
    const std::string name = m.nextName(timestamp, quality > 0 ? ".jpg" : ".png");
    const std::string file = (m.temporary_images / name).string();
    const std::vector<int> parameters =
        quality > 0 ? std::vector<int>{cv::IMWRITE_JPEG_QUALITY, quality} : std::vector<int>{};
    writeImageFile(file, colour_or_grey, parameters);
    m.write(timestamp, depth_u16, name);
}

void RawlogWriter::addFile(double timestamp, const cv::Mat& depth_u16, const std::string& image_file) {
    Impl& m = *impl_;
    m.checkDepth(depth_u16);
    requireImage(image_file);
    const std::string name = m.nextName(timestamp, fs::path(image_file).extension().string());
    linkOrCopyFile(image_file, (m.temporary_images / name).string());
    m.write(timestamp, depth_u16, name);
}

void RawlogWriter::add(const mrpt::serialization::CSerializable& object) {
    impl_->append(object);
}

std::string RawlogWriter::addImageFile(const std::string& image_file) {
    const fs::path file = image_file;
    requireImage(image_file);
    const std::string name = impl_->unusedName(file.stem().string(), file.extension().string());
    linkOrCopyFile(image_file, (impl_->temporary_images / name).string());
    return name;
}

void RawlogWriter::addImu(double timestamp, const Eigen::Vector3d& acceleration,
                          const std::optional<Eigen::Vector3d>& angular_velocity) {
    mrpt::obs::CObservationIMU imu;
    imu.timestamp = toMrptTime(timestamp);
    imu.sensorLabel = impl_->options.imu_label;
    imu.set(mrpt::obs::IMU_X_ACC, acceleration.x());
    imu.set(mrpt::obs::IMU_Y_ACC, acceleration.y());
    imu.set(mrpt::obs::IMU_Z_ACC, acceleration.z());
    if (angular_velocity) {
        imu.set(mrpt::obs::IMU_WX, angular_velocity->x());
        imu.set(mrpt::obs::IMU_WY, angular_velocity->y());
        imu.set(mrpt::obs::IMU_WZ, angular_velocity->z());
    }
    impl_->append(imu);
}

std::string RawlogWriter::temporaryPath() const {
    return impl_->temporary_path.string();
}

void RawlogWriter::close() {
    Impl& m = *impl_;
    if (m.closed) return;
    m.closed = true;
    if (!m.stream.close()) throw std::runtime_error("cannot write " + m.path.string() + ": disk full?");
}

void RawlogWriter::finish() {
    Impl& m = *impl_;
    if (m.finished) return;
    close();
    // Images first: a rawlog under its final name always has them.
    if (fs::exists(m.images)) fs::rename(m.images, m.temporary / "replaced_images");
    fs::rename(m.temporary_images, m.images);
    fs::rename(m.temporary_path, m.path);
    m.finished = true;
    std::error_code ignored;
    fs::remove_all(m.temporary, ignored);
}

}  // namespace roevo
