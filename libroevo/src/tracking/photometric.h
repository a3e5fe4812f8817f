#pragma once
#include <functional>
#include <utility>
#include <vector>

#include "roevo/types.h"
#include "tracking/edge_points.h"
#include "tracking/gauss_newton.h"
#include "tracking/image_pyramid.h"
#include "tracking/rolling_shutter.h"

namespace roevo {

/// Edge points of a keyframe chosen for photometric alignment, with their orientation-aligned reference
/// patches on every pyramid level, Eq. (2).
struct PhotometricPoints {
    Points3 points;                                    ///< keyframe camera frame, m; padded
    std::vector<float> axis_x, axis_y;                 ///< unit gradient, the patch's first axis
    std::vector<float> weight;                         ///< w_i of Eq. (3)
    std::vector<std::vector<kernels::Patch>> patches;  ///< [level][point]
    std::vector<std::int32_t> source;                  ///< index of the edge point
    std::vector<std::int32_t> edge_of;                 ///< index of its edge, -1 for none
    bool turning = true;  ///< patches turn with the camera about its optical axis, Eq. (2)

    std::size_t size() const { return axis_x.size(); }
};

/// Spreads at most `max_points` along the edges (every n-th point) and samples their patches.
PhotometricPoints samplePhotometricPoints(const EdgePoints3D& edges, const ImagePyramid& pyramid,
                                          int max_points);

/// Gain and offset between keyframe and current image: I_c = gain I_r + offset.
struct Brightness {
    double gain = 1, offset = 0;
};

/// The photometric residual of Eq. (2), with the brightness that it estimates along with the pose. Keeps its
/// buffers.
class PhotometricTerm : public ResidualTerm {
  public:
    /// What is compared, all of which must outlive the use of the term. Nothing is required or balanced.
    /// @param camera  ideal camera of the level
    void start(const PhotometricPoints& points, int level, const cv::Mat& image, const PinholeCamera& camera,
               const Brightness& brightness);
    /// Too few visible points end the minimisation; 0: they never do.
    void require(int points) { needed_ = points; }
    /// Weighs all residuals together as `weight` times `points()` points (alpha of Eq. (9)); else each counts
    /// alone.
    void balance(double weight, std::function<std::size_t()> points) {
        weight_of_all_ = weight;
        counted_ = std::move(points);
    }

    /// Projects the points, compares patches, and estimates the spread of the residuals and the weights that
    /// follow from it.
    /// @param rows  of the level
    void evaluate(const Pose& T_current_keyframe, const RowMotion& rows);
    int numVisible() const { return num_visible_; }
    double slope() const { return slope_; }         ///< see meanSlope(): of the points
    double cost() const override { return cost_; }  ///< median, comparable between poses at one level

    bool linearise(const Linearisation& at, PoseSystem& system) override;
    void addTo(EdgeClusters& clusters) const override {
        rows_.addTo(clusters, points_->size(), [&](std::size_t i) { return points_->edge_of[i]; });
    }
    void keep() override;
    /// To the brightness that fits the present alignment best (weighted linear regression).
    void update() override;

    // Of the best pose
    const Brightness& bestBrightness() const { return best_brightness_; }
    int bestVisible() const { return best_visible_; }  ///< where nothing was kept: of the first

  private:
    kernels::PatchPoints view() const;

    const PhotometricPoints* points_ = nullptr;
    const cv::Mat* image_ = nullptr;
    const PinholeCamera* camera_ = nullptr;
    int level_ = 0, needed_ = 0, num_visible_ = 0, best_visible_ = -1;
    Brightness brightness_, best_brightness_;
    double weight_of_all_ = 1, scale_ = 1, cost_ = 0, slope_ = 1;
    std::function<std::size_t()> counted_;

    ProjectedPoints3 projected_;
    std::vector<float> axis_x_, axis_y_, prior_, weight_;  // of the points, padded
    InformationRows rows_;
    std::vector<kernels::PatchResidual> residuals_;
    std::vector<float> scratch_;
};

}  // namespace roevo
