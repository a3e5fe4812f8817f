#include "registration.h"

namespace roevo {

FineResult refinePose(const OdometryStages& stages, FineTracker& fine, const Keyframe& keyframe,
                      const FineFrame& frame, const CoarseResult& aligned, const PosePrior& prior,
                      const RollingShutter& shutter) {
    const Pose T_start = fine.betterStart(keyframe, frame, aligned.T_current_keyframe, prior.mean, shutter);
    if (!stages.registration) return fine.track(keyframe, frame, T_start, prior, shutter, aligned.brightness);
    const FineResult found =
        stages.registration(keyframe, frame, T_start, prior, shutter, aligned.brightness);
    const Pose& T_found = found.T_current_keyframe;
    FineResult result = fine.assess(keyframe, frame, T_found, shutter.motion(T_found));
    result.converged = result.converged && found.converged;
    result.covariance = found.covariance;
    return result;
}

}  // namespace roevo
