#include "edges/edge_sides.h"

#include <algorithm>
#include <cmath>

#include "kernels/kernels.h"
#include "nearest.h"

namespace roevo {
namespace {

// Pixels and points are those of a 640x480 Kinect
constexpr double kReach = 4;              ///< px to each side
constexpr double kFurther = 8;            ///< px, where the other side is background
constexpr double kClear = 0.6;            ///< px; nearer samples may show either side
constexpr double kMostlyBehind = 0.5;     ///< share of a side's samples that makes it background
constexpr std::size_t kEvery = 2;         ///< neighbours pass much the same pixels: every other one is asked
constexpr double kMinSeen = 3;            ///< samples that can tell
constexpr double kAgree = 2;              ///< sigmas of the shorter line
constexpr double kWindow = 20;            ///< points before and after that help
constexpr double kLeast = 4;              ///< of them at an end of the edge
constexpr double kMinSamples = 6;         ///< of a side
constexpr double kCorrelated = 2;         ///< neighbouring depths err together: this many tell as much as one
constexpr double kLeastVariance = 1e-10;  ///< relative: 1e-5 of the depth
/// Squared standard errors at which a correction counts half. 1 to 4 are about as good.
constexpr double kDoubt = 2;

/// What the normals of an edge's points pass on one side.
struct Side {
    kernels::SideSums close;  ///< near the edge
    kernels::SideSums wide;   ///< further out too, where the other side is background
};
struct Strip {
    Side plus, minus;  ///< along the normal, and against it
};
/// Where a side's line meets the edge, and the variance of that.
struct Meeting {
    bool known = false;
    double value = 0, variance = 0;
};

/// How much of an estimate to believe.
double belief(double value, double variance) {
    return value * value / (value * value + kDoubt * variance);
}

/// Whether what was added to a side's sums is background, if it is of at least this weight.
bool isBackground(const kernels::SideSums& from, const kernels::SideSums& to, double least) {
    const double seen = to.seen - from.seen, behind = to.behind - from.behind;
    return seen >= least && behind > kMostlyBehind * seen;
}

void sample(const kernels::DepthView& depth, const kernels::EdgePoint& at, float jump, double scale,
            Strip& sums) {
    const bool by_column = std::abs(at.normal_x) >= std::abs(at.normal_y);
    const double run = std::abs(by_column ? at.normal_x : at.normal_y);
    const int centre = nearestInteger(by_column ? at.x : at.y);
    const auto look = [&](bool along, double reach, double widening, kernels::SideSums& side) {
        const int steps = nearestInteger(scale * reach * run);
        kernels::best().side(depth, at, {by_column, centre, steps, along, scale * kClear, jump, widening},
                             side);
    };
    const kernels::SideSums minus_before = sums.minus.close, plus_before = sums.plus.close;
    look(true, kReach, 0, sums.plus.close);
    look(false, kReach, 0, sums.minus.close);
    const bool plus = isBackground(minus_before, sums.minus.close, 1),
               minus = isBackground(plus_before, sums.plus.close, 1);
    // One side alone. A surface that recedes leaves the jump further out
    if (plus != minus) look(plus, kFurther, scale * kReach, plus ? sums.plus.wide : sums.minus.wide);
}

Meeting fit(const kernels::SideSums& from, const kernels::SideSums& to) {
    const double count = to.count - from.count, s = to.s - from.s, q = to.q - from.q;
    if (count < kMinSamples) return {};
    const double mean_s = s / count, mean_q = q / count;
    const double ss = (to.ss - from.ss) - s * mean_s, sq = (to.sq - from.sq) - s * mean_q,
                 qq = (to.qq - from.qq) - q * mean_q;
    if (ss < 0.1 * count) return {};
    const double slope = sq / ss;
    const double variance = kCorrelated * std::max(0.0, qq - slope * sq) / (count - 2) + kLeastVariance;
    return {true, mean_q - slope * mean_s, variance * (1 / count + mean_s * mean_s / ss)};
}

double correctionByBoth(const Meeting& plus, const Meeting& minus) {
    // Without depth on the other side, nothing tells whether this one ends here
    if (!plus.known || !minus.known) return 0;
    const double variance = plus.variance + minus.variance;
    const double bend = (plus.value * minus.variance + minus.value * plus.variance) / variance;
    const double bend_belief = belief(bend, plus.variance * minus.variance / variance);
    const double step_belief = belief(plus.value - minus.value, variance);
    const double nearer = std::max(plus.value, minus.value);
    return step_belief * nearer + (1 - step_belief) * bend_belief * bend;
}

double correctionByOne(const Side& from, const Side& to) {
    const Meeting close = fit(from.close, to.close);
    if (!close.known) return 0;
    const Meeting wide = fit(from.wide, to.wide);
    const double apart = wide.value - close.value;
    const bool agree = wide.known && apart * apart <= kAgree * kAgree * close.variance;
    const Meeting& best = agree ? wide : close;
    return best.value * belief(best.value, best.variance);
}

double correction(const Strip& from, const Strip& to) {
    const bool plus = isBackground(from.minus.close, to.minus.close, kMinSeen),
               minus = isBackground(from.plus.close, to.plus.close, kMinSeen);
    if (plus != minus)
        return plus ? correctionByOne(from.plus, to.plus) : correctionByOne(from.minus, to.minus);
    return correctionByBoth(fit(from.plus.close, to.plus.close), fit(from.minus.close, to.minus.close));
}

}  // namespace

void correctBySides(const OrganizedEdges& edges, std::size_t first,
                    const std::vector<Eigen::Vector2d>& positions, const cv::Mat& depth, float jump,
                    double scale, std::vector<float>& z) {
    const std::size_t count = positions.size();
    const kernels::DepthView view{depth.ptr<float>(), static_cast<std::ptrdiff_t>(depth.step1()), depth.cols,
                                  depth.rows};
    std::vector<Strip> strips;  // of all points before a point
    strips.reserve(count + 1);
    strips.emplace_back();
    for (std::size_t k = 0; k < count; ++k) {
        strips.push_back(strips.back());
        if (k % kEvery != 0 || !(z[k] > 0)) continue;
        const kernels::EdgePoint point{positions[k].x(), positions[k].y(), edges.normal_x[first + k],
                                       edges.normal_y[first + k], z[k]};
        sample(view, point, jump, scale, strips.back());
    }
    const double most = jump;
    const auto window = static_cast<std::size_t>(std::lround(scale * kWindow));
    const auto least = static_cast<std::size_t>(std::lround(scale * kLeast));
    for (std::size_t k = 0; k < count; ++k) {
        if (!(z[k] > 0)) continue;
        // As many before as after, so that a depth that changes along the edge does not lean to one side
        const std::size_t reach = std::min({window, std::max(k, least), std::max(count - 1 - k, least)});
        const std::size_t from = k > reach ? k - reach : 0, to = std::min(count, k + reach + 1);
        const double value = std::clamp(correction(strips[from], strips[to]), -most, most);
        z[k] = static_cast<float>(z[k] / (1 + value));
    }
}

}  // namespace roevo
