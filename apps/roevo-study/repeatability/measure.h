#pragma once
#include <array>
#include <optional>
#include <string>
#include <vector>

#include "study.h"

namespace roevo {

/// Methods in the order of the tables.
enum class AssociationMethod { kOpticalFlow, kNearest, kNormals, kKeyframe, kDisjointSet };
inline constexpr std::size_t kNumAssociationMethods = 5;

/// One frame, seen from one reference frame.
struct RepeatabilityRow {
    std::size_t reference = 0, frame = 0;  ///< numbers in the recording under study, counted from 0
    double rotation_deg = 0;               ///< between the two cameras
    double translation = 0;                ///< m
    double disagreement = 0;  ///< px, median over the visible edge points, between the judging poses and
                              ///< the odometry's: more than kTolerance, and it is the poses that fail
    std::size_t visible_corners = 0, visible_points = 0;  ///< of the reference's features
    /// Share of them that is rightly associated, and of the associations that is right, by method.
    std::array<std::optional<double>, kNumAssociationMethods> share, precision;
};

struct Repeatability {
    std::vector<RepeatabilityRow> rows;
    std::string judged_by;                     ///< poses of the true places: "ground truth", else "roevo-ba"
    std::string searched_by;                   ///< poses at which edges were reprojected to be associated
    double disagreement = 0;                   ///< px, median over the rows
    std::size_t references = 0, left_out = 0;  ///< left out: frames that cannot be read or have no pose
};

/// Ground truth that puts edges so close (px, median) to where the odometry does is exact enough to associate
/// by, too. Motion capture often is not.
inline constexpr double kExactPoses = 1.5;

/// How references are chosen.
struct ReferencePlan {
    std::size_t every = 30;    ///< frames between references; the first frame is one
    std::size_t follow = 150;  ///< frames after it in which a reference's features are looked for
};

/// Features are judged by ground truth, or without it by the final poses of ROEVO ba. Edges are reprojected,
/// to be associated, at the ground truth where it is exact (kExactPoses), else at the odometry's final poses
/// of the same recording; optical flow needs none.
/// @throws std::runtime_error when no frame can be compared with another
Repeatability measureRepeatability(const StudyInput& input, const ReferencePlan& plan);

/// Pose at a time between two stamps at most `max_gap` seconds apart; none outside.
std::optional<Pose> poseAt(const std::vector<StampedPose>& trajectory, double time, double max_gap);

}  // namespace roevo
