#include "families.h"

#ifdef ROEVO_HAVE_MRPT_VISION
#include <mrpt/vision/CDifodo.h>

#include <cmath>
#include <opencv2/core.hpp>

#include "depth_resampler.h"
#include "registration_method.h"
#include "roevo_mrpt/pose_conversions.h"
#include "stopwatch.h"
#include "tracking/se3.h"
#endif

namespace roevo {
namespace {

#ifdef ROEVO_HAVE_MRPT_VISION

/// Coarsest level of the pyramid, as in the authors' own programs.
constexpr unsigned kCoarsestColumns = 20;
/// Least share of the pixels with a depth, in one image and in two that overlap.
constexpr double kLeastKnown = 0.02;
/// Longer steps between two images are beyond range flow: in exact data it follows 0.15 m, not 0.2 m.
constexpr double kLongestStep = 0.3, kLargestTurn = 30 * kDegree;

/// CDifodo with its protected members made ready: the constructor leaves them for 60x80 pixels.
class RangeFlow : public mrpt::vision::CDifodo {
  public:
    explicit RangeFlow(const PinholeCamera& camera) {
        m_width = cols = static_cast<unsigned>(camera.width);
        m_height = rows = static_cast<unsigned>(camera.height);
        fovh = static_cast<float>(2 * std::atan(camera.width / 2.0 / camera.fx));
        fovv = static_cast<float>(2 * std::atan(camera.height / 2.0 / camera.fy));
        fast_pyramid = false;  // the fast one asserts on its own matrices
        ctf_levels = 1;
        for (unsigned width = cols; width > kCoarsestColumns; width /= 2) ++ctf_levels;
        for (auto* pyramid : {&depth, &depth_old, &depth_inter, &depth_warped, &xx, &xx_old, &xx_inter,
                              &xx_warped, &yy, &yy_old, &yy_inter, &yy_warped}) {
            pyramid->resize(ctf_levels);
            for (unsigned i = 0; i < ctf_levels; ++i) {
                (*pyramid)[i].resize(rows >> i, cols >> i);
                (*pyramid)[i].fill(0);
            }
        }
        transformations.resize(ctf_levels);
        for (auto& transformation : transformations) transformation.resize(4, 4);
        depth_wf.setSize(rows, cols);
    }

    /// The image in its axes: columns count to the left and rows up, as y and z of the sensor frame do.
    void load(const cv::Mat& depth) {
        for (unsigned v = 0; v < rows; ++v) {
            const auto* row = depth.ptr<float>(static_cast<int>(rows - 1 - v));
            for (unsigned u = 0; u < cols; ++u) depth_wf(v, u) = row[cols - 1 - u];
        }
    }
    void loadFrame() override {}

    /// Motion since the image before, as T_before_now of the sensor frames.
    mrpt::poses::CPose3D solve(double dt) {
        fps = 1 / dt;
        cam_pose = mrpt::poses::CPose3D();
        // A level with hardly any depth is not solved, and the filter would read what the last solution left.
        est_cov.setIdentity();
        kai_loc_level = mrpt::math::TTwist3D();
        odometryCalculation();
        return cam_pose;
    }

    /// Whether the finest level was solved, and had one solution.
    bool determined() const {
        return num_valid_points > kLeastKnown * rows * cols && est_cov.asEigen().allFinite();
    }
    void forgetVelocity() { kai_loc_old = mrpt::math::TTwist3D(); }
};

class Difodo : public RegistrationMethod {
  public:
    Difodo(const PinholeCamera& camera, const OdometryOptions& options, int width, int height)
        : RegistrationMethod(camera, options),
          ideal_(centredCamera(camera, width, height)),
          resampler_(camera, ideal_, options.sensor),
          flow_(ideal_) {}

    std::vector<std::string> stages() const override { return {"resample", "solve"}; }

  protected:
    Registration start(const RgbdFrame& frame) override {
        Registration first;
        if (!load(frame, first)) return first;
        const Stopwatch watch;
        flow_.solve(1.0 / 30);  // makes the pyramid; the motion from nothing to this image means nothing
        flow_.forgetVelocity();
        first.stage_ms[1] = watch.milliseconds();
        return first;
    }

    Registration registerFrame(const RgbdFrame& frame, const Expected& expected) override {
        Registration found;
        if (!load(frame, found)) return found;
        const Stopwatch watch;
        if (!expected.velocity_known) flow_.forgetVelocity();
        const mrpt::poses::CPose3D T_before_now = flow_.solve(expected.dt);
        found.stage_ms[1] = watch.milliseconds();
        const Pose step = sensorFromOptical().inverse() * toEigen(T_before_now) * sensorFromOptical();
        if (!flow_.determined() || !step.isFinite()) {
            found.reason = "the depth does not determine the motion";
            flow_.forgetVelocity();  // it may not be finite
        } else if (step.translation().norm() > kLongestStep || rotationAngle(step) > kLargestTurn) {
            found.reason = "the motion found is longer than range flow can see";
            flow_.forgetVelocity();
        } else {
            found.T_reference_frame = step;
        }
        return found;
    }

  private:
    /// False: the image has too little depth, and is left out as if it had not been taken.
    bool load(const RgbdFrame& frame, Registration& result) {
        const Stopwatch watch;
        const cv::Mat& depth = resampler_.apply(frame.depth, buffer_);
        result.becomes_reference = countKnown(depth) > kLeastKnown * static_cast<double>(depth.total());
        if (result.becomes_reference)
            flow_.load(depth);
        else
            result.reason = "too little depth";
        result.stage_ms = {watch.milliseconds(), 0};
        return result.becomes_reference;
    }

    PinholeCamera ideal_;
    DepthResampler resampler_;
    RangeFlow flow_;
    cv::Mat buffer_;
};

MethodInfo infoFor(int width, int height) {
    MethodInfo info;
    info.make = makerOf<Difodo>(width, height);
    return info;
}

#else

MethodInfo infoFor(int, int) {
    MethodInfo info;
    info.unavailable = "this MRPT has no vision module (package libmrpt-vision-dev)";
    return info;
}

#endif

}  // namespace

std::vector<MethodInfo> difodoMethods() {
    MethodInfo low = infoFor(320, 240), high = infoFor(640, 480);
    low.name = "difodo-240";
    low.label = "DIFODO 240x320";
    high.name = "difodo-480";
    high.label = "DIFODO 480x640";
    low.note = high.note =
        "MRPT's CDifodo: range flow from frame to frame, depth only; depth resampled for it to a centred, "
        "undistorted camera, since it knows a field of view only";
    return {low, high};
}

}  // namespace roevo
