#pragma once
#include <vector>

#include "tracking/gauss_newton.h"
#include "tracking/keyframe.h"

namespace roevo {

struct CoarseResult {
    bool converged = false;
    Pose T_current_keyframe = Pose::Identity();
    Brightness brightness;
    int num_visible = 0;
};

/// Photometric alignment of the keyframe's edge patches over an image pyramid, Eqs. (2), (3).
class CoarseTracker {
  public:
    explicit CoarseTracker(const CoarseOptions& options) : options_(options) {}

    /// @param camera   ideal camera of level 0
    /// @param guesses  start poses T_current_keyframe, the most trusted first; the best after the coarsest
    /// level goes on
    /// @param finest   the last level, where there are as many
    CoarseResult track(const Keyframe& keyframe, const ImagePyramid& pyramid, const PinholeCamera& camera,
                       const RollingShutter& shutter, const std::vector<Pose>& guesses,
                       const Brightness& start, int finest = 0);

  private:
    /// Indices of the guesses worth aligning.
    std::vector<std::size_t> mostSimilar(const Keyframe& keyframe, const cv::Mat& image, int level,
                                         const PinholeCamera& camera, const std::vector<Pose>& guesses,
                                         const Brightness& brightness);
    double alignLevel(const Keyframe& keyframe, const cv::Mat& image, int level, const PinholeCamera& camera,
                      const RollingShutter& shutter, CoarseResult& state);

    CoarseOptions options_;
    PhotometricTerm photometric_;
};

}  // namespace roevo
