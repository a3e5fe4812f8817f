#pragma once
/// Frames as places are recognised by: keyframe, points, and the truth.

#include <memory>
#include <vector>

#include "odometry/frame_preparer.h"
#include "place/place_describer.h"
#include "tracking/keyframe.h"
#include "tracking/se3.h"

namespace roevo::testing {

struct PlaceView {
    Frame frame;
    Keyframe keyframe;
    PlacePoints points;
    Pose T_world_camera = Pose::Identity();
};

inline std::unique_ptr<PlaceView> makePlaceView(const PinholeCamera& camera, const RgbdFrame& images,
                                                const Pose& T_world_camera, int id) {
    const OdometryOptions options;
    auto view = std::make_unique<PlaceView>();
    view->frame.images = images;
    FramePreparer(camera, options).findEdges(view->frame);
    view->keyframe.id = id;
    view->keyframe.edges = liftEdges(view->frame.edges, view->frame.images.depth, camera, RowMotion(),
                                     options.edges, options.sensor);
    view->keyframe.median_depth = static_cast<double>(view->keyframe.edges.medianDepth());
    view->points = PlaceDescriber(camera).describe(view->keyframe.edges, view->frame.pyramid.level(0));
    view->T_world_camera = T_world_camera;
    return view;
}

inline Eigen::Vector3d position(const PlacePoint& point) {
    return {point.x, point.y, point.z};
}

/// Largest of the errors of a pose: its translation, m, and its rotation as what it does to a point at 1 m.
inline double poseError(const Pose& found, const Pose& truth) {
    const Pose error = truth.inverse() * found;
    return std::max(error.translation().norm(), rotationAngle(error));
}

}  // namespace roevo::testing
