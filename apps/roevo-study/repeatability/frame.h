#pragma once
#include <cstddef>
#include <memory>
#include <opencv2/core/mat.hpp>

#include "camera/undistorter.h"
#include "edges/edge_extractor.h"
#include "edges/edge_grid.h"
#include "roevo/camera/rgbd_frame.h"
#include "roevo/options.h"
#include "roevo/types.h"
#include "tracking/camera_scale.h"
#include "tracking/edge_points.h"

namespace roevo {

/// One frame with the features of all methods under study. Grids refer to its edges: it does not move.
struct FeatureFrame {
    FeatureFrame() = default;
    FeatureFrame(const FeatureFrame&) = delete;
    FeatureFrame& operator=(const FeatureFrame&) = delete;

    std::size_t number = 0;  ///< in the recording under study, counted from 0
    double timestamp = 0;    ///< s
    cv::Mat grey;            ///< CV_8UC1, as an ideal lens would have seen it
    cv::Mat depth;           ///< CV_32FC1, m, as the lens saw it
    OrganizedEdges edges;    ///< all of the image
    EdgePoints3D lifted;     ///< of them, those with depth
    EdgeGrid grid, lifted_grid;
    Pose T_world_camera = Pose::Identity();    ///< the true one, by which associations are judged
    Pose T_world_search = Pose::Identity();    ///< by which edges are reprojected to associate them
    Pose T_world_odometry = Pose::Identity();  ///< as the odometry has it in the end
};

/// Makes them of the frames of one recording.
class FeatureExtractor {
  public:
    FeatureExtractor(const PinholeCamera& camera, const OdometryOptions& options)
        : camera_(camera),
          options_(scaledTo(camera, options)),
          undistorter_(camera),
          extractor_(options_.edges) {}

    /// Poses are left to the caller.
    std::shared_ptr<FeatureFrame> extract(const RgbdFrame& frame, std::size_t number);

  private:
    PinholeCamera camera_;
    OdometryOptions options_;
    Undistorter undistorter_;
    EdgeExtractor extractor_;
};

}  // namespace roevo
