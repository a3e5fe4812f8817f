#include "roevo/tracking/coarse_tracker.h"

#include <algorithm>
#include <cmath>
#include <utility>

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
        if (residuals_.numVisible() < std::min<int>(options_.min_points, static_cast<int>(points.size())))
            break;
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

std::vector<Pose> CoarseTracker::mostSimilar(const Keyframe& keyframe, const cv::Mat& image, int level,
                                             const PinholeCamera& camera, const std::vector<Pose>& guesses,
                                             const Brightness& brightness) {
    constexpr std::size_t kTried = 6;
    if (guesses.size() <= kTried) return guesses;
    std::vector<std::pair<double, std::size_t>> by_cost;
    for (std::size_t i = 0; i < guesses.size(); ++i) {
        residuals_.evaluate(keyframe.photometric, level, image, camera, guesses[i], RowMotion(), brightness);
        // A guess that puts most points outside the image is no good however well the rest fits
        const double visible = residuals_.numVisible() / static_cast<double>(keyframe.photometric.size());
        by_cost.emplace_back(residuals_.cost() / std::max(0.1, std::min(1.0, 2 * visible)), i);
    }
    std::sort(by_cost.begin(), by_cost.end());
    std::vector<Pose> chosen;
    for (std::size_t k = 0; k < kTried; ++k) chosen.push_back(guesses[by_cost[k].second]);
    return chosen;
}

CoarseResult CoarseTracker::track(const Keyframe& keyframe, const ImagePyramid& pyramid,
                                  const PinholeCamera& camera, const RollingShutter& shutter,
                                  const std::vector<Pose>& guesses, const Brightness& start) {
    CoarseResult best;
    best.T_current_keyframe = guesses.front();
    best.brightness = start;
    if (static_cast<int>(keyframe.photometric.size()) < options_.min_points) return best;
    const int levels = std::min(pyramid.numLevels(), static_cast<int>(keyframe.photometric.patches.size()));
    double best_cost = -1;
    const PinholeCamera coarsest = camera.atPyramidLevel(levels - 1);
    for (const Pose& guess :
         mostSimilar(keyframe, pyramid.level(levels - 1), levels - 1, coarsest, guesses, start)) {
        CoarseResult state;
        state.T_current_keyframe = guess;
        state.brightness = start;
        const double cost =
            alignLevel(keyframe, pyramid.level(levels - 1), levels - 1, coarsest, shutter, state);
        if (cost >= 0 && (best_cost < 0 || cost < 0.95 * best_cost)) {
            best = state;
            best_cost = cost;
        }
    }
    if (best_cost < 0) return best;
    for (int level = levels - 2; level >= 0; --level) {
        best_cost =
            alignLevel(keyframe, pyramid.level(level), level, camera.atPyramidLevel(level), shutter, best);
        if (best_cost < 0) return best;
    }
    best.converged = best.num_visible >= options_.min_points && best.T_current_keyframe.matrix().allFinite();
    orthonormalise(best.T_current_keyframe);
    return best;
}

}  // namespace roevo
