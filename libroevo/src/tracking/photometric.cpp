#include "tracking/photometric.h"

#include <algorithm>
#include <cmath>

#include "tracking/robust.h"
#include "tracking/se3.h"

namespace roevo {
namespace {

kernels::ImageView viewOf(const cv::Mat& image) {
    return {image.ptr<std::uint8_t>(), static_cast<std::ptrdiff_t>(image.step), image.cols, image.rows};
}

/// A patch that does not fit keeps an all-zero gram and so carries no information on this level.
kernels::Patch referencePatch(const cv::Mat& image, float u, float v, float axis_x, float axis_y) {
    constexpr float kReach = 5;  // patch radius 2, one for the slope, and whole words of bilinear neighbours
    kernels::Patch patch = {};
    if (u >= kReach && v >= kReach && u <= static_cast<float>(image.cols) - 1 - kReach &&
        v <= static_cast<float>(image.rows) - 1 - kReach)
        kernels::best().referencePatch(viewOf(image), u, v, axis_x, axis_y, patch);
    return patch;
}

}  // namespace

PhotometricPoints samplePhotometricPoints(const EdgePoints3D& edges, const ImagePyramid& pyramid,
                                          int max_points) {
    PhotometricPoints points;
    // Every n-th point over all edges: points of an edge are consecutive, so that this spreads evenly along
    // them
    const std::size_t step = strideFor(edges.size(), max_points);
    std::vector<std::size_t> chosen;
    for (std::size_t i = step / 2; i < edges.size(); i += step) chosen.push_back(i);
    for (const std::size_t i : chosen) {
        points.source.push_back(static_cast<std::int32_t>(i));
        points.edge_of.push_back(edges.image.edge_of[i]);
        points.points.add(edges.points.x[i], edges.points.y[i], edges.points.z[i]);
        points.axis_x.push_back(edges.image.gradient_x[i]);
        points.axis_y.push_back(edges.image.gradient_y[i]);
        const float slope = edges.image.strength[i] / 255;
        points.weight.push_back(edges.weight[i] / (1 + slope * slope));  // Eq. (3)
    }
    points.points.pad();
    points.patches.resize(static_cast<std::size_t>(pyramid.numLevels()));
    for (int level = 0; level < pyramid.numLevels(); ++level) {
        auto& patches = at(points.patches, level);
        patches.resize(chosen.size());
        const float scale = 1.0F / static_cast<float>(1 << level);
        for (std::size_t k = 0; k < chosen.size(); ++k) {
            const float u = (edges.image.x[chosen[k]] + 0.5F) * scale - 0.5F;
            const float v = (edges.image.y[chosen[k]] + 0.5F) * scale - 0.5F;
            patches[k] = referencePatch(pyramid.level(level), u, v, points.axis_x[k], points.axis_y[k]);
        }
    }
    return points;
}

void PhotometricTerm::start(const PhotometricPoints& points, int level, const cv::Mat& image,
                            const PinholeCamera& camera, const Brightness& brightness) {
    points_ = &points;
    image_ = &image;
    camera_ = &camera;
    level_ = level;
    brightness_ = best_brightness_ = brightness;
    best_visible_ = -1;
    require(0);
    balance(1, nullptr);
}

void PhotometricTerm::evaluate(const Pose& T, const RowMotion& rows) {
    const PhotometricPoints& points = *points_;
    const std::size_t n = points.size(), padded = kernels::paddedSize(n);
    project(points.points, T, *camera_, rows, projected_);
    axis_x_.resize(padded);
    axis_y_.resize(padded);
    weight_.resize(padded);
    residuals_.assign(padded, {-1, 0, 0, 0, 0});
    prior_.resize(padded, 0);
    std::copy(points.weight.begin(), points.weight.end(), prior_.begin());
    const Eigen::Vector2f turn = points.turning ? imageRotation(T) : Eigen::Vector2f(1, 0);
    for (std::size_t i = 0; i < n; ++i) {
        axis_x_[i] = turn.x() * points.axis_x[i] - turn.y() * points.axis_y[i];
        axis_y_[i] = turn.y() * points.axis_x[i] + turn.x() * points.axis_y[i];
    }
    const auto& patches = at(points.patches, level_);
    const auto& kernels = kernels::best();
    kernels.patches(viewOf(*image_), patches.data(), projected_.u.data(), projected_.v.data(), axis_x_.data(),
                    axis_y_.data(), n, static_cast<float>(brightness_.gain),
                    static_cast<float>(brightness_.offset), residuals_.data());
    scratch_.resize(n);
    std::size_t visible = 0;
    for (std::size_t i = 0; i < n; ++i) {
        const bool empty = patches[i].sum_squared == 0 && patches[i].gram[0] == 0;
        if (empty) residuals_[i].squared = -1;
        scratch_[visible] = residuals_[i].squared;
        visible += residuals_[i].squared >= 0 ? 1 : 0;
    }
    scratch_.resize(visible);
    num_visible_ = static_cast<int>(visible);
    scale_ = slope_ = 1;
    cost_ = 1e12;
    if (scratch_.empty()) {
        std::fill(weight_.begin(), weight_.end(), 0.0F);
        return;
    }
    constexpr double kFloor = 1;  // grey levels; 8-bit rounding and resampling never do better
    cost_ = std::sqrt(static_cast<double>(medianOfMagnitudes(scratch_)) / kernels::kPatchSize);
    scale_ = std::max(kFloor, cost_);
    const auto inverse = static_cast<float>(1 / (scale_ * scale_ * kernels::kPatchSize));
    kernels::Fit fit;
    kernels.weighPatches(residuals_.data(), prior_.data(), padded, inverse, weight_.data(), fit);
    slope_ = meanSlope(fit.slopes, fit.weights);
}

kernels::PatchPoints PhotometricTerm::view() const {
    return {at(points_->patches, level_).data(),
            residuals_.data(),
            points_->size(),
            projected_.x.data(),
            projected_.y.data(),
            projected_.z.data(),
            axis_x_.data(),
            axis_y_.data(),
            weight_.data()};
}

bool PhotometricTerm::linearise(const Linearisation& at, PoseSystem& system) {
    evaluate(at.T_current_keyframe, at.rows.atPyramidLevel(level_));
    if (best_visible_ < 0) best_visible_ = num_visible_;
    if (num_visible_ < needed_) return false;
    double factor = weight_of_all_;
    if (counted_)
        factor *= static_cast<double>(counted_()) / std::max<double>(1, num_visible_ * kernels::kPatchSize);
    const kernels::InformationArrays rows = rows_.arrays(points_->size());
    if (points_->size() > 0)
        kernels::best().liftPatches(
            view(), weight_.size(), static_cast<float>(camera_->fx), static_cast<float>(camera_->fy),
            static_cast<float>(factor / (scale_ * scale_)), static_cast<float>(brightness_.gain), rows);
    system.add(rows_.sum());
    return true;
}

void PhotometricTerm::keep() {
    best_brightness_ = brightness_;
    best_visible_ = num_visible_;
}

void PhotometricTerm::update() {
    if (points_->size() == 0) return;
    kernels::PatchSums sums;
    kernels::best().sumPatches(view(), weight_.size(), sums);
    const double w = sums.weight * kernels::kPatchSize, reference = sums.reference, image = sums.image;
    const double spread = sums.reference_squared - reference * reference / std::max(w, 1e-9);
    if (!(spread > 25 * w) || w <= 0) return;  // less than five grey levels of contrast fix no gain
    brightness_.gain = std::clamp((sums.cross - reference * image / w) / spread, 0.3, 3.0);
    brightness_.offset = (image - brightness_.gain * reference) / w;
}

}  // namespace roevo
