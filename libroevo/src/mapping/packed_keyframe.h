#pragma once
#include <cstdint>
#include <tuple>
#include <vector>

#include "mapping/map_keyframe.h"
#include "roevo/camera/pinhole_camera.h"
#include "roevo/options.h"

namespace roevo {

/// Numbers in 16 bits each, in even steps from the smallest to the largest.
class QuantizedArray {
  public:
    QuantizedArray() = default;
    explicit QuantizedArray(const std::vector<float>& values);

    float at(std::size_t i) const { return first_ + step_ * static_cast<float>(steps_[i]); }
    /// Whether these are `count` numbers within limits.
    bool isWithin(float smallest, float largest, std::size_t count) const;
    /// What a file keeps of it.
    auto fields() { return std::tie(first_, step_, steps_); }

  private:
    float first_ = 0, step_ = 0;
    std::vector<std::uint16_t> steps_;
};

/// The points of a map keyframe in 11 bytes each instead of 43, for the many keyframes that are out of the
/// window: maps keep keyframes for ever. Steps are about 0.01 px in the image and, since it is inverse depth
/// that is kept, a small part of the sensor's noise at any depth.
class PackedKeyframe {
  public:
    PackedKeyframe() = default;
    explicit PackedKeyframe(const KeyframeEdges& edges);

    /// As they were, within half a step.
    KeyframeEdges unpacked(const PinholeCamera& camera, const SensorOptions& sensor) const;

    int numEdges() const { return begin_.empty() ? 0 : static_cast<int>(begin_.size()) - 1; }
    /// Whether this can be a keyframe of a camera; files can hold anything.
    bool isSound(const PinholeCamera& camera) const;
    /// What a file keeps of it.
    auto fields() { return std::tie(u_, v_, inverse_depth_, normal_angle_, colours_, begin_); }

  private:
    QuantizedArray u_, v_, inverse_depth_, normal_angle_;  // ideal px, 1/m, rad
    std::vector<Rgb> colours_;
    std::vector<std::int32_t> begin_;
};

}  // namespace roevo
