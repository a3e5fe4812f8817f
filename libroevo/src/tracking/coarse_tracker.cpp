#include "roevo/tracking/coarse_tracker.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "roevo/tracking/se3.h"

namespace roevo {

double CoarseTracker::alignLevel(const Keyframe& keyframe, const cv::Mat& image, int level,
                                 const PinholeCamera& camera, const RollingShutter& shutter,
                                 CoarseResult& state) {
    const PhotometricPoints& points = keyframe.photometric;
    const double depth = std::max(keyframe.median_depth, 0.1);
    Pose pose = state.T_current_keyframe;
    Brightness brightness = state.brightness;
    double best_cost = -1;
    for (int iteration = 0; iteration <= options_.max_iterations; ++iteration) {
        residuals_.evaluate(points, level, image, camera, pose, shutter.motion(pose).atPyramidLevel(level),
                            brightness);
        if (best_cost < 0) state.num_visible = residuals_.numVisible();
        if (residuals_.numVisible() < options_.min_points) break;
        if (best_cost >= 0 && residuals_.cost() > 1.2 * best_cost + 0.5)
            break;  // diverging; the best pose is kept
        if (best_cost < 0 || residuals_.cost() <= best_cost * 1.02) {
            best_cost = best_cost < 0 ? residuals_.cost() : std::min(best_cost, residuals_.cost());
            state.T_current_keyframe = pose;
            state.brightness = brightness;
            state.num_visible = residuals_.numVisible();
            state.residual = residuals_.scale();
        }
        kernels::NormalEquations equations;
        residuals_.accumulate(points, level, camera, 1, equations);
        PoseSystem system;
        system.add(equations);
        state.system = system;
        system.addPrior({pose, 0.2 * depth, 0.2}, pose);
        const Vector6d step = system.solve();
        brightness = residuals_.fitBrightness(points, level, brightness);
        pose = poseIncrement(step) * pose;
        const double motion_px = camera.fx * (step.tail<3>().norm() + step.head<3>().norm() / depth);
        if (motion_px < 0.01 && iteration > 0) break;
    }
    return best_cost;
}

std::vector<std::size_t> CoarseTracker::mostSimilar(const Keyframe& keyframe, const cv::Mat& image, int level,
                                                    const PinholeCamera& camera,
                                                    const std::vector<Pose>& guesses,
                                                    const Brightness& brightness) {
    constexpr std::size_t kTried = 6;
    std::vector<std::size_t> order(guesses.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    if (guesses.size() <= kTried) return order;
    std::vector<double> cost;
    for (const Pose& guess : guesses) {
        residuals_.evaluate(keyframe.photometric, level, image, camera, guess, RowMotion(), brightness);
        // A guess that puts most points outside the image is no good however well the rest fits
        const double visible = residuals_.numVisible() / static_cast<double>(keyframe.photometric.size());
        cost.push_back(residuals_.cost() / std::max(0.1, std::min(1.0, 2 * visible)));
    }
    std::stable_sort(order.begin(), order.end(),
                     [&](std::size_t a, std::size_t b) { return cost[a] < cost[b]; });
    order.resize(kTried);
    return order;
}

CoarseResult CoarseTracker::track(const Keyframe& keyframe, const ImagePyramid& pyramid,
                                  const PinholeCamera& camera, const RollingShutter& shutter,
                                  const std::vector<Pose>& guesses, const Brightness& start) {
    CoarseResult best;
    best.T_current_keyframe = guesses.front();
    best.brightness = start;
    if (static_cast<int>(keyframe.photometric.size()) < options_.min_points) return best;
    const int levels = std::min(pyramid.numLevels(), static_cast<int>(keyframe.photometric.patches.size()));
    // The coarsest level on which any guess sees enough points decides between the guesses; finer ones refine
    double best_cost = -1;
    for (int level = levels - 1; level >= 0; --level) {
        const PinholeCamera scaled = camera.atPyramidLevel(level);
        const cv::Mat& image = pyramid.level(level);
        if (best_cost >= 0) {
            if (alignLevel(keyframe, image, level, scaled, shutter, best) < 0 && level == 0) return best;
            continue;
        }
        for (const std::size_t i : mostSimilar(keyframe, image, level, scaled, guesses, start)) {
            CoarseResult state;
            state.T_current_keyframe = guesses[i];
            state.brightness = start;
            const double cost = alignLevel(keyframe, image, level, scaled, shutter, state);
            if (best_cost < 0) best.num_visible = std::max(best.num_visible, state.num_visible);
            if (cost >= 0 && (best_cost < 0 || cost < 0.95 * best_cost)) {
                best = state;
                best_cost = cost;
            }
        }
    }
    if (best_cost < 0) return best;
    best.converged = best.num_visible >= options_.min_points && best.T_current_keyframe.isFinite();
    return best;
}

}  // namespace roevo
