#include "mapping/packed_keyframe.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>

#include "tracking/edge_points.h"

namespace roevo {

QuantizedArray::QuantizedArray(const std::vector<float>& values) {
    constexpr float kMostSteps = std::numeric_limits<std::uint16_t>::max();
    if (values.empty()) return;
    const auto [smallest, largest] = std::minmax_element(values.begin(), values.end());
    first_ = *smallest;
    step_ = (*largest - *smallest) / kMostSteps;
    steps_.resize(values.size(), 0);
    if (step_ <= 0) return;
    for (std::size_t i = 0; i < values.size(); ++i)
        steps_[i] =
            static_cast<std::uint16_t>(std::min(std::round((values[i] - first_) / step_), kMostSteps));
}

PackedKeyframe::PackedKeyframe(const KeyframeEdges& edges)
    : u_(edges.image.x), v_(edges.image.y), colours_(edges.colours), begin_(edges.image.begin) {
    std::vector<float> values(edges.size());
    for (std::size_t i = 0; i < values.size(); ++i) values[i] = 1 / edges.points.z[i];
    inverse_depth_ = QuantizedArray(values);
    for (std::size_t i = 0; i < values.size(); ++i)
        values[i] = std::atan2(edges.image.normal_y[i], edges.image.normal_x[i]);
    normal_angle_ = QuantizedArray(values);
}

KeyframeEdges PackedKeyframe::unpacked(const PinholeCamera& camera, const SensorOptions& sensor) const {
    KeyframeEdges edges;
    const std::size_t size = colours_.size();
    OrganizedEdges& image = edges.image;
    for (auto* array : {&image.x, &image.y, &image.normal_x, &image.normal_y, &edges.weight})
        array->resize(size);
    for (std::size_t i = 0; i < size; ++i) {
        image.x[i] = u_.at(i);
        image.y[i] = v_.at(i);
        const float angle = normal_angle_.at(i), z = 1 / inverse_depth_.at(i);
        image.normal_x[i] = std::cos(angle);
        image.normal_y[i] = std::sin(angle);
        edges.points.add((image.x[i] - static_cast<float>(camera.cx)) / static_cast<float>(camera.fx) * z,
                         (image.y[i] - static_cast<float>(camera.cy)) / static_cast<float>(camera.fy) * z, z);
        edges.weight[i] = static_cast<float>(depthWeight(z, sensor));
    }
    edges.points.pad();
    image.begin = begin_;
    image.numberPoints();
    edges.colours = colours_;
    computeSlopes(edges);
    return edges;
}

bool QuantizedArray::isWithin(float smallest, float largest, std::size_t count) const {
    if (steps_.size() != count) return false;
    if (!(first_ >= smallest) || !(step_ >= 0)) return count == 0;
    return std::all_of(steps_.begin(), steps_.end(), [&](std::uint16_t steps) {
        return first_ + step_ * static_cast<float>(steps) <= largest;
    });
}

bool PackedKeyframe::isSound(const PinholeCamera& camera) const {
    constexpr float kNearest = 1e-3F, kFarthest = 1e3F, kMostAngle = 4;  // m, m, rad
    const std::size_t size = colours_.size();
    const auto width = static_cast<float>(camera.width), height = static_cast<float>(camera.height);
    const bool in_order =
        std::adjacent_find(begin_.begin(), begin_.end(), std::greater_equal<>()) == begin_.end();
    const bool covers =
        begin_.empty() ? size == 0 : begin_.front() == 0 && static_cast<std::size_t>(begin_.back()) == size;
    // Points that were moved with the rows may have left the image
    return in_order && covers && begin_.size() <= std::numeric_limits<std::uint16_t>::max() &&
           u_.isWithin(-width, 2 * width, size) && v_.isWithin(-height, 2 * height, size) &&
           inverse_depth_.isWithin(1 / kFarthest, 1 / kNearest, size) &&
           normal_angle_.isWithin(-kMostAngle, kMostAngle, size);
}

}  // namespace roevo
