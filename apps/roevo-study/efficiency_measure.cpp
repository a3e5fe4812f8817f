#include <algorithm>
#include <opencv2/core/utility.hpp>
#include <opencv2/imgproc.hpp>

#include "camera/undistorter.h"
#include "edges/organize.h"
#include "efficiency.h"
#include "registration_steps.h"
#include "roevo-compare/methods/distance_field.h"
#include "roevo/odometry.h"
#include "stopwatch.h"
#include "tracking/tracker.h"

namespace roevo {
namespace {

/// Milliseconds of the processor that `work` takes: other programs and the mapping thread do not count.
template <class Work>
double timed(Work&& work) {
    const CpuStopwatch stopwatch;
    work();
    return stopwatch.milliseconds();
}

/// OpenCV's threads put away while this lives.
class OneThread {
  public:
    OneThread() { cv::setNumThreads(1); }
    ~OneThread() { cv::setNumThreads(before_); }
    OneThread(const OneThread&) = delete;

  private:
    int before_ = cv::getNumThreads();
};

/// Edges of one image, and a distance field of them.
class FeatureProcessing {
  public:
    FeatureProcessing(const PinholeCamera& camera, const EdgeOptions& options)
        : camera_(camera), options_(options), undistorter_(camera) {}

    void measure(const cv::Mat& grey, FrameTimes& times) {
        const cv::Mat& image = undistorter_.apply(grey, undistorted_);
        times[kDetect] = timed([&] {
            computeGradient(image, options_.blur_sigma, gradient_);
            canny(gradient_, cannyThresholds(gradient_, options_), mask_);
        });
        times[kField] = timed([&] { field_.build(mask_.mask); });
        times[kField5x5] = timed([&] {
            cv::compare(mask_.mask, 0, background_, cv::CMP_EQ);
            cv::distanceTransform(background_, approximate_, cv::DIST_L2, cv::DIST_MASK_5, CV_32F);
        });
        times[kOrganize] = timed([&] {  // last: it changes the mask
            adjustAdjacency(mask_);
            organizer_.organize(gradient_, mask_, options_.angle_deg, options_.min_length, edges_);
            computeNormals(edges_, options_.tangent_span);
            grid_.build(edges_, camera_.width, camera_.height);
        });
    }

  private:
    PinholeCamera camera_;
    EdgeOptions options_;
    Undistorter undistorter_;
    cv::Mat undistorted_, background_, approximate_;
    Gradient gradient_;
    EdgeMask mask_;
    EdgeOrganizer organizer_;
    OrganizedEdges edges_;
    EdgeGrid grid_;
    DistanceField field_;
};

OdometryOptions optionsFor(const StudyInput& input, Mode mode) {
    OdometryOptions options = input.options;
    options.mode = mode;
    options.mapping.semi_dense_points = 0;  // sampled beside tracking, and neither method needs it
    options.mapping.deterministic = true;
    return options;
}

FineOptions alikeOptions(FineOptions options) {
    options.max_iterations = kFixedSteps;
    options.photometric_weight = options.depth_weight = 0;
    return options;
}

OdometryOptions withFine(OdometryOptions options, const FineOptions& fine) {
    options.fine = fine;
    return options;
}

/// Times of one frame, ms of processor time; besides: what the odometry itself would not have done.
struct StepTimes {
    double coarse = 0, registration = 0, besides = 0, alike = 0, alike_field = 0;
};

/// Times both steps of a tracker by the same clock around the same calls.
class TimedTracker : public Tracker {
  public:
    using Tracker::Tracker;

    void reset() { times_ = StepTimes(); }
    const StepTimes& times() const { return times_; }
    FrameWork& work() { return work_; }

  protected:
    CoarseResult align(const Keyframe& reference, const Frame& frame, const RollingShutter& shutter,
                       const std::vector<Pose>& guesses, const Brightness& brightness) override {
        CoarseResult result;
        times_.coarse +=
            timed([&] { result = Tracker::align(reference, frame, shutter, guesses, brightness); });
        return result;
    }

    StepTimes times_;
    FrameWork work_;
};

/// ROEVO's fine tracking, and beside it that and the field with all that differs switched off.
class OursTimed : public TimedTracker {
  public:
    OursTimed(const StudyInput& input, const OdometryOptions& options)
        : TimedTracker(input.camera, options),
          fine_(input.camera, options_),
          alike_(input.camera, withFine(options_, alikeOptions(options_.fine))),
          alike_field_(input.camera, alikeOptions(options_.fine), 0) {}

  protected:
    FineResult refine(const Keyframe& reference, const Frame& frame, const Pose& T_start,
                      const PosePrior& prior, const RollingShutter& shutter,
                      const Brightness& brightness) override {
        const auto track = [&](auto& tracker) {
            return tracker.track(reference, frame, T_start, prior, shutter, brightness);
        };
        FineResult result;
        times_.registration = timed([&] { result = track(fine_); });
        times_.besides = timed([&] {
            work_.ours = {lookedUpPoints(reference, options_.fine), result.iterations};
            alike_field_.prepare(frame);
            bool converged = true;
            times_.alike = timed([&] { converged = track(alike_).converged; });
            times_.alike_field = timed([&] { converged = track(alike_field_).converged && converged; });
            if (converged) work_.alike = {work_.ours.points, kFixedSteps};
        });
        return result;
    }

  private:
    FineTracker fine_, alike_;
    DistanceFieldTracker alike_field_;
};

class FieldTimed : public TimedTracker {
  public:
    FieldTimed(const StudyInput& input, const OdometryOptions& options)
        : TimedTracker(input.camera, options), field_(input.camera, options_.fine, 0) {}

  protected:
    FineResult refine(const Keyframe& reference, const Frame& frame, const Pose& T_start,
                      const PosePrior& prior, const RollingShutter& shutter,
                      const Brightness& brightness) override {
        field_.prepare(frame);  // building the field is timed apart
        FineResult result;
        times_.registration =
            timed([&] { result = field_.track(reference, frame, T_start, prior, shutter, brightness); });
        work_.field = {lookedUpPoints(reference, options_.fine), result.iterations};
        return result;
    }

  private:
    DistanceFieldTracker field_;
};

/// An odometry and the tracker in it.
template <class Timed>
struct Contestant {
    Contestant(const StudyInput& input, Mode mode)
        : Contestant(input, optionsFor(input, mode),
                     std::make_unique<Timed>(input, optionsFor(input, mode))) {}
    Contestant(const StudyInput& input, const OdometryOptions& options, std::unique_ptr<Timed> own)
        : tracker(*own), odometry(input.camera, options, Pose::Identity(), std::move(own)) {}

    Timed& tracker;  // the odometry's
    Odometry odometry;
};

/// Both odometries.
class Contest {
  public:
    explicit Contest(const StudyInput& input)
        : ours_(input, Mode::kBundleAdjustment),
          theirs_(input, Mode::kTracking),
          features_(input.camera, input.options.edges) {}

    /// @return whether both tracked the frame
    bool process(const RgbdFrame& frame, bool ours_first, FrameTimes& times, FrameWork& work) {
        bool both = true;
        ours_.tracker.work() = theirs_.tracker.work() = FrameWork();
        for (const bool ours : {ours_first, !ours_first}) {
            TimedTracker& tracker = ours ? static_cast<TimedTracker&>(ours_.tracker) : theirs_.tracker;
            tracker.reset();
            FrameResult result;
            const double whole =
                timed([&] { result = (ours ? ours_.odometry : theirs_.odometry).processFrame(frame); });
            both = both && result.status == FrameStatus::kOk;
            const StepTimes& steps = tracker.times();
            if (ours) {
                if (result.ms.mapping > 0) mapping.push_back(result.ms.mapping);
                times[kCoarse] = steps.coarse;
                times[kRegistration] = steps.registration;
                times[kWhole] = whole - steps.besides;
                times[kAlike] = steps.alike;
                times[kAlikeField] = steps.alike_field;
                // Waits for the map, so that it is not at work while others are timed
                if (result.new_keyframe) ours_.odometry.trajectory();
            } else {
                times[kCoarseField] = steps.coarse;
                times[kRegistrationField] = steps.registration;
            }
        }
        work = ours_.tracker.work();
        work.field = theirs_.tracker.work().field;
        if (both) features_.measure(frame.grey, times);
        return both;
    }

    std::vector<double> mapping;  ///< ms, of every keyframe whose map took effect

  private:
    Contestant<OursTimed> ours_;
    Contestant<FieldTimed> theirs_;
    FeatureProcessing features_;
};

Measured measureOnce(const StudyInput& input, bool ours_first, Progress& progress, std::size_t& done) {
    Measured measured;
    measured.name = input.name;
    Contest contest(input);
    const auto source = input.open();
    for (SourceFrame frame; source->next(frame);) {
        progress.update(++done);
        if (!frame.fault.empty()) continue;
        FrameTimes times{};
        FrameWork work;
        if (contest.process(frame.frame, ours_first, times, work)) {
            measured.frames.push_back(times);
            measured.work.push_back(work);
        }
        ours_first = !ours_first;
        ++measured.all_frames;
    }
    measured.mapping = contest.mapping;
    return measured;
}

}  // namespace

Measured measureEfficiency(const StudyInput& input, Progress& progress, std::size_t& done) {
    const OneThread one_thread;
    Measured least = measureOnce(input, true, progress, done);
    const auto take = [](double& a, double b) { a = std::min(a, b); };
    for (int pass = 1; pass < kEfficiencyPasses; ++pass) {
        const Measured again = measureOnce(input, pass % 2 == 0, progress, done);
        for (std::size_t i = 0; i < std::min(least.frames.size(), again.frames.size()); ++i)
            for (std::size_t k = 0; k < kOperations; ++k) take(least.frames[i][k], again.frames[i][k]);
        for (std::size_t i = 0; i < std::min(least.mapping.size(), again.mapping.size()); ++i)
            take(least.mapping[i], again.mapping[i]);
    }
    return least;
}

}  // namespace roevo
