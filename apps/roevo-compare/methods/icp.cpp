#include "families.h"

#ifdef ROEVO_HAVE_MRPT_SLAM
#include <mrpt/maps/CSimplePointsMap.h>
#include <mrpt/poses/CPose3DPDF.h>
#include <mrpt/slam/CICP.h>

#include <Eigen/Geometry>
#include <opencv2/core.hpp>

#include "depth_resampler.h"
#include "registration_method.h"
#include "roevo_mrpt/pose_conversions.h"
#include "stopwatch.h"
#include "tracking/se3.h"
#endif

namespace roevo {
namespace {

#ifdef ROEVO_HAVE_MRPT_SLAM

/// Grid on which the depth image of a reference is sampled, and that of a frame which is registered to it.
/// They must not fit into each other: each point would find the one at its own pixel, and surfaces seem to
/// stand still.
constexpr int kReferenceColumns = 160, kReferenceRows = 120, kFrameColumns = 131, kFrameRows = 98;
constexpr std::size_t kLeastPoints = 200;  ///< fewer cannot carry a pose
constexpr double kLeastMatched = 0.3;  ///< share of points with a neighbour, below which nothing was found
// Of the keyframe method: the next keyframe is due.
constexpr double kKeyframeMatched = 0.7, kKeyframeTranslation = 0.2, kKeyframeRotation = 15 * kDegree;

/// Points of one frame about their centroid. CICP estimates a scale, too, and drops it, which bends the
/// translation by as much as the points are far from the origin.
struct Cloud {
    mrpt::maps::CSimplePointsMap::Ptr points = mrpt::maps::CSimplePointsMap::Create();
    Pose T_camera_cloud = Pose::Identity();
};

Cloud makeCloud(const cv::Mat& depth, const PinholeCamera& camera) {
    std::vector<Eigen::Vector3d> points;
    points.reserve(depth.total());
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    for (int v = 0; v < depth.rows; ++v) {
        const auto* row = depth.ptr<float>(v);
        for (int u = 0; u < depth.cols; ++u) {
            if (row[u] <= 0) continue;
            points.push_back(camera.backProject(u, v, row[u]));
            sum += points.back();
        }
    }
    Cloud cloud;
    if (points.empty()) return cloud;
    const Eigen::Vector3d centroid = sum / static_cast<double>(points.size());
    cloud.T_camera_cloud.translation() = centroid;
    cloud.points->reserve(points.size());
    for (const Eigen::Vector3d& point : points) {
        const Eigen::Vector3f p = (point - centroid).cast<float>();
        cloud.points->insertPointFast(p.x(), p.y(), p.z());
    }
    return cloud;
}

mrpt::slam::CICP::TConfigParams parameters() {
    mrpt::slam::CICP::TConfigParams icp;
    icp.ICP_algorithm = mrpt::slam::icpClassic;  // the only one for 3-D points
    icp.maxIterations = 40;
    icp.thresholdDist = 0.1;
    icp.thresholdAng = 0;
    icp.onlyUniqueRobust = true;
    icp.ALFA = 0.5;
    icp.smallestThresholdDist = 0.04;
    icp.minAbsStep_trans = 1e-4;
    icp.minAbsStep_rot = 1e-4;
    icp.corresponding_points_decimation = 1;  // the frame is sparse already
    icp.skip_cov_calculation = true;
    return icp;
}

/// Samples depth images on a grid.
class Sampler {
  public:
    Sampler(const PinholeCamera& camera, int columns, int rows, const SensorOptions& sensor)
        : grid_(centredCamera(camera, columns, rows)), resampler_(camera, grid_, sensor) {}

    Cloud cloud(const cv::Mat& depth) { return makeCloud(resampler_.apply(depth, buffer_), grid_); }

  private:
    PinholeCamera grid_;
    DepthResampler resampler_;
    cv::Mat buffer_;
};

class Icp : public RegistrationMethod {
  public:
    Icp(const PinholeCamera& camera, const OdometryOptions& options, bool keyframes)
        : RegistrationMethod(camera, options),
          keyframes_(keyframes),
          dense_(camera, kReferenceColumns, kReferenceRows, options.sensor),
          sparse_(camera, kFrameColumns, kFrameRows, options.sensor),
          icp_(parameters()) {}

    std::vector<std::string> stages() const override { return {"points", "solve"}; }

  protected:
    Registration start(const RgbdFrame& frame) override {
        Registration first;
        if (load(frame, first)) refer(frame, first);
        return first;
    }

    Registration registerFrame(const RgbdFrame& frame, const Expected& expected) override {
        Registration found;
        const auto cloud = load(frame, found);
        if (!cloud) return found;
        const Stopwatch watch;
        const Pose guess =
            reference_.T_camera_cloud.inverse() * expected.T_reference_frame * cloud->T_camera_cloud;
        mrpt::slam::CICP::TReturnInfo info;
        const auto result = icp_.Align3D(reference_.points.get(), cloud->points.get(), toMrpt(guess), info);
        const Pose T_reference_frame =
            reference_.T_camera_cloud * toEigen(result->getMeanVal()) * cloud->T_camera_cloud.inverse();
        found.stage_ms[1] = watch.milliseconds();
        if (info.goodness < kLeastMatched) {
            found.reason = "only " + std::to_string(static_cast<int>(100 * info.goodness)) +
                           " % of the points found a neighbour";
        } else {
            found.T_reference_frame = T_reference_frame;
            found.becomes_reference = !keyframes_ || info.goodness < kKeyframeMatched ||
                                      T_reference_frame.translation().norm() > kKeyframeTranslation ||
                                      rotationAngle(T_reference_frame) > kKeyframeRotation;
        }
        if (found.becomes_reference) refer(frame, found);
        return found;
    }

  private:
    /// None: the image has too little depth, and is left out as if it had not been taken.
    std::optional<Cloud> load(const RgbdFrame& frame, Registration& result) {
        const Stopwatch watch;
        Cloud cloud = sparse_.cloud(frame.depth);
        result.stage_ms = {watch.milliseconds(), 0};
        result.becomes_reference = cloud.points->size() >= kLeastPoints;
        if (result.becomes_reference) return cloud;
        result.reason = "too little depth";
        return std::nullopt;
    }

    void refer(const RgbdFrame& frame, Registration& result) {
        const Stopwatch watch;
        reference_ = dense_.cloud(frame.depth);
        result.stage_ms[0] += watch.milliseconds();
    }

    bool keyframes_;
    Sampler dense_, sparse_;
    mrpt::slam::CICP icp_;
    Cloud reference_;
};

MethodInfo infoFor(bool keyframes) {
    MethodInfo info;
    info.make = makerOf<Icp>(keyframes);
    return info;
}

#else

MethodInfo infoFor(bool) {
    MethodInfo info;
    info.unavailable = "this MRPT has no slam module (package libmrpt-slam-dev)";
    return info;
}

#endif

}  // namespace

std::vector<MethodInfo> icpMethods() {
    MethodInfo frame = infoFor(false), keyframe = infoFor(true);
    frame.name = "icp-frame";
    frame.label = "MRPT ICP frame";
    frame.note =
        "weak: MRPT's CICP, point to point, depth only, each frame to the one before, so that it drifts";
    keyframe.name = "icp-keyframe";
    keyframe.label = "MRPT ICP keyframe";
    keyframe.note =
        "weak on paper: MRPT's CICP, point to point, depth only; but each frame to the last keyframe, which "
        "keeps it from drifting";
    return {frame, keyframe};
}

}  // namespace roevo
