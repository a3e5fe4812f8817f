#include "recordings/frame_source.h"

#include <mrpt/obs/CObservation3DRangeScan.h>

#include <chrono>
#include <filesystem>
#include <stdexcept>
#include <vector>

#include "input/excerpt.h"
#include "programs/program.h"
#include "programs/text.h"
#include "recordings/bags/message_store.h"
#include "recordings/dataset_reader.h"
#include "recordings/depth_scale.h"
#include "recordings/facts.h"
#include "recordings/masked.h"
#include "recordings/sensor_files.h"
#include "recordings/time_units.h"
#include "roevo_mrpt/observation_converter.h"
#include "roevo_mrpt/rawlog_reader.h"
#include "roevo_mrpt/rawlog_writer.h"
#include "roevo_mrpt/time_conversions.h"

namespace roevo {
namespace {

namespace fs = std::filesystem;

// Runs decode() into frame, with its time and with what it throws as the frame's fault.
template <class Decode>
void decodeInto(SourceFrame& frame, const Decode& decode) {
    const auto start = std::chrono::steady_clock::now();
    try {
        frame.frame = decode();
        frame.fault.clear();
    } catch (const std::exception& e) {
        if (isOutOfMemory(e)) throw;  // no fault of the frame
        frame.frame = RgbdFrame();
        frame.fault = firstLine(e.what());
    }
    frame.ms_decode =
        std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
}

class DatasetSource : public FrameSource {
  public:
    DatasetSource(const std::string& path, const InputChoice& choice) : reader_(open(path, choice)) {}

    bool next(SourceFrame& frame) override {
        if (index_ >= reader_.size()) return false;
        const std::size_t i = index_++;
        frame.timestamp = reader_.entry(i).timestamp;
        frame.progress = static_cast<double>(index_) / static_cast<double>(reader_.size());
        decodeInto(frame, [&] { return reader_.readFrame(i); });
        return true;
    }
    bool skip() override { return index_ < reader_.size() && ++index_; }
    bool isAtEnd() const override { return index_ >= reader_.size(); }

    const PinholeCamera& camera() const override { return reader_.camera(); }
    std::string kind() const override { return reader_.description().format; }
    std::string cameraSource() const override { return reader_.description().camera_source; }
    GroundTruth groundTruth() const override { return reader_.groundTruth(); }
    std::vector<std::string> notes() const override {
        std::vector<std::string> notes = reader_.notes();
        notes.insert(notes.begin(), reader_.description().association.toText());
        return notes;
    }
    std::size_t size() const override { return reader_.size(); }
    std::string warning() const override { return reader_.warning(); }

  private:
    static DatasetReader open(const std::string& path, const InputChoice& choice) {
        DatasetOptions options;
        options.tolerate_missing = true;  // such frames are rejected with the reason, the others tracked
        options.topics = choice.topics;
        options.folder = choice.folder;
        options.ground_truth = choice.ground_truth;
        return openDataset(path, options);
    }

    DatasetReader reader_;
    std::size_t index_ = 0;
};

class RawlogSource : public FrameSource {
  public:
    RawlogSource(const std::string& path, const std::string& sensor_label, GroundTruth truth)
        : reader_(path, sensor_label), scan_(reader_.next()), truth_(std::move(truth)) {
        // next() throws by itself when there is no scan at all.
        if (!scan_) return;
        startWithImage(path);
        camera_ = colourCameraOf(*scan_);
        following_ = reader_.next();
        noteFacts();
        if (const std::string truth = truth_.toText(); !truth.empty()) notes_.push_back(truth);
    }

    bool next(SourceFrame& frame) override {
        if (!scan_) return false;
        frame.timestamp = fromMrptTime(scan_->timestamp);
        decodeInto(frame, [&] {
            RgbdFrame decoded = toRgbdFrame(*scan_);
            if (!colourCameraOf(*scan_).seesAs(camera_))
                throw std::runtime_error(
                    "the camera is not the one of the first frame (size or intrinsics changed)");
            return decoded;
        });
        frame.mounted = frame.fault.empty() && isMountedOnRobot(*scan_);
        frame.camera_on_robot.reset();
        if (frame.fault.empty()) frame.camera_on_robot = cameraOnRobot(*scan_);
        if (frame.camera_on_robot) noteMount(*frame.camera_on_robot);
        const auto start = std::chrono::steady_clock::now();
        advance();  // reading from the file belongs to decoding, too
        frame.ms_decode +=
            std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
        frame.progress = reader_.progress();
        return true;
    }
    bool skip() override {
        if (!scan_) return false;
        advance();
        return true;
    }
    bool isAtEnd() const override { return !scan_; }

    const PinholeCamera& camera() const override { return camera_; }
    std::string kind() const override { return "rawlog"; }
    std::string cameraSource() const override {
        return "the rawlog's observations, sensor '" + excerpt(reader_.report().label) + "'";
    }
    GroundTruth groundTruth() const override { return truth_; }
    std::vector<std::string> notes() const override { return notes_; }
    std::size_t size() const override { return 0; }
    std::string warning() const override {
        const std::string of_file = reader_.report().warning();
        if (back_and_forth_ < kSurely) return of_file;
        return (of_file.empty() ? "" : of_file + "; ") + "two cameras seem to share the label '" +
               excerpt(reader_.report().label) + "': its place on the robot goes back and forth";
    }

  private:
    static constexpr int kSurely = 5;

    /// Two cameras under one label take turns.
    void noteMount(const Pose& mount) {
        const bool moved = !mount.isApprox(mounts_[0], 1e-3);
        if (moved && mount.isApprox(mounts_[1], 1e-9)) ++back_and_forth_;
        mounts_[1] = mounts_[0];
        mounts_[0] = mount;
    }
    void advance() {
        scan_ = std::move(following_);
        following_ = scan_ ? reader_.next() : nullptr;
    }

    /// Passes over scans that have neither image nor camera of one.
    void startWithImage(const std::string& path) {
        std::size_t without = 0;
        const auto hasNone = [&] {
            return !scan_->hasIntensityImage && scan_->cameraParamsIntensity.fx() == 0;
        };
        for (; scan_ && hasNone(); ++without) scan_ = reader_.next();
        if (!scan_) {
            const auto& classes = reader_.report().classes;
            const auto images = classes.find("mrpt::obs::CObservationImage");
            throw std::runtime_error(
                path + ": none of its " + counted(without, "scan") + " has a colour image" +
                (images == classes.end() ? ""
                                         : "; its " + counted(images->second, "CObservationImage") +
                                               " are not paired with them") +
                "; rosbag2rawlog writes such, bag2rawlog does not");
        }
        if (without > 0)
            notes_.push_back("without a colour image: the first " + counted(without, "scan") + ", left out");
    }

    /// Of the first frame, if that can be read.
    void noteFacts() {
        try {
            const RgbdFrame frame = toRgbdFrame(*scan_);
            const cv::Size depth(static_cast<int>(scan_->rangeImage.cols()),
                                 static_cast<int>(scan_->rangeImage.rows()));
            const double step =
                following_ ? fromMrptTime(following_->timestamp) - fromMrptTime(scan_->timestamp) : 0;
            notes_.push_back(factsText(0, camera_, depth, step, medianDepth(frame.depth)));
        } catch (const std::exception& e) {
            if (isOutOfMemory(e)) throw;  // what is wrong with it is said when its turn comes
        }
    }

    RawlogReader reader_;
    std::shared_ptr<mrpt::obs::CObservation3DRangeScan> scan_, following_;
    GroundTruth truth_;
    PinholeCamera camera_;
    std::vector<std::string> notes_;
    Pose mounts_[2];  ///< the last ones
    int back_and_forth_ = 0;
};

std::unique_ptr<FrameSource> openUnmasked(const std::string& input, const InputChoice& choice) {
    std::error_code fault;
    const fs::file_status status = fs::status(input, fault);
    if (status.type() == fs::file_type::not_found)
        throw std::runtime_error("cannot read " + input + ": there is no such file or folder");
    if (fault) throw std::runtime_error("cannot read " + input + ": " + fault.message());
    const bool is_dataset = fs::is_directory(status) || isBag(input);
    if (is_dataset && !choice.sensor_label.empty())
        throw UsageError("--sensor-label is for rawlogs, and " + input + " is a " +
                         (isBag(input) ? "bag" : "folder"));
    if (is_dataset) return std::make_unique<DatasetSource>(input, choice);
    if (choice.topics.any()) throw UsageError("topics are for bags, and " + input + " is none");
    if (const auto given = choice.folder.options(); !given.empty())
        throw UsageError(given[0].first + " is for folders, and " + input + " is none");
    GroundTruth truth = choice.ground_truth.empty() ? readGroundTruth(RawlogWriter::groundTruthFile(input))
                                                    : readNamedGroundTruth(choice.ground_truth);
    toSeconds(truth);
    try {
        return std::make_unique<RawlogSource>(input, choice.sensor_label, std::move(truth));
    } catch (const std::runtime_error& e) {
        if (fs::path(input).extension() == ".rawlog") throw;
        throw std::runtime_error(std::string(e.what()) +
                                 "; inputs are .rawlog files, ROS bags (.bag, .db3, .mcap) and folders");
    }
}

}  // namespace

std::unique_ptr<FrameSource> openSource(const std::string& input, const InputChoice& choice) {
    std::unique_ptr<FrameSource> source = openUnmasked(input, choice);
    return choice.mask.empty() ? std::move(source) : maskedFrames(std::move(source), choice.mask);
}

void skipFrames(FrameSource& source, std::size_t count, const std::string& input) {
    std::size_t left_out = 0;
    while (left_out < count && source.skip()) ++left_out;
    if (left_out < count || (count > 0 && source.isAtEnd()))
        throw std::runtime_error("--skip " + std::to_string(count) + ": " + input + " has only " +
                                 counted(left_out, "frame") + ", so that no frame is left");
}

std::string DepthScaleCheck::faultOf(const SourceFrame& frame) {
    if (done_ || !frame.fault.empty()) return {};
    done_ = true;
    return depthScaleFault(frame.frame);
}

}  // namespace roevo
