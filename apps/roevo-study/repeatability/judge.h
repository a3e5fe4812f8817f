#pragma once
#include <cstddef>
#include <opencv2/core/types.hpp>
#include <optional>
#include <vector>

#include "frame.h"
#include "roevo/camera/pinhole_camera.h"

namespace roevo {

/// An association is right when it is within this many pixels of where the feature truly is.
inline constexpr float kTolerance = 3;
/// What an edge is associated with farther away (px) than this confuses nobody.
inline constexpr float kNeighbourhood = 30;

/// Where reference points truly are in a later frame.
struct TrueView {
    std::vector<float> u, v;  ///< ideal pixels
    std::vector<char>
        visible;  ///< 1: inside the image, and the frame's depth shows the point's surface there
    std::size_t num_visible = 0;
};

/// Reprojects points of the reference camera (m) into `frame`. A point counts as visible where some depth
/// near its place agrees with its own within 5 %: hidden ones, and those whose surroundings have no depth, do
/// not.
/// @param camera  of the depth image, with its lens
TrueView trueView(const std::vector<Eigen::Vector3d>& points, const Pose& T_frame_reference,
                  const FeatureFrame& frame, const PinholeCamera& camera);

/// Verdict on one method in one frame.
struct Verdict {
    std::size_t visible = 0;     ///< reference points that could be found
    std::size_t correct = 0;     ///< of them, those that were associated rightly
    std::size_t associated = 0;  ///< points that features were associated with, near them
    std::size_t right = 0;       ///< of them, those that lie where they should

    /// Share of the visible features that were rightly associated; none when too few are visible to tell.
    std::optional<double> share() const;
    /// Share of what features were associated with that is right; none without any.
    std::optional<double> precision() const;
};

/// @param found  where the method says that each reference point is; none: lost
Verdict judgePoints(const TrueView& view, const std::vector<std::optional<cv::Point2f>>& found);

/// Edges of the current frame that a method associates with each reference edge, in ascending order.
using EdgeLinks = std::vector<std::vector<int>>;

/// Judges edge-wise associations by the reference edges' true curves. The points of all edges associated with
/// a reference edge, as far as they are within kNeighbourhood of it, should lie on its curve or its straight
/// continuation (distance along the normal at most kTolerance; fragments of one edge are the same edge).
/// Where most of them do, the reference edge is rightly associated, and each of its visible points that one
/// of these edges passes within kTolerance counts as correct. So edges count by their visible length, one
/// that is only partly found again counts in part, and one lumped together with its neighbours does not
/// count.
/// @param grid  of `current`
Verdict judgeEdges(const OrganizedEdges& reference, const TrueView& view, const EdgeLinks& links,
                   const OrganizedEdges& current, const EdgeGrid& grid);

}  // namespace roevo
