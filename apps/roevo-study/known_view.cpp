#include "known_view.h"

#include <cmath>

namespace roevo {
namespace {

constexpr double kSameDepth = 0.1;    // share of it
constexpr std::size_t kEveryNth = 3;  // of the frames before: neighbours see the same

}  // namespace

KnownViews::KnownViews(const StudyInput& input) : camera_(input.camera.undistorted()) {
    const auto source = input.open();
    for (SourceFrame frame; source->next(frame);) {
        times_.push_back(frame.timestamp);
        views_.emplace_back();
        const auto pose = poseAt(input.ground_truth, frame.timestamp);
        const cv::Mat& depth = frame.frame.depth;
        if (!pose || depth.empty()) continue;
        View& view = views_.back();
        view.T_world_camera = *pose;
        for (int row = 0; row < kRows; ++row)
            for (int column = 0; column < kColumns; ++column)
                view.depth.push_back(depth.at<float>((2 * row + 1) * depth.rows / (2 * kRows),
                                                     (2 * column + 1) * depth.cols / (2 * kColumns)));
    }
}

bool KnownViews::sees(const View& view, const Eigen::Vector3d& point) const {
    if (view.depth.empty() || !(point.z() > 0)) return false;
    const Eigen::Vector2d pixel = camera_.project(point);
    const int column = static_cast<int>(std::floor(pixel.x() * kColumns / camera_.width));
    const int row = static_cast<int>(std::floor(pixel.y() * kRows / camera_.height));
    if (column < 0 || column >= kColumns || row < 0 || row >= kRows) return false;
    const auto depth = static_cast<double>(view.depth[static_cast<std::size_t>(row * kColumns + column)]);
    return std::abs(depth - point.z()) < kSameDepth * point.z();
}

double KnownViews::knownShare(std::size_t frame, std::size_t before) const {
    const View& now = views_.at(frame);
    std::size_t points = 0, known = 0;
    for (std::size_t cell = 0; cell < now.depth.size(); ++cell) {
        const auto z = static_cast<double>(now.depth[cell]);
        if (!(z > 0)) continue;
        const double u = (static_cast<double>(cell % kColumns) + 0.5) * camera_.width / kColumns;
        const double v = (static_cast<double>(cell / kColumns) + 0.5) * camera_.height / kRows;
        const Eigen::Vector3d in_world = now.T_world_camera * camera_.backProject(u, v, z);
        ++points;
        for (std::size_t k = 0; k < before; k += kEveryNth)
            if (sees(views_[k], views_[k].T_world_camera.inverse() * in_world)) {
                ++known;
                break;
            }
    }
    return points == 0 ? 0 : static_cast<double>(known) / static_cast<double>(points);
}

}  // namespace roevo
