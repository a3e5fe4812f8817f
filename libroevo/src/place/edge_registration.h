#pragma once
#include "tracking/edge_term.h"

namespace roevo {

/// How well the edges of a keyframe and of a frame agree on a pose, with nothing known beforehand.
struct EdgeRegistration {
    Pose T_frame_keyframe = Pose::Identity();
    Matrix6d covariance = Matrix6d::Zero();  ///< of its left perturbation (t, phi)
    int inliers = 0;              ///< associated points of the keyframe that passed the chi-square test
    double keyframe_matched = 0;  ///< share of the keyframe's visible edges that the frame has
    double frame_matched = 0;     ///< share of the frame's visible edges that the keyframe has
    double visible = 0;           ///< the smaller share of edge points of one that are in view of the other
    double depth_agreement = 0;   ///< share of the associated points whose depths agree
    bool held = false;            ///< edges hold the pose in every direction; those of a place that
                                  ///< looks alike do, too
};

/// Registers a frame to a keyframe that it may never have been tracked against, by their edges only: from a
/// pose that is known to some centimetres, with a search radius that narrows down, and no motion prior.
/// Keeps buffers only.
class EdgeRegistrar {
  public:
    /// @param camera   with its lens
    /// @param options  as given: scaled to the camera here
    /// @param thinned  keyframes come with every n-th point of their edges, where that would be seen at the
    ///                 reference row's time
    EdgeRegistrar(const PinholeCamera& camera, const OdometryOptions& options, bool thinned);

    /// @param frame_edges  those of the frame that have depth, brought to the reference row's time by `rows`
    /// @param T_start      T_frame_keyframe
    /// @param rows         how the frame's rows moved, where that is known
    [[nodiscard]] EdgeRegistration registerEdges(const Keyframe& keyframe, const Frame& frame,
                                                 const EdgePoints3D& frame_edges, const Pose& T_start,
                                                 const RowMotion& rows = RowMotion());

  private:
    void lookBack(const Keyframe& keyframe, const EdgePoints3D& frame_edges, const RowMotion& rows,
                  EdgeRegistration& out);

    PinholeCamera ideal_;
    OdometryOptions options_;
    bool thinned_;
    EdgeTerm term_;
    EdgeAssociator associator_;
    EdgeGrid grid_;  ///< of the keyframe
    EdgeMatches matches_;
    ProjectedPoints3 projected_;  ///< the frame's points, in the keyframe
    EdgeClusters clusters_;
};

}  // namespace roevo
