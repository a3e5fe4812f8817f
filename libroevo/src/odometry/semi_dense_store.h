#pragma once
#include <array>
#include <cstdint>
#include <tuple>
#include <utility>
#include <vector>

#include "mapping/semi_dense.h"
#include "roevo/camera/pinhole_camera.h"
#include "roevo/edge_map.h"
#include "roevo/frame_result.h"
#include "roevo/options.h"
#include "tracking/frame.h"
#include "tracking/rolling_shutter.h"

namespace roevo {

/// Coloured points of one camera, 10 bytes each: coordinates in steps of 1/32767 of the largest.
class PackedPoints {
  public:
    PackedPoints() = default;
    explicit PackedPoints(const std::vector<ColouredPoint>& points);

    std::size_t size() const { return points_.size(); }
    ColouredPoint at(std::size_t i) const;

    struct Packed {
        std::array<std::int16_t, 3> position;
        Rgb colour;
        auto fields() { return std::tie(position, colour); }
    };
    /// What a file keeps of it.
    auto fields() { return std::tie(step_, points_); }
    /// Whether these can be points that a camera saw; files can hold anything.
    bool isSound() const { return step_ >= 0 && step_ < 1; }

  private:
    float step_ = 0;  ///< m
    std::vector<Packed> points_;
};

/// The surface next to the edges of every keyframe, kept in the keyframes' own frames so that it follows
/// their poses.
class SemiDenseStore {
  public:
    SemiDenseStore(const PinholeCamera& camera, const OdometryOptions& options)
        : camera_(camera),
          limits_{options.sensor.min_depth, options.sensor.max_depth, options.edges.depth_jump},
          max_points_(options.mapping.semi_dense_points) {}

    /// Adds the next keyframe. @param edges  of the keyframe, ideal px
    void add(const OrganizedEdges& edges, const Frame& frame, const RowMotion& rows);

    /// Begins with these keyframes.
    void load(std::vector<PackedPoints> keyframes) { keyframes_ = std::move(keyframes); }
    /// Of every keyframe so far, in their own frames.
    const std::vector<PackedPoints>& keyframes() const { return keyframes_; }

    /// All points in the world, one keyframe after the other.
    /// @param keyframes  all that were added, in that order, at the poses that are wanted
    /// @param first      of the keyframes that are wanted
    std::vector<ColouredPoint> inWorld(const std::vector<KeyframeInfo>& keyframes,
                                       std::size_t first = 0) const;

  private:
    PinholeCamera camera_;
    SurfaceLimits limits_;
    int max_points_;
    std::vector<PackedPoints> keyframes_;
};

}  // namespace roevo
