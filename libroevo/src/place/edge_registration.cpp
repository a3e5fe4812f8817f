#include "place/edge_registration.h"

#include <Eigen/LU>
#include <algorithm>

#include "tracking/camera_scale.h"
#include "tracking/fine_tracker.h"
#include "tracking/relative_pose.h"

namespace roevo {
namespace {

constexpr double kSearchRadius = 12;  ///< px of a camera with f = 525 px: what the pose may be off
constexpr int kMostIterations = 15;
constexpr double kRegistrationStill = 0.03;  ///< px; tracking goes on from here

// What it takes to hold a pose
constexpr double kEnoughInliers = 150;
constexpr double kLeastOfVisible = 0.5;  ///< of the points in view, where fewer are
constexpr double kLeastVisible = 0.25;
constexpr double kMostSigmaTranslation = 0.02;  ///< m
constexpr double kMostSigmaRotation = 1 * kDegree;

OdometryOptions widened(const PinholeCamera& camera, const OdometryOptions& given, bool thinned) {
    OdometryOptions options = scaledTo(camera, given);
    if (thinned) {
        options.fine = forThinned(options.fine);
        options.edges.tangent_span = given.edges.tangent_span;  // points that lie far apart on any image
    }
    options.fine.search_radius = std::max(options.fine.search_radius, kSearchRadius * camera.pixelScale());
    options.fine.max_iterations = std::max(options.fine.max_iterations, kMostIterations);
    return options;
}

}  // namespace

EdgeRegistrar::EdgeRegistrar(const PinholeCamera& camera, const OdometryOptions& options, bool thinned)
    : ideal_(camera.undistorted()),
      options_(widened(camera, options, thinned)),
      thinned_(thinned),
      term_(camera, options_),
      associator_(ideal_, options_.fine, options_.edges.tangent_span) {}

EdgeRegistration EdgeRegistrar::registerEdges(const Keyframe& keyframe, const Frame& frame,
                                              const EdgePoints3D& frame_edges, const Pose& T_start,
                                              const RowMotion& rows) {
    EdgeRegistration out;
    term_.start(keyframe, frame);
    GaussNewtonOptions loop{options_.fine.max_iterations, ideal_.fx, keyframe.typicalDepth()};
    loop.settled_from = term_.narrowed();
    loop.still = kRegistrationStill;
    loop.relaxation = kOverRelaxation;
    loop.relaxed_from = term_.narrowed();
    const GaussNewtonResult found = minimise(T_start, RollingShutter{rows}, {&term_}, loop);
    if (!found.complete || !found.T_current_keyframe.isFinite()) return out;
    out.T_frame_keyframe = found.T_current_keyframe;
    clusters_.start(keyframe.clusters);
    term_.addTo(clusters_);
    out.covariance = clusters_.uncertainty(found.system, term_.slope()).covariance();
    if (!out.covariance.allFinite()) return out;
    term_.look(keyframe, frame);
    term_.assess(out.T_frame_keyframe, rows);
    out.inliers = term_.inliers();
    out.keyframe_matched = term_.matches().matchedRatio();
    const bool as_seen = !thinned_ && rows.seconds_per_row != 0;
    lookBack(keyframe, frame_edges, as_seen ? keyframe.row_motion : RowMotion(), out);
    const double needed =
        std::max<double>(options_.fine.min_inliers, kLeastOfVisible * term_.matches().visible_points);
    out.held = out.inliers >= std::min(needed, kEnoughInliers) && out.visible >= kLeastVisible &&
               worstSigma(out.covariance.topLeftCorner<3, 3>()) <= kMostSigmaTranslation &&
               worstSigma(out.covariance.bottomRightCorner<3, 3>()) <= kMostSigmaRotation;
    return out;
}

/// @param rows  how those of the keyframe's image moved
void EdgeRegistrar::lookBack(const Keyframe& keyframe, const EdgePoints3D& frame_edges, const RowMotion& rows,
                             EdgeRegistration& out) {
    const Pose T_keyframe_frame = out.T_frame_keyframe.inverse();
    project(frame_edges.points, T_keyframe_frame, ideal_, rows, projected_);
    grid_.build(keyframe.edges.image, ideal_.width, ideal_.height);
    associator_.associate(frame_edges.image, projected_, T_keyframe_frame, keyframe.edges.image, grid_,
                          options_.fine.final_radius, matches_);
    out.frame_matched = matches_.matchedRatio();
    out.visible = std::min(term_.matches().visibleShare(), matches_.visibleShare());
    int agreed = 0;
    for (std::size_t k = 0; k < matches_.size(); ++k) {
        const auto i = static_cast<std::size_t>(matches_.reference[k]),
                   j = static_cast<std::size_t>(matches_.current[k]);
        if (depthsAgree(projected_.z[i], keyframe.edges.points.z[j], options_.sensor)) ++agreed;
    }
    out.depth_agreement =
        matches_.size() > 0 ? static_cast<double>(agreed) / static_cast<double>(matches_.size()) : 0;
}

}  // namespace roevo
