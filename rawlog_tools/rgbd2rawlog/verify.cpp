#include "rgbd2rawlog/verify.h"

#include <mrpt/obs/CObservation3DRangeScan.h>
#include <mrpt/obs/CObservationIMU.h>

#include <algorithm>
#include <cstring>
#include <limits>
#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>
#include <stdexcept>

#include "programs/interrupt.h"
#include "programs/progress.h"
#include "roevo_mrpt/image_conversions.h"
#include "roevo_mrpt/observation_converter.h"
#include "roevo_mrpt/rawlog_reader.h"
#include "roevo_mrpt/time_conversions.h"

namespace roevo {
namespace {

using mrpt::obs::CObservation3DRangeScan;
using mrpt::obs::CObservationIMU;

bool sameBytes(const cv::Mat& a, const cv::Mat& b) {
    if (a.size() != b.size() || a.type() != b.type()) return false;
    const std::size_t row_bytes = static_cast<std::size_t>(a.cols) * a.elemSize();
    for (int v = 0; v < a.rows; v++)
        if (std::memcmp(a.ptr(v), b.ptr(v), row_bytes) != 0) return false;
    return true;
}

/// The image as the rawlog should give it back.
cv::Mat asStored(const cv::Mat& image, int jpeg_quality) {
    if (jpeg_quality == 0) return image;
    std::vector<std::uint8_t> bytes;
    cv::imencode(".jpg", image, bytes, {cv::IMWRITE_JPEG_QUALITY, jpeg_quality});
    return cv::imdecode(bytes, cv::IMREAD_ANYCOLOR);
}

std::string imuDifference(const CObservationIMU& stored, const ImuSample& sample) {
    using namespace mrpt::obs;
    const auto differs = [&](TIMUDataIndex index, double value) {
        return !stored.has(index) || stored.get(index) != value;
    };
    if (fromMrptTime(stored.timestamp) != roundToMicroseconds(sample.timestamp)) return "time stamp";
    const Eigen::Vector3d& a = sample.acceleration;
    if (differs(IMU_X_ACC, a.x()) || differs(IMU_Y_ACC, a.y()) || differs(IMU_Z_ACC, a.z()))
        return "acceleration";
    if (stored.has(IMU_WX) != sample.angular_velocity.has_value()) return "angular velocity";
    if (!sample.angular_velocity) return "";
    const Eigen::Vector3d& w = *sample.angular_velocity;
    return differs(IMU_WX, w.x()) || differs(IMU_WY, w.y()) || differs(IMU_WZ, w.z()) ? "angular velocity"
                                                                                      : "";
}

class Verifier {
  public:
    Verifier(const DatasetReader& dataset, const ConvertOptions& options, const ConvertResult& converted)
        : dataset_(dataset), options_(options), converted_(converted) {
        result_.lowest_psnr = options.jpeg_quality > 0 ? std::numeric_limits<double>::infinity() : 0;
    }

    void checkScan(const CObservation3DRangeScan& scan) {
        if (result_.frames == converted_.written.size()) fail("it holds more frames than written");
        const std::size_t i = converted_.written[result_.frames];
        if (const std::string what = difference(scan, i); !what.empty())
            fail("frame " + std::to_string(result_.frames) + " differs in " + what + " from " +
                 dataset_.entry(i).depth);
        checkOrder(fromMrptTime(scan.timestamp));
        result_.frames++;
        result_.depth_values += scan.rangeImage.size().at(0) * scan.rangeImage.size().at(1);
    }

    void checkOther(const mrpt::obs::CObservation& observation) {
        const auto* imu = dynamic_cast<const CObservationIMU*>(&observation);
        if (imu == nullptr) fail(std::string("it holds a ") + observation.GetRuntimeClass()->className);
        if (result_.imu_samples == converted_.imu.size()) fail("it holds more inertial samples than written");
        if (const std::string what = imuDifference(*imu, converted_.imu[result_.imu_samples]); !what.empty())
            fail("inertial sample " + std::to_string(result_.imu_samples) + " differs in " + what);
        checkOrder(fromMrptTime(imu->timestamp));
        result_.imu_samples++;
    }

    VerifyResult finish(const RawlogReport& report) const {
        if (!report.fault.empty()) fail(report.fault);
        if (result_.frames != converted_.written.size() || result_.imu_samples != converted_.imu.size())
            fail("it holds " + std::to_string(result_.frames) + " of " +
                 std::to_string(converted_.written.size()) + " frames and " +
                 std::to_string(result_.imu_samples) + " of " + std::to_string(converted_.imu.size()) +
                 " inertial samples");
        return result_;
    }

    std::size_t frames() const { return result_.frames; }

  private:
    [[noreturn]] static void fail(const std::string& what) {
        throw std::runtime_error("verification failed: " + what + "; nothing was written");
    }

    void checkOrder(double timestamp) {
        if (timestamp < last_timestamp_) fail("observations are not in the order of time");
        last_timestamp_ = timestamp;
    }

    /// What differs, or "".
    std::string difference(const CObservation3DRangeScan& scan, std::size_t i) {
        const RgbdFrame stored = toRgbdFrame(scan);
        if (stored.timestamp != dataset_.entry(i).timestamp) return "time stamp";
        if (colourCameraOf(scan) != dataset_.camera()) return "intrinsics";
        if (depthCameraOf(scan) != dataset_.depthCamera()) return "intrinsics of the depth camera";
        if (scan.rangeImage_isExternallyStored() != options_.externalize_depth) return "where its depth is";
        const cv::Mat raw = dataset_.readDepth(i);
        const auto& range = scan.rangeImage;
        if (range.rows() != raw.rows || range.cols() != raw.cols) return "depth image size";
        if (std::memcmp(&range(0, 0), raw.ptr(), raw.total() * raw.elemSize()) != 0) return "depth values";
        if (!sameBytes(stored.depth, dataset_.toFrameDepth(raw))) return "depth in metres";
        return imageDifference(stored, dataset_.readImage(i));
    }

    std::string imageDifference(const RgbdFrame& stored, const cv::Mat& original) {
        const cv::Mat expected = asStored(original, options_.jpeg_quality);
        if (!sameBytes(stored.grey, toGrey(expected))) return "grey image";
        if (expected.channels() == 3 && !sameBytes(stored.colour, expected)) return "colour image";
        if (options_.jpeg_quality > 0)
            result_.lowest_psnr = std::min(result_.lowest_psnr, cv::PSNR(expected, original));
        return "";
    }

    const DatasetReader& dataset_;
    const ConvertOptions& options_;
    const ConvertResult& converted_;
    VerifyResult result_;
    double last_timestamp_ = -std::numeric_limits<double>::infinity();
};

}  // namespace

VerifyResult verifyRawlog(const DatasetReader& dataset, const ConvertOptions& options,
                          const ConvertResult& converted, const std::string& rawlog) {
    RawlogReader reader(rawlog);
    Verifier verifier(dataset, options, converted);
    reader.onOther([&](const mrpt::obs::CObservation& observation) { verifier.checkOther(observation); });
    Progress progress("verifying", converted.written.size());
    while (const auto scan = reader.next()) {
        InterruptGuard::check();
        verifier.checkScan(*scan);
        progress.update(verifier.frames());
    }
    return verifier.finish(reader.report());
}

}  // namespace roevo
