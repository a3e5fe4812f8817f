#pragma once
#include <cstdint>
#include <vector>

#include "edges/edge_depth.h"
#include "tracking/edge_association.h"
#include "tracking/frame.h"
#include "tracking/gauss_newton.h"
#include "tracking/keyframe.h"

namespace roevo {

/// Factor on later steps: what remains is slow, as associations and weights follow the pose. It halves their
/// number.
constexpr double kOverRelaxation = 1.6;

/// Organized edges of a keyframe against those of a frame, Eqs. (4)-(13): associated anew as the pose moves,
/// with point-to-tangent residuals and those of the depth of associated points, robust scales re-estimated in
/// every step.
class EdgeTerm : public ResidualTerm {
  public:
    /// @param camera  with its lens
    EdgeTerm(const PinholeCamera& camera, const OdometryOptions& options);

    /// What is to be registered; both must outlive the use of the term. The search radius narrows down over
    /// the first iterations.
    void start(const Keyframe& keyframe, const Frame& frame);
    /// With the read-out time free, so that the keyframe's points move with it. They stay with their edges.
    /// @param matches  at the pose that is linearised first
    void startReadout(const Keyframe& keyframe, const Frame& frame, const EdgeMatches& matches);
    /// For associate() and assess() alone.
    void look(const Keyframe& keyframe, const Frame& frame);
    /// Of a keyframe at most so many points are looked up until the next look(), start() or linearise().
    void limit(int max_points) { associator_.limit(max_points); }

    bool linearise(const Linearisation& at, PoseSystem& system) override;
    void addTo(EdgeClusters& clusters) const override;

    /// By how much the pose of the last linearisation changes with the velocity of its rows: an image that is
    /// read while the camera moves otherwise than was thought is taken for one from elsewhere. Uses up the
    /// linearisation. @return s, maps (linear, turn) to (t, phi)
    /// @param prior_information  of the pose, from elsewhere
    Matrix6d movedByVelocity(const RowMotion& rows, const Matrix6d& prior_information);

    /// Edge-wise association at a given pose within `radius` px: fills matches().
    void associate(const Pose& T_current_keyframe, const RowMotion& rows, double radius);
    /// The same within the final radius, of a pair that was started.
    void renewMatches(const Pose& T_current_keyframe, const RowMotion& rows);
    /// Matches within the final radius, and the weights that follow. After linearise() near this pose its
    /// edges stay associated.
    void assess(const Pose& T_current_keyframe, const RowMotion& rows);

    /// Of the inliers whose depth is known in the frame, the share that is about where it should be; 1 where
    /// none is known.
    double depthAgreement();
    /// The frame's depth counts from now on, or not.
    void useDepth(bool use) { use_depth_ = use; }

    /// Iteration from which on the radius is the final one.
    int narrowed() const;
    const EdgeMatches& matches() const { return matches_; }
    int inliers() const { return inliers_; }  ///< matches that passed the chi-square test
    double slope() const { return slope_; }   ///< see meanSlope(): of the inliers
    /// Of the matches, padded; 0 where one is an outlier.
    const std::vector<float>& weights() const { return weight_; }

  private:
    /// What is needed of matched points, in their order; padded, by the first one with no weight.
    struct Matched {
        Points3 points;                 // in the keyframe, m
        ProjectedPoints3 projected;     // in the frame
        std::vector<float> row;         // in the keyframe, px
        std::vector<float> weight;      // w_s
        std::vector<float> blur;        // variance that the keyframe's motion adds, as share of that at rest
        std::vector<float> correction;  // m, see EdgePoints3D
        std::vector<std::int32_t> reference;  // index in the keyframe
        std::vector<std::int32_t> current;    // in the frame
    };
    bool isAssociated(const Pose& T_current_keyframe, double radius) const;
    void gather();
    void projectMatched(const Pose& pose, const RowMotion& rows);
    void follow();
    void tangentResiduals(const RowMotion& rows);
    void depthResiduals();
    void weigh();
    float currentDepth(std::size_t point);
    void accumulate(PoseSystem& system);
    void accumulateReadout(const Linearisation& at, PoseSystem& system);
    kernels::MatchedPoints matchedPoints() const;
    kernels::ImageEdges imageEdges() const;

    PinholeCamera camera_, ideal_;
    FineOptions options_;
    EdgeOptions edge_options_;
    SensorOptions sensor_;
    EdgeAssociator associator_;
    const Keyframe* keyframe_ = nullptr;
    const Frame* frame_ = nullptr;
    double looked_at_ = 0;  ///< s; frames use their memory again
    bool use_depth_ = true, free_readout_ = false;
    Pose T_associated_;             ///< pose at which edges were associated
    double associated_within_ = 0;  ///< px; 0: they are not

    EdgeMatches matches_;
    ProjectedPoints3 projected_;  // all keyframe points, where they were associated
    Matched matched_;
    Points3 moved_;  // matched points at another read-out time
    // of the matches, padded; sharpness: information across an edge as a share of what it would be at rest
    std::vector<float> residual_, sharpness_, weight_, depth_residual_, depth_weight_;
    ForegroundDepth foreground_;        // of the frame
    std::vector<float> current_depth_;  // of the frame's points, m
    std::vector<float> scratch_;
    InformationRows rows_;
    double scale_ = 1;  ///< robust spread of the point-to-tangent residual, px, of edges at rest
    double slope_ = 1;
    int inliers_ = 0;
};

}  // namespace roevo
