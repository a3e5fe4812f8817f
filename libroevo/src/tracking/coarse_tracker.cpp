#include "tracking/coarse_tracker.h"

#include <algorithm>
#include <numeric>

#include "tracking/se3.h"

namespace roevo {
namespace {

constexpr double kDampingTranslation = 0.2;  ///< one sigma of a step, as a share of the depth
constexpr double kDampingRotation = 0.2;     ///< rad
constexpr double kCoarseStill = 0.05;        ///< px of a level that finer ones follow: a small step there
constexpr double kSameGuess = 0.5;           ///< px of the level: guesses so near end up at the same pose

}  // namespace

double CoarseTracker::alignLevel(const Keyframe& keyframe, const cv::Mat& image, int level,
                                 const PinholeCamera& camera, const RollingShutter& shutter,
                                 CoarseResult& state) {
    const double depth = keyframe.typicalDepth();
    photometric_.start(keyframe.photometric, level, image, camera, state.brightness);
    photometric_.require(options_.min_points);
    DampingTerm damping(kDampingTranslation * depth, kDampingRotation);
    GaussNewtonOptions loop{options_.max_iterations + 1, camera.fx, depth};
    loop.keep_best = true;
    if (level > 0) loop.still = kCoarseStill;
    const GaussNewtonResult found =
        minimise(state.T_current_keyframe, shutter, {&photometric_, &damping}, loop);
    state.T_current_keyframe = found.T_current_keyframe;
    state.brightness = photometric_.bestBrightness();
    state.num_visible = photometric_.bestVisible();
    return found.cost;
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
    photometric_.start(keyframe.photometric, level, image, camera, brightness);
    for (const Pose& guess : guesses) {
        photometric_.evaluate(guess, RowMotion());
        // A guess that puts most points outside the image is no good however well the rest fits
        const double visible = photometric_.numVisible() / static_cast<double>(keyframe.photometric.size());
        cost.push_back(photometric_.cost() / std::max(0.1, std::min(1.0, 2 * visible)));
    }
    std::stable_sort(order.begin(), order.end(),
                     [&](std::size_t a, std::size_t b) { return cost[a] < cost[b]; });
    order.resize(kTried);
    return order;
}

CoarseResult CoarseTracker::track(const Keyframe& keyframe, const ImagePyramid& pyramid,
                                  const PinholeCamera& camera, const RollingShutter& shutter,
                                  const std::vector<Pose>& guesses, const Brightness& start, int finest) {
    CoarseResult best{false, guesses.front(), start};
    if (static_cast<int>(keyframe.photometric.size()) < options_.min_points) return best;
    const int levels = std::min(pyramid.numLevels(), static_cast<int>(keyframe.photometric.patches.size()));
    // The coarsest level on which any guess sees enough points decides between the guesses; finer ones refine
    double best_cost = -1;
    std::size_t best_guess = 0;
    finest = std::min(finest, levels - 1);
    for (int level = levels - 1; level >= finest; --level) {
        const PinholeCamera scaled = camera.atPyramidLevel(level);
        const cv::Mat& image = pyramid.level(level);
        if (best_cost >= 0) {
            if (alignLevel(keyframe, image, level, scaled, shutter, best) < 0 && level == finest) return best;
            continue;
        }
        for (const std::size_t i : mostSimilar(keyframe, image, level, scaled, guesses, start)) {
            if (best_cost >= 0 &&
                imageMotion(guesses[best_guess], guesses[i], scaled.fx, keyframe.typicalDepth()) < kSameGuess)
                continue;
            CoarseResult state{false, guesses[i], start};
            const double cost = alignLevel(keyframe, image, level, scaled, shutter, state);
            if (best_cost < 0) best.num_visible = std::max(best.num_visible, state.num_visible);
            if (cost >= 0 && (best_cost < 0 || cost < 0.95 * best_cost)) {
                best = state;
                best_cost = cost;
                best_guess = i;
            }
        }
    }
    if (best_cost < 0) return best;
    best.converged = best.num_visible >= options_.min_points && best.T_current_keyframe.isFinite();
    return best;
}

}  // namespace roevo
