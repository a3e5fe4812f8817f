#include "rawlog2rgbd/export.h"

#include <mrpt/obs/CObservation3DRangeScan.h>

#include <chrono>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <optional>
#include <set>
#include <stdexcept>

#include "programs/ahead.h"
#include "programs/interrupt.h"
#include "programs/progress.h"
#include "programs/text.h"
#include "rawlog2rgbd/scan_reader.h"
#include "rawlog2rgbd/tum_writer.h"
#include "recordings/depth_times.h"
#include "roevo_mrpt/image_conversions.h"
#include "roevo_mrpt/observation_converter.h"
#include "roevo_mrpt/rawlog_writer.h"
#include "roevo_mrpt/time_conversions.h"

namespace roevo {
namespace {

using mrpt::obs::CObservation3DRangeScan;

/// Metres as 16-bit units; what does not fit is unknown.
cv::Mat quantised(const cv::Mat& metres, double depth_scale) {
    cv::Mat units(metres.size(), CV_16UC1, cv::Scalar(0));
    for (int v = 0; v < metres.rows; v++)
        for (int u = 0; u < metres.cols; u++) {
            const double value = std::round(static_cast<double>(metres.at<float>(v, u)) * depth_scale);
            if (value > 0 && value <= 65535)
                units.at<std::uint16_t>(v, u) = static_cast<std::uint16_t>(value);
        }
    return units;
}

/// Takes the scans of one rawlog, one after the other.
class Exporter {
  public:
    Exporter(TumWriter& writer, const DepthTimes& depth_times) : writer_(writer), depth_times_(depth_times) {}

    void add(const DecodedScan& decoded) {
        for (const ImuSample& sample : decoded.imu)
            writer_.addImu(sample.timestamp, sample.acceleration, sample.angular_velocity);
        result_.imu_samples += decoded.imu.size();
        result_.decode_seconds += decoded.seconds;
        if (!decoded.scan) return;
        if (decoded.scan->timestamp == INVALID_TIMESTAMP) {  // as a number it is the year 1601
            const std::size_t number = result_.frames + result_.left_out.size() + 1;
            result_.left_out.push_back("frame " + std::to_string(number) + ": it has no time stamp");
            return;
        }
        const double timestamp = fromMrptTime(decoded.scan->timestamp);
        const std::string fault = decoded.fault.empty() ? write(decoded, timestamp) : decoded.fault;
        if (fault.empty()) return;
        result_.left_out.push_back("frame at " + stampText(timestamp) + " s: " + fault);
    }

    const TumCamera& camera() const { return camera_; }
    ExportResult& result() { return result_; }

  private:
    /// Why the frame cannot be written into this folder, or "".
    std::string write(const DecodedScan& decoded, double timestamp) {
        const CObservation3DRangeScan& scan = *decoded.scan;
        const RgbdFrame& frame = decoded.frame;
        if (stamps_.count(timestamp) > 0) return "its time stamp was there before";
        if (result_.frames == 0)
            describeCamera(scan);
        else if (!colourCameraOf(scan).seesAs(camera_.camera) || scan.rangeUnits != range_units_)
            return "its intrinsics, size or range units are not those of the first frame, and a folder has "
                   "one camera.txt";
        const auto& range = scan.rangeImage;
        const bool as_stored = depthIsAsStored(scan);
        const cv::Mat depth = as_stored
                                  ? cv::Mat(static_cast<int>(range.rows()), static_cast<int>(range.cols()),
                                            CV_16UC1, const_cast<std::uint16_t*>(&range(0, 0)))
                                  : quantised(frame.depth, camera_.depth_scale);
        const bool is_file = scan.intensityImage.isExternallyStored();
        writer_.add(timestamp, depth_times_.of(timestamp), depth,
                    frame.colour.empty() ? frame.grey : frame.colour,
                    is_file ? scan.intensityImage.getExternalStorageFileAbsolutePath() : "");
        stamps_.insert(timestamp);
        result_.frames++;
        if (is_file) result_.linked_images++;
        if (!as_stored) noteResampling(scan);
        return "";
    }

    void describeCamera(const CObservation3DRangeScan& scan) {
        camera_ = TumCamera();
        camera_.camera = colourCameraOf(scan);
        range_units_ = scan.rangeUnits;
        camera_.depth_scale = result_.depth_scale = depthScaleOf(range_units_);
        if (!isMountedOnRobot(scan)) return;
        const mrpt::poses::CPose3D& pose = scan.sensorPose;
        char note[256];
        std::snprintf(note, sizeof note,
                      "sensor_on_robot_x_y_z_yaw_pitch_roll_deg: %.9g %.9g %.9g %.9g %.9g %.9g", pose.x(),
                      pose.y(), pose.z(), mrpt::RAD2DEG(pose.yaw()), mrpt::RAD2DEG(pose.pitch()),
                      mrpt::RAD2DEG(pose.roll()));
        camera_.notes.emplace_back(note);
    }

    void noteResampling(const CObservation3DRangeScan& scan) {
        result_.resampled++;
        char precision[64];
        std::snprintf(precision, sizeof precision, ", rounded to 1/%g m", camera_.depth_scale);
        result_.depth_note = (scan.range_is_depth ? "depth registered to the colour camera"
                                                  : "ranges along the ray turned into depth") +
                             std::string(precision);
    }

    TumWriter& writer_;
    const DepthTimes& depth_times_;
    TumCamera camera_;
    float range_units_ = 0;
    std::set<double> stamps_;
    ExportResult result_;
};

}  // namespace

double depthScaleOf(float range_units) {
    const float exact = 1.f / range_units;
    const double rounded = std::round(1.0 / static_cast<double>(range_units));
    if (rounded >= 1 && depthUnit(rounded) == range_units) return rounded;
    // The reciprocal of a float is not always undone by another one, but by a neighbour
    for (const float scale : {exact, std::nextafter(exact, 0.f), std::nextafter(exact, INFINITY)})
        if (depthUnit(static_cast<double>(scale)) == range_units) return static_cast<double>(scale);
    return static_cast<double>(exact);
}

ExportResult exportRawlog(const std::string& rawlog, const std::string& sensor_label,
                          const std::string& folder) {
    const auto start = std::chrono::steady_clock::now();
    const InterruptGuard guard;
    ScanReader reader(rawlog, sensor_label);
    TumWriter writer(folder);
    const DepthTimes depth_times = readDepthTimes(rawlog);
    Exporter exporter(writer, depth_times);
    Progress progress("writing", 0);
    {
        Ahead<DecodedScan> scans([&] { return reader.next(); });
        while (const auto decoded = scans.next()) {
            InterruptGuard::check();
            exporter.add(*decoded);
            progress.update(exporter.result().frames, decoded->progress);
        }
    }
    progress.finish();

    ExportResult result = exporter.result();
    result.warning = reader.report().warning();
    if (result.frames == 0)
        throw std::runtime_error(rawlog + ": none of its " + std::to_string(result.left_out.size()) +
                                 " frames can be used, first: " + result.left_out.front());
    const std::string truth = RawlogWriter::groundTruthFile(rawlog);
    std::error_code unreadable;
    if (std::filesystem::is_regular_file(truth, unreadable)) result.ground_truth = truth;
    result.depth_times = depth_times.file;
    result.depth_times_fault = depth_times.fault;
    if (!depth_times.file.empty() && depth_times.fault.empty())
        if (const std::string fault = writer.ownDepthTimesFault(); !fault.empty())
            result.depth_times_fault = depth_times.file + ": " + fault;
    writer.finish(exporter.camera(), result.ground_truth,
                  !depth_times.file.empty() && result.depth_times_fault.empty());
    result.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    return result;
}

}  // namespace roevo
