#include "roevo/frame_result.h"

#include <algorithm>
#include <cmath>

namespace roevo {

const char* toString(FrameStatus status) {
    switch (status) {
        case FrameStatus::kOk:
            return "ok";
        case FrameStatus::kInitialised:
            return "initialised";
        case FrameStatus::kPredicted:
            return "predicted";
        case FrameStatus::kLost:
            return "lost";
        case FrameStatus::kRejected:
            return "rejected";
    }
    return "unknown";
}

double FrameResult::sigmaTranslation() const {
    return std::sqrt(std::max(0.0, covariance.topLeftCorner<3, 3>().trace()));
}

double FrameResult::sigmaRotationDeg() const {
    return std::sqrt(std::max(0.0, covariance.bottomRightCorner<3, 3>().trace())) / kDegree;
}

}  // namespace roevo
