#include <algorithm>
#include <cmath>
#include <cstdio>

#include "roevo/frame_result.h"

namespace roevo {

const char* toString(FrameStatus status) {
    constexpr const char* kNames[] = {"ok", "initialised", "predicted", "lost", "rejected"};
    return kNames[static_cast<std::size_t>(status)];
}

double FrameResult::sigmaTranslation() const {
    return std::sqrt(std::max(0.0, covariance.topLeftCorner<3, 3>().trace()));
}

double FrameResult::sigmaRotationDeg() const {
    return std::sqrt(std::max(0.0, covariance.bottomRightCorner<3, 3>().trace())) / kDegree;
}

const char* toString(EdgeVerdict verdict) {
    constexpr const char* kNames[] = {"unconfirmed", "true", "pseudo: observations disagree",
                                      "pseudo: seen too rarely"};
    return kNames[static_cast<std::size_t>(verdict)];
}

const char* toString(MapRefusal::Kind kind) {
    return kind == MapRefusal::Kind::kFewObservations ? "left as it was, too few observations fit the map"
                                                      : "left as it was, bundle adjustment moved it too far";
}

std::string describe(const MapRefusal& refusal) {
    char detail[64];
    if (refusal.kind == MapRefusal::Kind::kFewObservations)
        std::snprintf(detail, sizeof detail, "%d", refusal.observations);
    else
        std::snprintf(detail, sizeof detail, "%.0f mm, %.1f deg", 1000 * refusal.moved, refusal.turned);
    return std::string(toString(refusal.kind)) + ": keyframe " + std::to_string(refusal.keyframe) + " (" +
           detail + ")";
}

}  // namespace roevo
