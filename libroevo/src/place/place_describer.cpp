#include "place/place_describer.h"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

#include "nearest.h"
#include "place/sampling_pattern.h"
#include "tracking/se3.h"

namespace roevo {
namespace {

// Pixels are those of a camera with f = 525 px (PinholeCamera::pixelScale())
constexpr double kPatchRadius = 0.15;                  ///< m
constexpr double kLeastRadius = 10, kMostRadius = 48;  ///< px; of what is far away or near
constexpr int kCornerWindow = 3;  ///< px to each side, that the second moments are taken over
constexpr int kCornerStep = 2;    ///< points of an edge from one that is looked at to the next
constexpr double kCellSize = 40;  ///< px, of the grid over the image
// Whether a point of a place is seen again
constexpr double kLeastInside = 0.5;  ///< radii of its patch, from the image's border
constexpr double kHidden = 0.9;       ///< of its depth; what is nearer hides it
constexpr int kAlikeBits = 96;        ///< that may differ; of anything else half of the 256 do

/// The smaller eigenvalue of the second moments of the image gradient about a pixel, in grey levels squared:
/// how well the place of the pixel is known in the worse direction, which is that of the edge. 0 at the
/// border.
float cornerStrength(const cv::Mat& grey, int u, int v) {
    constexpr int kMargin = kCornerWindow + 1;
    if (u < kMargin || v < kMargin || u >= grey.cols - kMargin || v >= grey.rows - kMargin) return 0;
    int xx = 0, xy = 0, yy = 0;
    for (int y = v - kCornerWindow; y <= v + kCornerWindow; ++y) {
        const auto *above = grey.ptr<std::uint8_t>(y - 1), *row = grey.ptr<std::uint8_t>(y),
                   *below = grey.ptr<std::uint8_t>(y + 1);
        for (int x = u - kCornerWindow; x <= u + kCornerWindow; ++x) {
            const int gx = row[x + 1] - row[x - 1], gy = below[x] - above[x];
            xx += gx * gx;
            xy += gx * gy;
            yy += gy * gy;
        }
    }
    const double mean = 0.5 * (xx + yy), difference = 0.5 * (xx - yy);
    return static_cast<float>(mean - std::hypot(difference, xy));
}

}  // namespace

PlacePoints PlaceDescriber::describe(const EdgePoints3D& edges, const cv::Mat& grey) {
    findCorners(edges.image, grey);
    chooseCorners(edges.image);
    cv::integral(grey, integral_, CV_32S);
    PlacePoints out;
    out.reserve(corners_.size());
    for (const Corner& corner : corners_) {
        const auto i = static_cast<std::size_t>(corner.point);
        const auto& [x, y, z] = edges.points;
        const float u = edges.image.x[i], v = edges.image.y[i];
        const Eigen::Vector2d normal(edges.image.normal_x[i], edges.image.normal_y[i]);
        out.push_back({x[i], y[i], z[i], u, v, static_cast<float>(std::atan2(normal.y(), normal.x())),
                       describePatch({u, v}, normal, patchRadius(z[i]))});
    }
    return out;
}

double PlaceDescriber::patchRadius(double depth) const {
    const double scale = camera_.pixelScale();
    return std::clamp(camera_.fx * kPatchRadius / depth, kLeastRadius * scale, kMostRadius * scale);
}

Likeness PlaceDescriber::compare(const PlacePoints& place, const Pose& T_frame_place, const cv::Mat& grey,
                                 const RgbdFrame& images) {
    const cv::Mat &depth = images.depth, &mask = images.mask;
    cv::integral(grey, integral_, CV_32S);
    const double roll = rollOf(T_frame_place);
    Likeness out;
    for (const PlacePoint& point : place) {
        const Eigen::Vector3d p = T_frame_place * Eigen::Vector3d(point.x, point.y, point.z);
        if (p.z() <= 0) continue;
        const Eigen::Vector2d pixel = camera_.project(p);
        const double radius = patchRadius(p.z()), inside = kLeastInside * radius;
        if (!(pixel.minCoeff() >= inside && pixel.x() < camera_.width - inside &&
              pixel.y() < camera_.height - inside))
            continue;
        const Eigen::Vector2d seen = lens_.distortPixel(pixel);
        const int u = std::clamp(nearestInteger(seen.x()), 0, depth.cols - 1),
                  v = std::clamp(nearestInteger(seen.y()), 0, depth.rows - 1);
        const double there = depth.at<float>(v, u);
        if (there > 0 && there < kHidden * p.z()) continue;
        if (!mask.empty() && mask.at<std::uint8_t>(v, u) == 0) continue;
        ++out.visible;
        const double angle = point.normal_angle + roll;
        const Descriptor found = describePatch(pixel, {std::cos(angle), std::sin(angle)}, radius);
        if (hammingDistance(found, point.descriptor) <= kAlikeBits) ++out.alike;
    }
    return out;
}

void PlaceDescriber::findCorners(const OrganizedEdges& edges, const cv::Mat& grey) {
    corners_.clear();
    std::vector<float> strengths;  // of points of one edge
    for (int e = 0; e < edges.numEdges(); ++e) {
        const auto [first, end] = edges.pointsOf(e);
        strengths.clear();
        for (std::size_t i = first; i < end; i += kCornerStep) {
            strengths.push_back(cornerStrength(grey, nearestInteger(edges.x[i]), nearestInteger(edges.y[i])));
        }
        const int count = static_cast<int>(strengths.size());
        for (int k = 0; k < count; ++k) {
            const float own = at(strengths, k);
            // Those that are more distinct than the ones before and after; of equal ones the first
            if (own > 0 && (k == 0 || at(strengths, k - 1) < own) &&
                (k + 1 == count || at(strengths, k + 1) <= own))
                corners_.push_back({static_cast<std::int32_t>(first) + k * kCornerStep, own, 0});
        }
    }
}

void PlaceDescriber::chooseCorners(const OrganizedEdges& edges) {
    const double cell = kCellSize * camera_.pixelScale();
    const int columns = static_cast<int>(camera_.width / cell) + 1,
              rows = static_cast<int>(camera_.height / cell) + 1;
    std::vector<std::int32_t> corners_of_cell(static_cast<std::size_t>(columns * rows), 0);
    const auto stronger = [](const Corner& a, const Corner& b) {
        return a.strength != b.strength ? a.strength > b.strength : a.point < b.point;
    };
    std::sort(corners_.begin(), corners_.end(), stronger);
    for (Corner& corner : corners_) {
        const auto i = static_cast<std::size_t>(corner.point);
        const int column = std::clamp(static_cast<int>(edges.x[i] / cell), 0, columns - 1);
        const int row = std::clamp(static_cast<int>(edges.y[i] / cell), 0, rows - 1);
        corner.rank = at(corners_of_cell, row * columns + column)++;
    }
    std::sort(corners_.begin(), corners_.end(), [&](const Corner& a, const Corner& b) {
        return a.rank != b.rank ? a.rank < b.rank : stronger(a, b);
    });
    if (corners_.size() > kMaxPlacePoints) corners_.erase(corners_.begin() + kMaxPlacePoints, corners_.end());
}

float PlaceDescriber::boxMean(const Eigen::Vector2d& centre, double half_width) const {
    const int columns = integral_.cols - 1, rows = integral_.rows - 1;
    const auto first = [&](double at, int size) {
        return std::clamp(nearestInteger(at - half_width), 0, size - 1);
    };
    const auto end = [&](double at, int begin, int size) {
        return std::clamp(nearestInteger(at + half_width) + 1, begin + 1, size);
    };
    const int left = first(centre.x(), columns), right = end(centre.x(), left, columns);
    const int top = first(centre.y(), rows), bottom = end(centre.y(), top, rows);
    const auto *above = integral_.ptr<std::int32_t>(top), *below = integral_.ptr<std::int32_t>(bottom);
    const int sum = below[right] - below[left] - above[right] + above[left];
    return static_cast<float>(sum) / static_cast<float>((right - left) * (bottom - top));
}

Descriptor PlaceDescriber::describePatch(const Eigen::Vector2d& centre, const Eigen::Vector2d& normal,
                                         double radius) const {
    const SamplingPattern& pattern = samplingPattern();
    const Eigen::Vector2d along(-normal.y(), normal.x());
    std::array<float, SamplingPattern::kSites> grey{};
    for (std::size_t s = 0; s < grey.size(); ++s) {
        const SamplingPattern::Site& site = pattern.sites[s];
        grey[s] = boxMean(centre + radius * (static_cast<double>(site.along_normal) * normal +
                                             static_cast<double>(site.along_edge) * along),
                          radius * site.half_width);
    }
    Descriptor descriptor;
    for (std::size_t k = 0; k < pattern.comparisons.size(); ++k) {
        const SamplingPattern::Comparison& pair = pattern.comparisons[k];
        if (grey[pair.first] > grey[pair.second]) descriptor.words[k / 64] |= std::uint64_t{1} << (k % 64);
    }
    return descriptor;
}

}  // namespace roevo
