#include "tracking/photometric.h"

#include <algorithm>
#include <cmath>

#include "tracking/robust.h"

namespace roevo {
namespace {

/// Bilinear sample; the caller keeps (u, v) inside.
float sample(const cv::Mat& image, float u, float v) {
    const int x = static_cast<int>(std::floor(u)), y = static_cast<int>(std::floor(v));
    const float fx = u - static_cast<float>(x), fy = v - static_cast<float>(y);
    const auto* top = image.ptr<std::uint8_t>(y) + x;
    const auto* bottom = image.ptr<std::uint8_t>(y + 1) + x;
    const float upper = static_cast<float>(top[0]) + fx * static_cast<float>(top[1] - top[0]);
    const float lower = static_cast<float>(bottom[0]) + fx * static_cast<float>(bottom[1] - bottom[0]);
    return upper + fy * (lower - upper);
}

/// False when the patch does not fit into the image.
bool samplePatch(const cv::Mat& image, float u, float v, float axis_x, float axis_y, kernels::Patch& patch) {
    constexpr float kReach = 4;  // patch radius 2, one for the slope, one for the bilinear neighbour
    patch = {};
    if (!(u >= kReach && v >= kReach && u <= static_cast<float>(image.cols) - 1 - kReach &&
          v <= static_cast<float>(image.rows) - 1 - kReach)) {
        return false;
    }
    for (int j = 0; j < kernels::kPatchSize; ++j) {
        const float x = u + axis_x * kernels::kPatchU[j] - axis_y * kernels::kPatchV[j];
        const float y = v + axis_y * kernels::kPatchU[j] + axis_x * kernels::kPatchV[j];
        const float along =
            (sample(image, x + axis_x, y + axis_y) - sample(image, x - axis_x, y - axis_y)) / 2;
        const float across =
            (sample(image, x - axis_y, y + axis_x) - sample(image, x + axis_y, y - axis_x)) / 2;
        const float intensity = sample(image, x, y);
        patch.intensity[j] = intensity;
        patch.slope_u[j] = along;
        patch.slope_v[j] = across;
        patch.gram[0] += along * along;
        patch.gram[1] += along * across;
        patch.gram[2] += across * across;
        patch.sum += intensity;
        patch.sum_squared += intensity * intensity;
    }
    return true;
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
        auto& patches = points.patches[static_cast<std::size_t>(level)];
        patches.resize(chosen.size());
        const float scale = 1.0F / static_cast<float>(1 << level);
        for (std::size_t k = 0; k < chosen.size(); ++k) {
            const float u = (edges.image.x[chosen[k]] + 0.5F) * scale - 0.5F;
            const float v = (edges.image.y[chosen[k]] + 0.5F) * scale - 0.5F;
            // A patch that does not fit keeps an all-zero gram and so carries no information on this level
            samplePatch(pyramid.level(level), u, v, points.axis_x[k], points.axis_y[k], patches[k]);
        }
    }
    return points;
}

Eigen::Vector2f imageRotation(const Pose& T) {
    const Eigen::Vector2d turn(T.linear()(0, 0) + T.linear()(1, 1), T.linear()(1, 0) - T.linear()(0, 1));
    return turn.normalized().cast<float>();
}

void PhotometricResiduals::evaluate(const PhotometricPoints& points, int level, const cv::Mat& image,
                                    const PinholeCamera& camera, const Pose& T, const RowMotion& rows,
                                    const Brightness& brightness) {
    gain_ = static_cast<float>(brightness.gain);
    const std::size_t n = points.size();
    project(points.points, T, camera, rows, projected_);
    axis_x_.resize(n);
    axis_y_.resize(n);
    weight_.resize(n);
    residuals_.resize(n);
    const Eigen::Vector2f turn = points.turning ? imageRotation(T) : Eigen::Vector2f(1, 0);
    for (std::size_t i = 0; i < n; ++i) {
        axis_x_[i] = turn.x() * points.axis_x[i] - turn.y() * points.axis_y[i];
        axis_y_[i] = turn.y() * points.axis_x[i] + turn.x() * points.axis_y[i];
    }
    const auto& patches = points.patches[static_cast<std::size_t>(level)];
    kernels::best().patches(
        {image.ptr<std::uint8_t>(), static_cast<std::ptrdiff_t>(image.step), image.cols, image.rows},
        patches.data(), projected_.u.data(), projected_.v.data(), axis_x_.data(), axis_y_.data(), n,
        static_cast<float>(brightness.gain), static_cast<float>(brightness.offset), residuals_.data());
    scratch_.clear();
    for (std::size_t i = 0; i < n; ++i) {
        const bool empty = patches[i].sum_squared == 0 && patches[i].gram[0] == 0;
        if (empty) residuals_[i].squared = -1;
        if (residuals_[i].squared >= 0) scratch_.push_back(residuals_[i].squared);
    }
    num_visible_ = static_cast<int>(scratch_.size());
    scale_ = 1;
    cost_ = 1e12;
    if (scratch_.empty()) {
        std::fill(weight_.begin(), weight_.end(), 0.0F);
        return;
    }
    constexpr double kFloor = 1;  // grey levels; 8-bit rounding and resampling never do better
    cost_ = std::sqrt(static_cast<double>(medianOf(scratch_)) / kernels::kPatchSize);
    scale_ = std::max(kFloor, cost_);
    const auto inverse = static_cast<float>(1 / (scale_ * scale_ * kernels::kPatchSize));
    double weights = 0, slopes = 0;
    for (std::size_t i = 0; i < n; ++i) {
        const float squared = residuals_[i].squared * inverse;
        weight_[i] = residuals_[i].squared < 0 ? 0 : studentWeight(points.weight[i], squared);
        weights += static_cast<double>(weight_[i]);
        slopes += static_cast<double>(weight_[i] * studentSlope(squared));
    }
    slope_ = weights > 0 ? std::max(slopes / weights, kLeastSlope) : 1;
}

Brightness PhotometricResiduals::fitBrightness(const PhotometricPoints& points, int level,
                                               const Brightness& current) const {
    const auto& patches = points.patches[static_cast<std::size_t>(level)];
    double w = 0, reference = 0, image = 0, reference2 = 0, cross = 0;
    for (std::size_t i = 0; i < points.size(); ++i) {
        const double weight = weight_[i];
        if (weight == 0) continue;
        w += weight * kernels::kPatchSize;
        reference += weight * static_cast<double>(patches[i].sum);
        reference2 += weight * static_cast<double>(patches[i].sum_squared);
        image += weight * static_cast<double>(residuals_[i].current);
        cross += weight * static_cast<double>(residuals_[i].cross);
    }
    const double spread = reference2 - reference * reference / std::max(w, 1e-9);
    if (!(spread > 25 * w) || w <= 0) return current;  // less than five grey levels of contrast fix no gain
    Brightness fitted;
    fitted.gain = std::clamp((cross - reference * image / w) / spread, 0.3, 3.0);
    fitted.offset = (image - fitted.gain * reference) / w;
    return fitted;
}

void PhotometricResiduals::accumulate(const PhotometricPoints& points, int level, const PinholeCamera& camera,
                                      double factor, kernels::NormalEquations& out) {
    rows_.reset(points.size());
    const auto& patches = points.patches[static_cast<std::size_t>(level)];
    const auto scale = static_cast<float>(factor / (scale_ * scale_));
    const auto fx = static_cast<float>(camera.fx), fy = static_cast<float>(camera.fy);
    for (std::size_t i = 0; i < points.size(); ++i) {
        if (weight_[i] == 0) {
            rows_.leaveOut(i);
            continue;
        }
        // From the aligned frame to the image: M = A G A^T, v = A g with A = [c -s; s c]
        // The current image's slopes are `gain` times the reference's: so is the Jacobian
        const float c = axis_x_[i], s = axis_y_[i], w = weight_[i] * scale, slopes = w * gain_,
                    squares = slopes * gain_;
        const float g0 = patches[i].gram[0] * squares, g1 = patches[i].gram[1] * squares,
                    g2 = patches[i].gram[2] * squares;
        const float r0 = residuals_[i].gradient_u * slopes, r1 = residuals_[i].gradient_v * slopes;
        const float m00 = c * c * g0 - 2 * c * s * g1 + s * s * g2;
        const float m01 = c * s * (g0 - g2) + (c * c - s * s) * g1;
        const float m11 = s * s * g0 + 2 * c * s * g1 + c * c * g2;
        float matrix[6], vector[3];
        const float x = projected_.x[i], y = projected_.y[i], z = projected_.z[i];
        liftInformation(x, y, z, fx, fy, m00, m01, m11, c * r0 - s * r1, s * r0 + c * r1, matrix, vector);
        rows_.set(i, matrix, vector, x, y, z);
    }
    out = rows_.sum();
}

bool PhotometricTerm::linearise(const Linearisation& at, PoseSystem& system) {
    residuals_.evaluate(points_, level_, image_, camera_, at.T_current_keyframe,
                        at.rows.atPyramidLevel(level_), brightness_);
    if (num_visible_ < 0) num_visible_ = residuals_.numVisible();
    if (residuals_.numVisible() < needed_) return false;
    double factor = weight_;
    if (counted_) {
        factor *= static_cast<double>(counted_()) /
                  std::max<double>(1, residuals_.numVisible() * kernels::kPatchSize);
    }
    kernels::NormalEquations equations;
    residuals_.accumulate(points_, level_, camera_, factor, equations);
    system.add(equations);
    return true;
}

void PhotometricTerm::keep() {
    best_brightness_ = brightness_;
    num_visible_ = residuals_.numVisible();
    residual_ = residuals_.scale();
}

}  // namespace roevo
