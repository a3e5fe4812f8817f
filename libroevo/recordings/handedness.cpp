#include "recordings/handedness.h"

#include <algorithm>
#include <cmath>
#include <opencv2/core.hpp>
#include <stdexcept>

#include "roevo_mrpt/image_conversions.h"

namespace roevo {
namespace {

constexpr std::size_t kMaxPairs = 8;
constexpr int kMinPairs = 3;
constexpr double kMaxTurn = 25 * kDegree, kMaxMove = 0.6;  // rad and m: frames must still overlap
constexpr double kLookDistance = 2;                        // m, where motions are compared
constexpr double kMinDifference = 0.005;                   // m, between the two motions there
constexpr double kCut = 0.1;                               // relative error that counts as a miss
constexpr double kClearRatio = 0.9;  // of the errors of the better and the worse version
constexpr double kClearSpread = 1;   // of the gain from pair to pair, in units of its mean
constexpr int kColumns = 80;         // points per row

Pose mirrored(const Pose& pose) {
    const Eigen::Vector3d mirror(1, -1, 1);
    const Eigen::Matrix3d rotation = mirror.asDiagonal() * pose.linear() * mirror.asDiagonal();
    return {Eigen::Quaterniond(rotation), mirror.cwiseProduct(pose.translation())};
}

struct PosedFrame {
    std::size_t index = 0;  ///< in the dataset
    Pose T_world_camera;
};

std::vector<PosedFrame> posedFrames(const DatasetDescription& dataset) {
    constexpr double kSameTime = 1e-4;  // s
    std::vector<PosedFrame> out;
    const auto& poses = dataset.ground_truth.poses;
    for (std::size_t i = 0; i < dataset.frames.size(); i++) {
        const double t = dataset.frames[i].timestamp;
        const auto pose =
            std::lower_bound(poses.begin(), poses.end(), t - kSameTime,
                             [](const StampedPose& p, double time) { return p.timestamp < time; });
        if (pose != poses.end() && pose->timestamp <= t + kSameTime) out.push_back({i, pose->T_world_camera});
    }
    return out;
}

struct Pair {
    double difference = 0;  ///< m, between what the two versions say about a point ahead
    std::size_t from = 0, to = 0;
    Pose T_to_from = Pose::Identity();
};

double differenceOfVersions(const Pose& motion) {
    const Eigen::Vector3d ahead(0, 0, kLookDistance);
    return (motion * ahead - mirrored(motion) * ahead).norm();
}

/// The pairs on which the two versions differ most, no frame used twice as a start.
std::vector<Pair> tellingPairs(const std::vector<PosedFrame>& frames) {
    std::vector<Pair> best;
    for (std::size_t i = 0; i < frames.size(); i++) {
        Pair of_frame;
        for (const std::size_t step : {1, 2, 4, 8, 16, 32}) {
            if (i + step >= frames.size()) break;
            const Pose motion = frames[i + step].T_world_camera.inverse() * frames[i].T_world_camera;
            if (Eigen::AngleAxisd(motion.linear()).angle() > kMaxTurn ||
                motion.translation().norm() > kMaxMove)
                continue;
            const double difference = differenceOfVersions(motion);
            if (difference > of_frame.difference)
                of_frame = {difference, frames[i].index, frames[i + step].index, motion};
        }
        if (of_frame.difference > kMinDifference) best.push_back(of_frame);
    }
    std::stable_sort(best.begin(), best.end(),
                     [](const Pair& a, const Pair& b) { return a.difference > b.difference; });
    best.resize(std::min(best.size(), kMaxPairs));
    return best;
}

/// Mean relative error, cut, of the depth that `from` predicts for `to`; 1 where they hardly overlap.
double predictionError(const cv::Mat& from, const cv::Mat& to, const PinholeCamera& camera,
                       const Pose& T_to_from) {
    double sum = 0;
    int count = 0, all = 0;
    const int step = std::max(1, camera.width / kColumns);
    for (int v = step / 2; v < from.rows; v += step)
        for (int u = step / 2; u < from.cols; u += step) {
            const double depth = from.at<float>(v, u);
            if (depth <= 0) continue;
            all++;
            const Eigen::Vector3d point = T_to_from * camera.backProject(u, v, depth);
            if (point.z() <= 0) continue;
            const Eigen::Vector2d pixel = camera.project(point);
            if (!(pixel.x() > 0 && pixel.x() < to.cols - 1 && pixel.y() > 0 && pixel.y() < to.rows - 1))
                continue;
            const double seen = to.at<float>(static_cast<int>(std::lround(pixel.y())),
                                             static_cast<int>(std::lround(pixel.x())));
            if (seen <= 0) continue;
            sum += std::min(kCut, std::abs(point.z() - seen) / seen);
            count++;
        }
    return 4 * count < all || count == 0 ? kCut : sum / count;
}

}  // namespace

void mirrorY(std::vector<StampedPose>& poses) {
    for (StampedPose& pose : poses) pose.T_world_camera = mirrored(pose.T_world_camera);
}

HandednessResult compareHandedness(const DatasetDescription& dataset) {
    HandednessResult result;
    int count = 0;
    double squares = 0;
    for (const Pair& pair : tellingPairs(posedFrames(dataset))) {
        cv::Mat from, to;
        try {
            const float unit = depthUnit(dataset.depth_scale);
            from = depthToMetres(readDepthFile(dataset.frames[pair.from].depth), unit);
            to = depthToMetres(readDepthFile(dataset.frames[pair.to].depth), unit);
        } catch (const std::runtime_error&) {
            continue;  // reported when the frame is read
        }
        const double as_is = predictionError(from, to, dataset.camera, pair.T_to_from);
        const double mirror = predictionError(from, to, dataset.camera, mirrored(pair.T_to_from));
        result.error_as_is += as_is;
        result.error_mirrored += mirror;
        squares += (as_is - mirror) * (as_is - mirror);
        count++;
    }
    if (count == 0) return result;
    result.error_as_is /= count;
    result.error_mirrored /= count;
    const double gain = std::abs(result.error_as_is - result.error_mirrored);
    const double spread = std::sqrt(std::max(0.0, squares / count - gain * gain));
    const double better = std::min(result.error_as_is, result.error_mirrored);
    const double worse = std::max(result.error_as_is, result.error_mirrored);
    // Noise and borders of objects miss in both versions; what tells is that one misses less in every pair
    result.decided = count >= kMinPairs && better < kClearRatio * worse && gain > kClearSpread * spread;
    if (result.decided) result.mirrored = result.error_mirrored < result.error_as_is;
    return result;
}

}  // namespace roevo
