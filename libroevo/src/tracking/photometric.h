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

/// Residuals of one set of photometric points at one pose and level, and the weights that follow from them.
/// Keeps its buffers.
class PhotometricResiduals {
  public:
    /// Projects the points by T_current_keyframe, compares patches, and estimates the spread of the
    /// residuals.
    /// @param camera  ideal camera of the level
    void evaluate(const PhotometricPoints& points, int level, const cv::Mat& image,
                  const PinholeCamera& camera, const Pose& T_current_keyframe, const RowMotion& rows,
                  const Brightness& brightness);

    int numVisible() const { return num_visible_; }
    double slope() const { return slope_; }  ///< see meanSlope(): of the points
    double cost() const { return cost_; }    ///< median, comparable between poses at one level

    /// The brightness that fits the present alignment best (weighted linear regression).
    Brightness fitBrightness(const PhotometricPoints& points, int level, const Brightness& current) const;

    /// The normal equations of all points, their information scaled by `factor`.
    void accumulate(const PhotometricPoints& points, int level, const PinholeCamera& camera, double factor,
                    kernels::NormalEquations& out);
    /// Adds the points of the last normal equations to their edges.
    void addTo(EdgeClusters& clusters, const PhotometricPoints& points) const {
        rows_.addTo(clusters, points.size(), [&](std::size_t i) { return points.edge_of[i]; });
    }

  private:
    kernels::PatchPoints view(const PhotometricPoints& points, int level) const;

    ProjectedPoints3 projected_;
    std::vector<float> axis_x_, axis_y_, prior_, weight_;  // of the points, padded
    InformationRows rows_;
    std::vector<kernels::PatchResidual> residuals_;
    std::vector<float> scratch_;
    int num_visible_ = 0;
    float gain_ = 1;
    double scale_ = 0, cost_ = 0, slope_ = 1;
};

/// The photometric residual of Eq. (2), with the brightness that it estimates along with the pose.
class PhotometricTerm : public ResidualTerm {
  public:
    /// @param residuals  buffers
    /// @param camera     ideal camera of the level
    PhotometricTerm(PhotometricResiduals& residuals, const PhotometricPoints& points, int level,
                    const cv::Mat& image, const PinholeCamera& camera, const Brightness& start)
        : residuals_(residuals),
          points_(points),
          image_(image),
          camera_(camera),
          level_(level),
          brightness_(start),
          best_brightness_(start) {}

    /// Too few visible points end the minimisation; 0: they never do.
    void require(int points) { needed_ = points; }
    /// Weighs all residuals together as `weight` times `points()` points (alpha of Eq. (9)); else each counts
    /// alone.
    void balance(double weight, std::function<std::size_t()> points) {
        weight_ = weight;
        counted_ = std::move(points);
    }

    bool linearise(const Linearisation& at, PoseSystem& system) override;
    double cost() const override { return residuals_.cost(); }
    void addTo(EdgeClusters& clusters) const override { residuals_.addTo(clusters, points_); }
    void keep() override;
    void update() override { brightness_ = residuals_.fitBrightness(points_, level_, brightness_); }

    // Of the best pose
    const Brightness& brightness() const { return best_brightness_; }
    int numVisible() const { return num_visible_; }  ///< where nothing was kept: of the first

  private:
    PhotometricResiduals& residuals_;
    const PhotometricPoints& points_;
    const cv::Mat& image_;
    const PinholeCamera& camera_;
    int level_, needed_ = 0, num_visible_ = -1;
    Brightness brightness_, best_brightness_;
    double weight_ = 1;
    std::function<std::size_t()> counted_;
};

}  // namespace roevo
