#include "edges/edge_sides.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace roevo {
namespace {

// Pixels and points are those of a 640x480 Kinect
constexpr double kReach = 4;              ///< px to each side
constexpr double kFurther = 8;            ///< px, where the other side is background
constexpr double kClear = 0.6;            ///< px; nearer samples may show either side
constexpr double kMostlyBehind = 0.5;     ///< share of a side's samples that makes it background
constexpr double kMinSeen = 6;            ///< samples that can tell
constexpr double kAgree = 2;              ///< sigmas of the shorter line
constexpr double kWindow = 20;            ///< points before and after that help
constexpr double kLeast = 4;              ///< of them at an end of the edge
constexpr double kMinSamples = 12;        ///< of a side
constexpr double kCorrelated = 4;         ///< neighbouring depths err together: this many tell as much as one
constexpr double kLeastVariance = 1e-10;  ///< relative: 1e-5 of the depth
/// Squared standard errors at which a correction counts half. 1 to 4 are about as good.
constexpr double kDoubt = 2;

/// How much of an estimate to believe.
double belief(double value, double variance) {
    return value * value / (value * value + kDoubt * variance);
}

/// Calls take(signed distance from the edge, depth, weight) for the pixels with depth within `reach` along
/// the normal, but not for those next to the edge. Column by column (or row by row), between the two pixels
/// that the normal passes: where edges run along rows or columns, the nearest one would be off to the same
/// side all along.
template <typename Take>
void visit(const Eigen::Vector2d& pixel, const Eigen::Vector2d& normal, double reach, double clear,
           const cv::Mat& depth, const Take& take) {
    const bool by_column = std::abs(normal.x()) >= std::abs(normal.y());
    const int main = by_column ? 0 : 1, other = 1 - main;
    const double slope = normal[other] / normal[main];
    const int steps = static_cast<int>(std::lround(reach * std::abs(normal[main])));
    const int centre = static_cast<int>(std::lround(pixel[main]));
    const int size[2] = {depth.cols, depth.rows};
    const auto row = static_cast<std::ptrdiff_t>(depth.step1());
    const std::ptrdiff_t along = by_column ? 1 : row, across = by_column ? row : 1;
    const auto* depths = depth.ptr<float>();
    for (int i = std::max(0, centre - steps); i <= std::min(size[main] - 1, centre + steps); ++i) {
        const double j = pixel[other] + (i - pixel[main]) * slope;
        const int towards_zero = static_cast<int>(j), below = towards_zero - (towards_zero > j ? 1 : 0);
        for (int k = std::max(0, below); k <= std::min(size[other] - 1, below + 1); ++k) {
            const float there = depths[i * along + k * across];
            const double distance = normal[main] * (i - pixel[main]) + normal[other] * (k - pixel[other]);
            if (std::abs(distance) >= clear && there > 0 && there <= std::numeric_limits<float>::max())
                take(distance, there, 1 - std::abs(j - k));
        }
    }
}

}  // namespace

void EdgeSides::Sums::add(double distance, double value, double weight) {
    count += weight;
    s += weight * distance;
    q += weight * value;
    ss += weight * distance * distance;
    sq += weight * distance * value;
    qq += weight * value * value;
}

bool EdgeSides::Side::isBackground(double least) const {
    return seen >= least && behind > kMostlyBehind * seen;
}

void EdgeSides::sample(const Eigen::Vector2d& pixel, const Eigen::Vector2d& normal, float z,
                       const cv::Mat& depth, float jump, double scale, Strip& sums) {
    const Strip before = sums;
    visit(pixel, normal, scale * kReach, scale * kClear, depth,
          [&](double distance, float there, double weight) {
              Side& side = distance > 0 ? sums.plus : sums.minus;
              side.seen += weight;
              if (there - z > jump * z) side.behind += weight;
              if (std::abs(there - z) > jump * z) return;
              side.close.add(std::abs(distance), static_cast<double>(z / there) - 1, weight);
          });
    const Strip own = sums - before;
    const bool plus = own.minus.isBackground(1), minus = own.plus.isBackground(1);
    if (plus == minus) return;
    visit(pixel, normal, scale * kFurther, scale * kClear, depth,
          [&](double distance, float there, double weight) {
              const double away = plus ? distance : -distance;
              // A surface that recedes leaves the jump further out
              if (away < 0 ||
                  std::abs(there - z) > (1 + static_cast<float>(away / (scale * kReach))) * jump * z)
                  return;
              (plus ? sums.plus : sums.minus).wide.add(away, static_cast<double>(z / there) - 1, weight);
          });
}

EdgeSides::Meeting EdgeSides::fit(const Sums& sums) {
    if (sums.count < kMinSamples) return {};
    const double mean_s = sums.s / sums.count, mean_q = sums.q / sums.count;
    const double ss = sums.ss - sums.s * mean_s, sq = sums.sq - sums.s * mean_q,
                 qq = sums.qq - sums.q * mean_q;
    if (ss < 0.1 * sums.count) return {};
    const double slope = sq / ss;
    const double variance = kCorrelated * std::max(0.0, qq - slope * sq) / (sums.count - 2) + kLeastVariance;
    return {true, mean_q - slope * mean_s, variance * (1 / sums.count + mean_s * mean_s / ss)};
}

double EdgeSides::correction(const Meeting& plus, const Meeting& minus) {
    // Without depth on the other side, nothing tells whether this one ends here
    if (!plus.known || !minus.known) return 0;
    const double variance = plus.variance + minus.variance;
    const double bend = (plus.value * minus.variance + minus.value * plus.variance) / variance;
    const double bend_belief = belief(bend, plus.variance * minus.variance / variance);
    const double step_belief = belief(plus.value - minus.value, variance);
    const double nearer = std::max(plus.value, minus.value);
    return step_belief * nearer + (1 - step_belief) * bend_belief * bend;
}

double EdgeSides::correction(const Side& only) {
    const Meeting close = fit(only.close), wide = fit(only.wide);
    if (!close.known) return 0;
    const double apart = wide.value - close.value;
    const bool agree = wide.known && apart * apart <= kAgree * kAgree * close.variance;
    const Meeting& best = agree ? wide : close;
    return best.value * belief(best.value, best.variance);
}

double EdgeSides::correction(const Strip& strip) {
    const bool plus = strip.minus.isBackground(kMinSeen), minus = strip.plus.isBackground(kMinSeen);
    if (plus != minus) return correction(plus ? strip.plus : strip.minus);
    return correction(fit(strip.plus.close), fit(strip.minus.close));
}

void EdgeSides::correct(const OrganizedEdges& edges, std::size_t first,
                        const std::vector<Eigen::Vector2d>& pixels, const cv::Mat& depth, float jump,
                        double scale, std::vector<float>& z) {
    const std::size_t count = pixels.size();
    strips_.assign(count + 1, Strip());
    for (std::size_t k = 0; k < count; ++k) {
        strips_[k + 1] = strips_[k];
        const Eigen::Vector2d normal(edges.normal_x[first + k], edges.normal_y[first + k]);
        if (z[k] > 0) sample(pixels[k], normal, z[k], depth, jump, scale, strips_[k + 1]);
    }
    const auto most = static_cast<double>(jump);
    const auto window = static_cast<std::size_t>(std::lround(scale * kWindow));
    const auto least = static_cast<std::size_t>(std::lround(scale * kLeast));
    for (std::size_t k = 0; k < count; ++k) {
        if (!(z[k] > 0)) continue;
        // As many before as after, so that a depth that changes along the edge does not lean to one side
        const std::size_t reach = std::min({window, std::max(k, least), std::max(count - 1 - k, least)});
        const std::size_t from = k > reach ? k - reach : 0, to = std::min(count, k + reach + 1);
        const double value = std::clamp(correction(strips_[to] - strips_[from]), -most, most);
        z[k] = static_cast<float>(static_cast<double>(z[k]) / (1 + value));
    }
}

}  // namespace roevo
