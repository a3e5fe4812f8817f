#pragma once
#include <future>
#include <optional>
#include <vector>

#include "mapping/packed_keyframe.h"
#include "place/edge_registration.h"
#include "place/place_describer.h"
#include "place/place_index.h"
#include "tracking/relative_pose.h"
#include "trajectory.h"

namespace roevo {

/// Where a lost camera can be at most.
struct Whereabouts {
    Eigen::Vector3d centre = Eigen::Vector3d::Zero();  ///< in the world, m
    double radius = 0;                                 ///< m
};

/// Remembers what keyframes look like, and finds which of them a frame shows. Places that look alike are not
/// taken for each other: either points and edges tell the place from all others, or no other within reach of
/// the camera looks like it.
class Relocaliser {
  public:
    /// @param camera   with its lens
    /// @param options  as given: scaled to the camera here
    Relocaliser(const PinholeCamera& camera, const OdometryOptions& options);

    Relocaliser(const Relocaliser&) = delete;  // the thread points to it
    Relocaliser& operator=(const Relocaliser&) = delete;

    /// In a thread of its own.
    /// @param frame  that the keyframe was made of
    void add(const Keyframe& keyframe, const Frame& frame);

    /// The keyframe that the frame shows, and its pose relative to that.
    /// @param trajectory  with the keyframes
    /// @param end  only keyframes before this one
    [[nodiscard]] std::optional<RelativePose> find(const Frame& frame, const Trajectory& trajectory,
                                                   const Whereabouts& whereabouts, int end);

    /// The pose about this one that the edges of keyframe and frame, both ways, and their depths agree on, if
    /// they do.
    [[nodiscard]] std::optional<Pose> confirm(const Keyframe& keyframe, const Frame& frame,
                                              const Pose& T_keyframe_camera);

  private:
    struct Place {
        PlacePoints points;
        PackedKeyframe edges;
        double median_depth = 0;  ///< m
        RowMotion row_motion;
    };
    struct Recognition {
        RelativePose pose;
        Pose T_world_camera;
        double confidence = 0;
        bool accepted = false;
    };
    static std::optional<RelativePose> surest(const std::vector<Recognition>& recognised,
                                              const Whereabouts& whereabouts);
    Place describe(const Keyframe& keyframe, const cv::Mat& grey);
    void collect();
    Keyframe unpacked(int id) const;
    EdgePoints3D lifted(const Frame& frame) const;

    PinholeCamera camera_, ideal_;
    OdometryOptions options_;  // scaled to the camera
    PlaceDescriber describer_;
    PlaceIndex index_;
    PlaceVerifier verifier_;
    EdgeRegistrar registrar_;
    std::vector<Place> places_;  ///< of each keyframe, by its id
    PlacePoints points_;         ///< of the frame
    std::future<Place> newest_;  // last: waits for the thread
};

}  // namespace roevo
