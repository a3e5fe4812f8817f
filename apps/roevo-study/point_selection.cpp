#include "point_selection.h"

#include <algorithm>
#include <cmath>

#include "edges/canny.h"
#include "edges/edge_depth.h"
#include "kernels/kernels.h"

namespace roevo {
namespace {

constexpr int kRegion = 32;            // px, side of the regions that have thresholds of their own
constexpr float kAboveMedian = 7 * 8;  // Sobel units: 7 grey levels per pixel
constexpr float kLowered = 0.75F;      // from one size of blocks to the next
constexpr int kBorder = EdgeMask::kBorder;

/// Median of the gradient magnitude of every region, plus kAboveMedian.
cv::Mat regionThresholds(const cv::Mat& magnitude) {
    const int rows = (magnitude.rows + kRegion - 1) / kRegion,
              columns = (magnitude.cols + kRegion - 1) / kRegion;
    cv::Mat thresholds(rows, columns, CV_32FC1);
    std::vector<float> values;
    for (int r = 0; r < rows; ++r) {
        for (int c = 0; c < columns; ++c) {
            values.clear();
            const int end_x = std::min(magnitude.cols, (c + 1) * kRegion);
            for (int y = r * kRegion; y < std::min(magnitude.rows, (r + 1) * kRegion); ++y) {
                const auto* row = magnitude.ptr<float>(y);
                values.insert(values.end(), row + c * kRegion, row + end_x);
            }
            const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
            std::nth_element(values.begin(), middle, values.end());
            thresholds.at<float>(r, c) = *middle + kAboveMedian;
        }
    }
    return thresholds;
}

/// The strongest pixels of one image.
class BlockSelector {
  public:
    explicit BlockSelector(const cv::Mat& magnitude)
        : magnitude_(magnitude), thresholds_(regionThresholds(magnitude)) {}

    std::vector<cv::Point> select(int side) const {
        std::vector<cv::Point> chosen;
        for (int y = 0; y < magnitude_.rows; y += 4 * side) {
            for (int x = 0; x < magnitude_.cols; x += 4 * side) selectIn(x, y, 4 * side, side, chosen);
        }
        return chosen;
    }

  private:
    /// Chooses in the smallest blocks of this one first, and in the whole where they hold nothing.
    bool selectIn(int x, int y, int size, int smallest, std::vector<cv::Point>& chosen) const {
        if (x >= magnitude_.cols || y >= magnitude_.rows) return false;
        bool any = false;
        if (size > smallest) {
            const int half = size / 2;
            for (const cv::Point corner : {cv::Point(x, y), cv::Point(x + half, y), cv::Point(x, y + half),
                                           cv::Point(x + half, y + half)}) {
                any = selectIn(corner.x, corner.y, half, smallest, chosen) || any;
            }
        }
        if (any) return true;
        const float share = size == smallest ? 1 : size == 2 * smallest ? kLowered : kLowered * kLowered;
        cv::Point best;
        float best_magnitude = 0;
        const int end_x = std::min(x + size, magnitude_.cols - kBorder);
        const int end_y = std::min(y + size, magnitude_.rows - kBorder);
        for (int v = std::max(y, kBorder); v < end_y; ++v) {
            const auto* magnitude = magnitude_.ptr<float>(v);
            const auto* threshold = thresholds_.ptr<float>(v / kRegion);
            for (int u = std::max(x, kBorder); u < end_x; ++u) {
                if (magnitude[u] <= best_magnitude || magnitude[u] <= share * threshold[u / kRegion])
                    continue;
                best = {u, v};
                best_magnitude = magnitude[u];
            }
        }
        if (best_magnitude > 0) chosen.push_back(best);
        return best_magnitude > 0;
    }

    const cv::Mat& magnitude_;
    cv::Mat thresholds_;
};

}  // namespace

std::vector<cv::Point> selectDsoPixels(const Gradient& gradient, int wanted) {
    const BlockSelector selector(gradient.magnitude);
    int low = 1, high = std::max(2, std::max(gradient.magnitude.cols, gradient.magnitude.rows));
    while (low < high) {  // the larger the blocks, the fewer they are
        const int side = (low + high) / 2;
        if (static_cast<int>(selector.select(side).size()) > wanted) {
            low = side + 1;
        } else {
            high = side;
        }
    }
    return selector.select(low);
}

std::vector<cv::Point> selectCannyPixels(const Gradient& gradient, const EdgeOptions& options) {
    EdgeMask mask;
    canny(gradient, cannyThresholds(gradient, options), mask);
    std::vector<std::int32_t> raster = mask.pixels;
    std::sort(raster.begin(), raster.end());
    std::vector<cv::Point> pixels;
    for (const std::int32_t p : raster) pixels.emplace_back(p % mask.mask.cols, p / mask.mask.cols);
    return pixels;
}

EdgePoints3D liftPixels(const std::vector<cv::Point>& pixels, const Gradient& gradient, const cv::Mat& depth,
                        const PinholeCamera& camera, const RowMotion& rows, const EdgeOptions& edge_options,
                        const SensorOptions& sensor) {
    const ForegroundDepth foreground(depth, edge_options, sensor);
    EdgePoints3D out;
    for (const cv::Point& pixel : pixels) {
        const Eigen::Vector2d raw = camera.distortPixel(Eigen::Vector2d(pixel.x, pixel.y));
        const float z = foreground.at(static_cast<float>(raw.x()), static_cast<float>(raw.y()));
        if (z == 0) continue;
        out.image.addPoint(static_cast<float>(pixel.x), static_cast<float>(pixel.y), 1, 0,
                           gradient.magnitude.at<float>(pixel) / 8);
        const Eigen::Vector3d p =
            rows.toReference(camera.backProject(pixel.x, pixel.y, static_cast<double>(z)), pixel.y);
        out.points.add(p);
        out.weight.push_back(static_cast<float>(depthWeight(p.z(), sensor)));
        out.correction.push_back(0);
    }
    out.image.finishEdge();
    out.points.pad();
    return out;
}

}  // namespace roevo
