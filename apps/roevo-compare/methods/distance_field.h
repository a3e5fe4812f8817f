#pragma once
#include <limits>
#include <opencv2/core/mat.hpp>
#include <vector>

#include "tracking/fine_tracker.h"

namespace roevo {

/// Exact Euclidean distance of every pixel to the nearest edge pixel, and its bilinear interpolation.
class DistanceField {
  public:
    /// @param mask  CV_8UC1, not 0 on an edge. Without any edge every pixel is far from one.
    void build(const cv::Mat& mask);

    struct Sample {
        float distance;  ///< px
        float du, dv;    ///< its derivatives, exact within the cell between four pixel centres
    };
    /// @param u, v  px, at least 0 and below width - 1 and height - 1
    Sample at(float u, float v) const;

    const cv::Mat& distances() const { return distance_; }  ///< CV_32FC1, px

  private:
    cv::Mat background_, distance_;
};

/// Registration as edge-based odometries before organized edges have it: a keyframe's 3-D edge points slide
/// down the distance field of the current frame's edge mask. No association; a residual is the interpolated
/// distance where a point is reprojected, never negative. Weights, narrowing radius, prior and largest number
/// of steps are those of FineTracker. Two things of it are missing: the residual in depth, since without
/// association no point of the frame is there to have one, and the longer late steps, which overshoot here.
class DistanceFieldTracker {
  public:
    /// @param camera  with its lens
    /// @param photometric_weight  alpha^2 of the residual joined with the photometric one as in FineTracker;
    /// 0 for the field alone
    DistanceFieldTracker(const PinholeCamera& camera, const FineOptions& options, double photometric_weight)
        : ideal_(camera.undistorted()), options_(options), photometric_weight_(photometric_weight) {}

    /// Builds the field of a frame when it is new; track() does so, too.
    void prepare(const Frame& frame);

    /// As FineTracker::track(). FineResult::inliers counts points
    /// near an edge, matched_ratio their share of those that are looked up and visible.
    [[nodiscard]] FineResult track(const Keyframe& keyframe, const Frame& frame, const Pose& T_start,
                                   const PosePrior& prior, const RollingShutter& shutter,
                                   const Brightness& brightness);

    /// Weighted normal equations at a pose.
    /// @param radius  points farther than this from any edge are left out, px
    PoseSystem linearise(const Keyframe& keyframe, const DistanceField& field, const PinholeCamera& camera,
                         const Pose& T_current_keyframe, const RowMotion& rows, double radius);
    /// Points that counted in the last linearisation.
    std::size_t numNear() const { return near_.size(); }
    /// Adds the points of the last linearisation to the edges that they belong to.
    void addTo(const Keyframe& keyframe, EdgeClusters& clusters) const;

    /// Milliseconds since the last call, of building fields and of registering.
    struct Times {
        double field = 0, registration = 0;
    };
    Times takeTimes();

  private:
    PinholeCamera ideal_;
    FineOptions options_;
    double photometric_weight_;
    DistanceField field_;
    double field_timestamp_ = std::numeric_limits<double>::quiet_NaN();  ///< s, frame of the field; NaN: none
    PhotometricTerm photometric_;
    ProjectedPoints3 projected_;     // all keyframe points
    std::vector<std::size_t> near_;  // points that count
    std::vector<float> gradient_u_, gradient_v_, residual_, magnitudes_;
    InformationRows rows_;
    EdgeClusters clusters_;
    double slope_ = 1;  ///< see meanSlope()
    double scale_ = 1;
    int visible_ = 0, inliers_ = 0;
    Times times_;
};

}  // namespace roevo
