#include <algorithm>
#include <ctime>
#include <opencv2/core/utility.hpp>
#include <opencv2/imgproc.hpp>

#include "efficiency.h"
#include "registration_steps.h"
#include "roevo-compare/methods/distance_field.h"
#include "roevo/camera/undistorter.h"
#include "roevo/edges/organize.h"
#include "roevo/odometry.h"
#include "roevo/odometry_stages.h"

namespace roevo {
namespace {

/// Processor time of this thread, ms: other programs and the mapping thread do not count.
double processorTime() {
    timespec now{};
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
    return 1e3 * static_cast<double>(now.tv_sec) + 1e-6 * static_cast<double>(now.tv_nsec);
}

/// Milliseconds of the processor that `work` takes.
template <class Work>
double timed(Work&& work) {
    const double start = processorTime();
    work();
    return processorTime() - start;
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
            const double high = std::max(options_.min_high_threshold,
                                         options_.canny_high_factor * otsuThreshold(gradient_.magnitude));
            canny(gradient_, options_.canny_low_ratio * high, high, mask_);
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

/// Both odometries; their registrations are timed by the same clock around the same call.
class Contest {
  public:
    /// @param count_steps  of the registrations, which takes time
    Contest(const StudyInput& input, bool count_steps)
        : options_(input.options.fine),
          fine_(input.options.fine, input.options.edges, input.options.sensor),
          alike_(alikeOptions(options_), input.options.edges, input.options.sensor),
          field_(options_, 0),
          alike_field_(alikeOptions(options_), 0),
          fine_steps_(options_,
                      [&](const FineOptions& options) {
                          return FineTracker(options, input.options.edges, input.options.sensor);
                      }),
          field_steps_(options_, [](const FineOptions& options) { return DistanceFieldTracker(options, 0); }),
          count_steps_(count_steps),
          ours_(input.camera, optionsFor(input, Mode::kBundleAdjustment), Pose::Identity(), ourStages()),
          theirs_(input.camera, optionsFor(input, Mode::kTracking), Pose::Identity(), fieldStages()),
          features_(input.camera, input.options.edges) {}
    Contest(const Contest&) = delete;  // the odometries point to the trackers

    /// @return whether both tracked the frame
    bool process(const RgbdFrame& frame, bool ours_first, FrameTimes& times, FrameWork& work) {
        bool both = true;
        work_ = FrameWork();
        for (const bool ours : {ours_first, !ours_first}) {
            registration_ = besides_ = 0;
            FrameResult result;
            const double whole = timed([&] { result = (ours ? ours_ : theirs_).processFrame(frame); });
            both = both && result.status == FrameStatus::kOk;
            if (ours) {
                if (result.ms.mapping > 0) mapping.push_back(result.ms.mapping);
                times[kCoarse] = result.ms.coarse;
                times[kRegistration] = registration_;
                times[kWhole] = whole - besides_;
                times[kAlike] = alike_ms_[0];
                times[kAlikeField] = alike_ms_[1];
                // Waits for the map, so that it is not at work while others are timed
                if (result.new_keyframe) ours_.trajectory();
            } else {
                times[kCoarseField] = result.ms.coarse;
                times[kRegistrationField] = registration_;
            }
        }
        work = work_;
        if (both) features_.measure(frame.grey, times);
        return both;
    }

    std::vector<double> mapping;  ///< ms, of every keyframe whose map took effect

  private:
    OdometryStages ourStages() {
        OdometryStages stages;
        stages.clock = processorTime;
        stages.registration = [this](const Keyframe& keyframe, const FineFrame& frame, const Pose& T_start,
                                     const PosePrior& prior, const RollingShutter& shutter,
                                     const Brightness& brightness) {
            const auto track = [&](auto& tracker) {
                return tracker.track(keyframe, frame, T_start, prior, shutter, brightness);
            };
            FineResult result;
            registration_ = timed([&] { result = track(fine_); });
            besides_ = timed([&] {
                work_.ours.points = lookedUpPoints(keyframe, options_);
                if (count_steps_) work_.ours.steps = fine_steps_.count(result, track);
                alike_field_.prepare(frame);
                bool converged = true;
                alike_ms_[0] = timed([&] { converged = track(alike_).converged; });
                alike_ms_[1] = timed([&] { converged = track(alike_field_).converged && converged; });
                if (converged) work_.alike = {work_.ours.points, kFixedSteps};
            });
            return result;
        };
        return stages;
    }
    OdometryStages fieldStages() {
        OdometryStages stages;
        stages.clock = processorTime;
        stages.registration = [this](const Keyframe& keyframe, const FineFrame& frame, const Pose& T_start,
                                     const PosePrior& prior, const RollingShutter& shutter,
                                     const Brightness& brightness) {
            const auto track = [&](DistanceFieldTracker& tracker) {
                return tracker.track(keyframe, frame, T_start, prior, shutter, brightness);
            };
            field_.prepare(frame);  // building the field is timed apart
            FineResult result;
            registration_ = timed([&] { result = track(field_); });
            work_.field.points = lookedUpPoints(keyframe, options_);
            if (count_steps_) work_.field.steps = field_steps_.count(result, track);
            return result;
        };
        return stages;
    }

    FineOptions options_;
    FineTracker fine_, alike_;
    DistanceFieldTracker field_, alike_field_;
    StepCounter<FineTracker> fine_steps_;
    StepCounter<DistanceFieldTracker> field_steps_;
    bool count_steps_;
    Odometry ours_, theirs_;
    FeatureProcessing features_;
    FrameWork work_;
    // Of the frame at work, ms; besides: what our odometry would not have done
    double registration_ = 0, besides_ = 0;
    std::array<double, 2> alike_ms_{};
};

Measured measureOnce(const StudyInput& input, bool first_pass, bool ours_first, Progress& progress,
                     std::size_t& done) {
    Measured measured;
    measured.name = input.name;
    Contest contest(input, first_pass);
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
    Measured least = measureOnce(input, true, true, progress, done);
    const auto take = [](double& a, double b) { a = std::min(a, b); };
    for (int pass = 1; pass < kEfficiencyPasses; ++pass) {
        const Measured again = measureOnce(input, false, pass % 2 == 0, progress, done);
        for (std::size_t i = 0; i < std::min(least.frames.size(), again.frames.size()); ++i)
            for (std::size_t k = 0; k < kOperations; ++k) take(least.frames[i][k], again.frames[i][k]);
        for (std::size_t i = 0; i < std::min(least.mapping.size(), again.mapping.size()); ++i)
            take(least.mapping[i], again.mapping[i]);
    }
    return least;
}

}  // namespace roevo
