#include "roevo/frame_result.h"

#include <algorithm>
#include <cmath>

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

}  // namespace roevo
