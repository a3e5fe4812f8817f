#include "distance_field.h"

#include <Eigen/LU>
#include <algorithm>
#include <chrono>
#include <cmath>
#include <opencv2/imgproc.hpp>
#include <utility>

#include "tracking/robust.h"
#include "tracking/se3.h"

namespace roevo {
namespace {

using Clock = std::chrono::steady_clock;

/// The distance residual, with a radius that narrows down as FineTracker's does.
class FieldTerm : public ResidualTerm {
  public:
    FieldTerm(DistanceFieldTracker& tracker, const Keyframe& keyframe, const DistanceField& field,
              const PinholeCamera& camera, const FineOptions& options)
        : tracker_(tracker), keyframe_(keyframe), field_(field), camera_(camera), options_(options) {}

    int narrowed() const { return std::clamp(options_.max_iterations - 1, 1, 4); }
    bool linearise(const Linearisation& at, PoseSystem& system) override {
        const double share = std::min(1.0, static_cast<double>(at.iteration) / narrowed());
        const double radius =
            options_.search_radius + share * (options_.final_radius - options_.search_radius);
        const PoseSystem own =
            tracker_.linearise(keyframe_, field_, camera_, at.T_current_keyframe, at.rows, radius);
        system.hessian += own.hessian;
        system.gradient += own.gradient;
        return static_cast<int>(tracker_.numNear()) >= options_.min_inliers;
    }
    void addTo(EdgeClusters& clusters) const override { tracker_.addTo(keyframe_, clusters); }

  private:
    DistanceFieldTracker& tracker_;
    const Keyframe& keyframe_;
    const DistanceField& field_;
    const PinholeCamera& camera_;
    const FineOptions& options_;
};

/// Information that a residual in the image, of these slopes, has of the point that is projected there,
/// carried to three dimensions through the projection's Jacobian (Eq. (24)).
void lift(const kernels::InformationArrays& out, std::size_t k, const PinholeCamera& camera,
          const Eigen::Vector3d& point, const Eigen::Vector2d& slopes, double residual, double weight) {
    const double x = point.x(), y = point.y(), z = point.z(), u = slopes.x() * camera.fx / z,
                 v = slopes.y() * camera.fy / z;
    const double by_point[3] = {u, v, -(u * x + v * y) / z};
    out.x[k] = static_cast<float>(x);
    out.y[k] = static_cast<float>(y);
    out.z[k] = static_cast<float>(z);
    for (int r = 0, m = 0; r < 3; ++r) {
        out.vector[r][k] = static_cast<float>(weight * residual * by_point[r]);
        for (int c = r; c < 3; ++c, ++m)
            out.matrix[m][k] = static_cast<float>(weight * by_point[r] * by_point[c]);
    }
}

double millisecondsSince(Clock::time_point start) {
    return std::chrono::duration<double, std::milli>(Clock::now() - start).count();
}

}  // namespace

void DistanceField::build(const cv::Mat& mask) {
    cv::compare(mask, 0, background_, cv::CMP_EQ);
    cv::distanceTransform(background_, distance_, cv::DIST_L2, cv::DIST_MASK_PRECISE, CV_32F);
}

DistanceField::Sample DistanceField::at(float u, float v) const {
    const int x = static_cast<int>(u), y = static_cast<int>(v);
    const float a = u - static_cast<float>(x), b = v - static_cast<float>(y);
    const auto* top = distance_.ptr<float>(y) + x;
    const auto* bottom = distance_.ptr<float>(y + 1) + x;
    const float upper = top[1] - top[0], lower = bottom[1] - bottom[0];
    const float left = bottom[0] - top[0];
    const float turn = lower - upper;  // of the slope along u, per pixel along v
    return {top[0] + a * upper + b * (left + a * turn), upper + b * turn, left + a * turn};
}

PoseSystem DistanceFieldTracker::linearise(const Keyframe& keyframe, const DistanceField& field,
                                           const PinholeCamera& camera, const Pose& T_current_keyframe,
                                           const RowMotion& rows, double radius) {
    const EdgePoints3D& edges = keyframe.edges;
    project(edges.points, T_current_keyframe, camera, rows, projected_);
    near_.clear();
    for (auto* array : {&gradient_u_, &gradient_v_, &residual_}) array->clear();
    visible_ = 0;
    const float margin = EdgeMask::kBorder;  // the mask is empty there, and its edges are not where they seem
    const float max_u = static_cast<float>(camera.width) - 1 - margin,
                max_v = static_cast<float>(camera.height) - 1 - margin;
    const std::size_t stride = strideFor(edges.size(), options_.max_points);
    for (std::size_t i = stride / 2; i < edges.size(); i += stride) {
        const float u = projected_.u[i], v = projected_.v[i];
        if (!(u >= margin && v >= margin && u <= max_u && v <= max_v)) continue;
        ++visible_;
        const DistanceField::Sample sample = field.at(u, v);
        if (!(static_cast<double>(sample.distance) <= radius)) continue;
        near_.push_back(i);
        residual_.push_back(sample.distance);
        gradient_u_.push_back(sample.du);
        gradient_v_.push_back(sample.dv);
    }
    inliers_ = 0;
    PoseSystem system;
    if (near_.empty()) return system;

    magnitudes_ = residual_;
    scale_ = robustScale(magnitudes_);
    const auto inverse = static_cast<float>(1 / (scale_ * scale_));
    const auto chi2 = static_cast<float>(options_.chi2);
    const kernels::InformationArrays out = rows_.arrays(near_.size());
    double weights = 0, slopes = 0;
    for (std::size_t k = 0; k < kernels::paddedSize(near_.size()); ++k) {
        const std::size_t j = std::min(k, near_.size() - 1), i = near_[j];
        const float r = residual_[j], squared = r * r * inverse;
        float w = 0;  // outliers and the padding contribute nothing
        if (k < near_.size() && squared <= chi2) {
            ++inliers_;
            w = studentWeight(edges.weight[i] * inverse, squared);
            weights += static_cast<double>(w);
            slopes += static_cast<double>(w * (kStudentNu - squared) / (kStudentNu + squared));
        }
        lift(out, k, camera, projected_.at(i), Eigen::Vector2f(gradient_u_[j], gradient_v_[j]).cast<double>(),
             static_cast<double>(r), static_cast<double>(w));
    }
    slope_ = meanSlope(slopes, weights);
    system.add(rows_.sum());
    return system;
}

void DistanceFieldTracker::addTo(const Keyframe& keyframe, EdgeClusters& clusters) const {
    rows_.addTo(clusters, near_.size(),
                [&](std::size_t k) { return keyframe.edges.image.edge_of[near_[k]]; });
}

void DistanceFieldTracker::prepare(const Frame& frame) {
    if (field_timestamp_ == frame.timestamp()) return;
    const Clock::time_point begin = Clock::now();
    field_.build(frame.mask.mask);
    field_timestamp_ = frame.timestamp();
    times_.field += millisecondsSince(begin);
}

FineResult DistanceFieldTracker::track(const Keyframe& keyframe, const Frame& frame, const Pose& T_start,
                                       const PosePrior& prior, const RollingShutter& shutter,
                                       const Brightness& brightness) {
    prepare(frame);
    const Clock::time_point begin = Clock::now();
    FieldTerm field(*this, keyframe, field_, ideal_, options_);
    photometric_.start(keyframe.photometric, 0, frame.pyramid.level(0), ideal_, brightness);
    photometric_.balance(photometric_weight_, [this] { return near_.size(); });
    PriorTerm likely(prior);
    std::vector<ResidualTerm*> terms{&field, &likely};
    if (photometric_weight_ > 0 && keyframe.photometric.size() > 0) terms.push_back(&photometric_);
    GaussNewtonOptions loop{options_.max_iterations, ideal_.fx, keyframe.typicalDepth()};
    loop.settled_from = field.narrowed();
    const GaussNewtonResult found = minimise(T_start, shutter, terms, loop);
    const Pose& pose = found.T_current_keyframe;
    FineResult result;
    result.iterations = found.iterations;
    result.inliers = inliers_;
    result.matched_ratio = visible_ > 0 ? static_cast<double>(near_.size()) / visible_ : 0;
    result.converged = inliers_ >= options_.min_inliers && pose.isFinite();
    result.T_current_keyframe = result.converged ? pose : T_start;
    if (result.converged) {
        clusters_.start(keyframe.clusters);
        for (const ResidualTerm* term : terms) term->addTo(clusters_);
        result.uncertainty = clusters_.uncertainty(found.system, slope_, &likely);
    }
    times_.registration += millisecondsSince(begin);
    return result;
}

DistanceFieldTracker::Times DistanceFieldTracker::takeTimes() {
    return std::exchange(times_, Times());
}

}  // namespace roevo
