#include "evaluation/scale_check.h"

#include <Eigen/Geometry>
#include <cmath>
#include <cstdio>

namespace roevo {
namespace {

constexpr std::size_t kEnoughPairs = 30;
constexpr double kMinPath = 0.3;      // m, of the reference
constexpr double kMaxFactor = 1.5;    // tracking alone is never that wrong over a path of the same shape
constexpr double kMaxResidual = 0.3;  // of the reference's own spread: the share that is not explained

}  // namespace

std::string scaleContradiction(const std::vector<StampedPose>& reference,
                               const std::vector<StampedPose>& estimate, const std::vector<PosePair>& pairs) {
    if (pairs.size() < kEnoughPairs) return {};
    const auto count = static_cast<Eigen::Index>(pairs.size());
    Eigen::Matrix3Xd from(3, count), to(3, count);
    for (Eigen::Index i = 0; i < count; i++) {
        const PosePair& pair = pairs[static_cast<std::size_t>(i)];
        from.col(i) = estimate[pair.estimate].T_world_camera.translation();
        to.col(i) = reference[pair.reference].T_world_camera.translation();
    }
    if ((to.rightCols(count - 1) - to.leftCols(count - 1)).colwise().norm().sum() < kMinPath) return {};
    if ((from.colwise() - from.col(0)).isZero(0)) return {};  // never moved: no scale makes it fit
    const Eigen::Matrix4d T = Eigen::umeyama(from, to, true);
    const double scale = T.topLeftCorner<3, 3>().col(0).norm();
    if (!std::isfinite(scale) || (scale <= kMaxFactor && scale >= 1 / kMaxFactor)) return {};

    const Eigen::Matrix3Xd left =
        to - ((T.topLeftCorner<3, 3>() * from).colwise() + T.topRightCorner<3, 1>().eval());
    const double spread = (to.colwise() - to.rowwise().mean().eval()).norm();
    if (!(left.norm() <= kMaxResidual * spread)) return {};

    const double factor = scale > 1 ? scale : 1 / scale;
    char text[256];
    std::snprintf(text, sizeof text,
                  "the ground truth's path is %.2g times as long as the estimate's: is the depth scale wrong "
                  "by %.2g (depths too %s)?",
                  scale, factor, scale > 1 ? "small" : "large");
    return text;
}

}  // namespace roevo
