#include "rgbd2rawlog/convert.h"

#include <chrono>
#include <limits>
#include <optional>
#include <stdexcept>

#include "programs/ahead.h"
#include "programs/interrupt.h"
#include "programs/progress.h"
#include "roevo_mrpt/rawlog_writer.h"

namespace roevo {
namespace {

using Clock = std::chrono::steady_clock;

double secondsSince(Clock::time_point start) {
    return std::chrono::duration<double>(Clock::now() - start).count();
}

/// Writes inertial samples in step with the frames.
class ImuTrack {
  public:
    ImuTrack(const DatasetReader& dataset, const FrameSelection& selection, ConvertResult& result)
        : samples_(dataset.imu()), result_(result) {
        const double first = dataset.entry(0).timestamp;
        for (; next_ < samples_.size() && !selection.contains(samples_[next_].timestamp, first); next_++) {
        }
        for (end_ = next_; end_ < samples_.size() && selection.contains(samples_[end_].timestamp, first);
             end_++) {
        }
    }

    /// Samples up to this time, or all that are left.
    void writeUntil(double timestamp, RawlogWriter& writer) {
        for (; next_ < end_ && samples_[next_].timestamp <= timestamp; next_++) {
            const ImuSample& sample = samples_[next_];
            writer.addImu(sample.timestamp, sample.acceleration, sample.angular_velocity);
            result_.imu.push_back(sample);
        }
    }

  private:
    const std::vector<ImuSample>& samples_;
    ConvertResult& result_;
    std::size_t next_ = 0, end_ = 0;
};

RawlogWriterOptions writerOptions(const DatasetReader& dataset, const ConvertOptions& options) {
    RawlogWriterOptions out;
    if (const std::string& label = dataset.description().sensor_label; !label.empty())
        out.sensor_label = label;
    out.range_units = dataset.depthUnit();
    out.externalize_depth = options.externalize_depth;
    out.jpeg_quality = options.jpeg_quality;
    if (const auto& registration = dataset.description().registration)
        out.depth_camera = {registration->depth_camera, registration->T_colour_depth.inverse()};
    return out;
}

/// A frame's images, or why there are none.
struct DecodedFrame {
    std::size_t index = 0;  ///< in the dataset
    cv::Mat depth, image;
    std::string fault;
    double seconds = 0;  ///< spent on decoding
};

DecodedFrame decode(const DatasetReader& dataset, std::size_t index) {
    const auto start = Clock::now();
    DecodedFrame frame;
    frame.index = index;
    try {
        frame.depth = dataset.readDepth(index);
        frame.image = dataset.readImage(index);
    } catch (const std::runtime_error& error) {
        frame.fault = error.what();
    }
    frame.seconds = secondsSince(start);
    return frame;
}

std::vector<std::size_t> selectFrom(const DatasetReader& dataset, const FrameSelection& selection) {
    std::vector<double> stamps;
    for (std::size_t i = 0; i < dataset.size(); i++) stamps.push_back(dataset.entry(i).timestamp);
    try {
        return selectFrames(stamps, selection);
    } catch (const std::runtime_error& error) {
        throw std::runtime_error(dataset.description().folder + ": " + error.what());
    }
}

}  // namespace

ConvertResult convertToRawlog(const DatasetReader& dataset, const std::string& rawlog,
                              const ConvertOptions& options,
                              const std::function<void(const ConvertResult&, const std::string&)>& check) {
    const auto selected = selectFrom(dataset, options.selection);
    const InterruptGuard guard;
    RawlogWriter writer(rawlog, dataset.camera(), writerOptions(dataset, options));
    ConvertResult result;
    ImuTrack imu(dataset, options.selection, result);
    Progress progress("writing", selected.size());
    const auto start = Clock::now();
    Ahead<DecodedFrame> frames([&, next = selected.begin()]() mutable -> std::optional<DecodedFrame> {
        if (next == selected.end()) return std::nullopt;
        return decode(dataset, *next++);
    });
    for (std::size_t done = 1; const auto frame = frames.next(); done++) {
        InterruptGuard::check();
        if (!frame->fault.empty()) {
            if (!options.skip_bad)
                throw std::runtime_error(frame->fault + " (--skip-bad leaves such frames out)");
            result.left_out.push_back(frame->fault);
            continue;
        }
        const DatasetEntry& entry = dataset.entry(frame->index);
        imu.writeUntil(entry.timestamp, writer);
        if (options.jpeg_quality > 0 || dataset.description().images)
            writer.add(entry.timestamp, frame->depth, frame->image);
        else
            writer.addFile(entry.timestamp, frame->depth, entry.image);
        result.decode_seconds += frame->seconds;
        result.written.push_back(frame->index);
        progress.update(done);
    }
    if (result.written.empty())
        throw std::runtime_error("no usable frame in " + dataset.description().folder + "; the first of " +
                                 std::to_string(result.left_out.size()) +
                                 " faults: " + result.left_out.front());
    imu.writeUntil(std::numeric_limits<double>::infinity(), writer);
    writer.close();
    result.seconds = secondsSince(start);
    progress.finish();
    check(result, writer.temporaryPath());
    InterruptGuard::check();
    writer.finish();
    return result;
}

}  // namespace roevo
