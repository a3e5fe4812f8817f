#include "sensor.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <opencv2/core.hpp>

#include "random.h"

namespace roevo::simulator {
namespace {

// The Kinect: focal length and baseline of its infrared camera and projector, disparity in steps of 1/8
// pixel, and sigma_z = 1.425e-3 z^2 m, all from K. Khoshelham and S. Oude Elberink, "Accuracy and Resolution
// of Kinect Depth Data for Indoor Mapping Applications", Sensors 12, 2012.
constexpr double kFocalLength = 580, kBaseline = 0.075, kDisparityStep = 1. / 8, kSigmaPerSquare = 1.425e-3;
// Lateral noise: C. V. Nguyen, S. Izadi, D. Lovell, "Modeling Kinect Sensor Noise for Improved 3D
// Reconstruction and Tracking", 3DIMPVT 2012, about 0.8 pixels.
constexpr double kLateralSigma = 0.8;
constexpr double kNearest = 0.5, kFarthest = 8.0;  // metres
constexpr double kGrazingStart = 72,
                 kGrazingEnd = 84;  // degrees from the normal: from never to always missing

enum Stream : uint64_t { kDisparity, kShiftX, kShiftY, kGrazing, kSpeckle, kImage };

/// Standard normal noise with a little correlation between neighbours, as that of sensors which match blocks.
cv::Mat correlatedNoise(const cv::Size& size, uint64_t key, Stream stream) {
    cv::Mat_<float> white(size.height + 2, size.width + 2), smooth(size);
    for (int row = 0; row < white.rows; ++row)
        for (int col = 0; col < white.cols; ++col)
            white(row, col) = static_cast<float>(gaussianOf(
                hashOf(key, stream, static_cast<uint64_t>(row) << 32 | static_cast<uint64_t>(col))));
    const float norm = 1 / 6.f;  // the weights 1 2 1 in both directions have a root sum of squares of 6
    for (int row = 0; row < size.height; ++row)
        for (int col = 0; col < size.width; ++col) {
            float sum = 0;
            for (int r = 0; r < 3; ++r) {
                const float* w = &white(row + r, col);
                sum += static_cast<float>(r == 1 ? 2 : 1) * (w[0] + 2 * w[1] + w[2]);
            }
            smooth(row, col) = norm * sum;
        }
    return smooth;
}

/// Clears what the projector, which sits to the right of the camera, cannot reach: a point is in shadow when
/// another one further right in its row is seen from the projector in the same direction or further left.
void clearProjectorShadow(const cv::Mat& exact, cv::Mat& depth, double focal_length) {
    for (int row = 0; row < exact.rows; ++row) {
        double leftmost = 1e9;
        for (int col = exact.cols - 1; col >= 0; --col) {
            const float z = exact.at<float>(row, col);
            if (z <= 0) continue;
            const double from_projector = col - focal_length * kBaseline / z;
            if (from_projector > leftmost + 0.75) depth.at<float>(row, col) = 0;
            leftmost = std::min(leftmost, from_projector);
        }
    }
}

void clearGrazingAndRange(const cv::Mat& exact, cv::Mat& depth, const PinholeCamera& camera, uint64_t key) {
    constexpr double kDegree = 3.14159265358979 / 180;
    const auto point = [&](int row, int col) {
        return camera.backProject(col, row, exact.at<float>(row, col));
    };
    for (int row = 0; row < exact.rows; ++row) {
        for (int col = 0; col < exact.cols; ++col) {
            const float z = exact.at<float>(row, col);
            float& out = depth.at<float>(row, col);
            if (z < kNearest || z > kFarthest) out = 0;
            if (out <= 0 || row == 0 || col == 0 || row + 1 == exact.rows || col + 1 == exact.cols) continue;
            const auto index = static_cast<uint64_t>(row) << 32 | static_cast<uint64_t>(col);
            const Eigen::Vector3d here = point(row, col);
            const Eigen::Vector3d across = point(row, col + 1) - point(row, col - 1),
                                  down = point(row + 1, col) - point(row - 1, col);
            const double jump = std::max(std::abs(across.z()), std::abs(down.z()));
            if (jump > 0.1 * z) {  // borders lose pixels at random
                if (uniformOf(hashOf(key, kSpeckle, index)) < 0.3) out = 0;
                continue;
            }
            const double cosine = std::abs(across.cross(down).normalized().dot(here.normalized()));
            const double start = std::cos(kGrazingStart * kDegree), end = std::cos(kGrazingEnd * kDegree);
            const double missing = (start - cosine) / (start - end);
            if (missing > 0 && uniformOf(hashOf(key, kGrazing, index)) < missing) out = 0;
        }
    }
}

}  // namespace

cv::Mat measureDepth(const cv::Mat& exact, const PinholeCamera& camera, const SensorOptions& options,
                     uint64_t key) {
    cv::Mat depth = exact.clone();
    if (options.holes) {
        clearProjectorShadow(exact, depth, camera.fx);
        clearGrazingAndRange(exact, depth, camera, key);
    }
    if (options.noise <= 0) return depth;
    const cv::Mat_<float> noise = correlatedNoise(exact.size(), key, kDisparity);
    const cv::Mat_<float> shift_x = correlatedNoise(exact.size(), key, kShiftX),
                          shift_y = correlatedNoise(exact.size(), key, kShiftY);
    // What quantisation adds itself is taken off, so that both together have the published deviation.
    constexpr double kTotal = kFocalLength * kBaseline * kSigmaPerSquare;
    const double sigma = options.noise * std::sqrt(kTotal * kTotal - kDisparityStep * kDisparityStep / 12);
    const double lateral = options.noise * kLateralSigma;
    cv::Mat measured(exact.size(), CV_32FC1);
    for (int row = 0; row < exact.rows; ++row) {
        for (int col = 0; col < exact.cols; ++col) {
            // The look-up is shifted only where it matters, across borders; on a slope it would be depth
            // noise twice.
            const int from_row = std::clamp(row + static_cast<int>(std::lround(lateral * shift_y(row, col))),
                                            0, exact.rows - 1);
            const int from_col = std::clamp(col + static_cast<int>(std::lround(lateral * shift_x(row, col))),
                                            0, exact.cols - 1);
            float z = depth.at<float>(row, col);
            const float other = depth.at<float>(from_row, from_col);
            if (other <= 0 || z <= 0 || std::abs(other - z) > 0.03f * z) z = other;
            float& out = measured.at<float>(row, col) = 0;
            if (z <= 0) continue;
            const double disparity = kFocalLength * kBaseline / z + sigma * noise(row, col);
            const double stepped = std::round(disparity / kDisparityStep) * kDisparityStep;
            if (stepped > 0) out = static_cast<float>(kFocalLength * kBaseline / stepped);
        }
    }
    return measured;
}

void addImageNoise(cv::Mat& image, double sigma, uint64_t key) {
    for (int row = 0; row < image.rows; ++row) {
        auto* pixels = image.ptr<float>(row);
        for (int i = 0; i < 3 * image.cols; ++i)
            pixels[i] += static_cast<float>(
                sigma *
                gaussianOf(hashOf(key, kImage, static_cast<uint64_t>(row) << 32 | static_cast<uint64_t>(i))));
    }
}

}  // namespace roevo::simulator
