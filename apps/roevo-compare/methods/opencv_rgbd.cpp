#include "families.h"

#ifdef ROEVO_HAVE_OPENCV_RGBD
#include <limits>
#include <opencv2/core.hpp>
#include <opencv2/rgbd.hpp>

#include "camera/undistorter.h"
#include "depth_resampler.h"
#include "registration_method.h"
#include "stopwatch.h"
#endif

namespace roevo {
namespace {

#ifdef ROEVO_HAVE_OPENCV_RGBD

using cv::rgbd::Odometry;
using cv::rgbd::OdometryFrame;

/// Least share of the pixels with a depth.
constexpr double kLeastShareKnown = 0.02;

class OpencvRgbd : public RegistrationMethod {
  public:
    OpencvRgbd(const PinholeCamera& camera, const OdometryOptions& options, bool with_icp)
        : RegistrationMethod(camera, options),
          undistorter_(camera),
          resampler_(camera, camera.undistorted(), options.sensor) {
        const cv::Matx33d K(camera.fx, 0, camera.cx, 0, camera.fy, camera.cy, 0, 0, 1);
        const auto nearest = static_cast<float>(options.sensor.min_depth),
                   farthest = static_cast<float>(options.sensor.depth_limit);
        if (with_icp)
            odometry_ = cv::rgbd::RgbdICPOdometry::create(cv::Mat(K), nearest, farthest);
        else
            odometry_ = cv::rgbd::RgbdOdometry::create(cv::Mat(K), nearest, farthest);
    }

    std::vector<std::string> stages() const override { return {"prepare", "solve"}; }

  protected:
    Registration start(const RgbdFrame& frame) override {
        Registration first;
        reference_ = load(frame, first);
        return first;
    }

    Registration registerFrame(const RgbdFrame& frame, const Expected& /*expected*/) override {
        Registration found;
        cv::Ptr<OdometryFrame> current = load(frame, found);
        if (!current) return found;
        const Stopwatch watch;
        cv::Mat T;  // maps points of the first frame into the second's
        // No guess: constant velocity sends it astray where there is little texture (2 m off on TUM's fr3)
        const bool solved = odometry_->compute(current, reference_, T);
        found.stage_ms[1] = watch.milliseconds();
        if (solved)
            found.T_reference_frame = toPose(T);
        else
            found.reason = "too few correspondences or a motion beyond the limits of OpenCV";
        reference_ = current;
        return found;
    }

  private:
    /// Null: the image has too little depth, and is left out as if it had not been taken.
    cv::Ptr<OdometryFrame> load(const RgbdFrame& frame, Registration& result) {
        const Stopwatch watch;
        cv::Mat grey, depth;
        // Not zero for unknown depth: its pyramid would mix the two.
        resampler_.apply(frame.depth, depth, std::numeric_limits<float>::quiet_NaN());
        result.becomes_reference = countKnown(depth) > kLeastShareKnown * static_cast<double>(depth.total());
        cv::Ptr<OdometryFrame> prepared;
        if (result.becomes_reference) {
            undistorter_.apply(frame.grey, grey);
            if (undistorter_.isIdentity()) grey = frame.grey.clone();  // the caller may use its memory again
            prepared = OdometryFrame::create(grey, depth);
            odometry_->prepareFrameCache(prepared, OdometryFrame::CACHE_ALL);
        } else {
            result.reason = "too little depth";
        }
        result.stage_ms = {watch.milliseconds(), 0};
        return prepared;
    }

    static Pose toPose(const cv::Mat& T) {
        Eigen::Matrix4d matrix = Eigen::Matrix4d::Identity();
        for (int row = 0; row < 3; ++row)
            for (int column = 0; column < 4; ++column) matrix(row, column) = T.at<double>(row, column);
        return Pose(matrix);
    }

    Undistorter undistorter_;
    DepthResampler resampler_;
    cv::Ptr<Odometry> odometry_;
    cv::Ptr<OdometryFrame> reference_;
};

MethodInfo infoFor(bool with_icp) {
    MethodInfo info;
    info.make = makerOf<OpencvRgbd>(with_icp);
    return info;
}

#else

MethodInfo infoFor(bool) {
    MethodInfo info;
    info.unavailable = "this OpenCV has no rgbd module (package libopencv-contrib-dev)";
    return info;
}

#endif

}  // namespace

std::vector<MethodInfo> opencvRgbdMethods() {
    MethodInfo rgbd = infoFor(false), icp = infoFor(true);
    rgbd.name = "opencv-rgbd";
    rgbd.label = "OpenCV RGB-D";
    rgbd.note =
        "OpenCV contrib's RgbdOdometry: dense photometric registration from frame to frame, each started at "
        "no motion, since a guess by constant velocity made it worse";
    icp.name = "opencv-rgbd-icp";
    icp.label = "OpenCV RGB-D+ICP";
    icp.note =
        "OpenCV contrib's RgbdICPOdometry: dense photometric and point-to-plane registration from frame to "
        "frame, each started at no motion";
    return {rgbd, icp};
}

}  // namespace roevo
