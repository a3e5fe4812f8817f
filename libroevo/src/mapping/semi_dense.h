#pragma once
#include <array>
#include <cstdint>
#include <tuple>
#include <utility>
#include <vector>

#include "edges/organized_edges.h"
#include "roevo/camera/pinhole_camera.h"
#include "roevo/camera/rgbd_frame.h"
#include "roevo/edge_map.h"
#include "roevo/frame_result.h"
#include "roevo/options.h"
#include "tracking/rolling_shutter.h"

namespace roevo {

/// Of a pixel of a frame; grey where the frame has no colour.
Rgb colourAt(const RgbdFrame& frame, int u, int v);

/// What is a surface in a depth image.
struct SurfaceLimits {
    double min_depth, max_depth;  ///< m, of depths that can be trusted
    double jump;  ///< relative; where depth changes more to the next pixel, sensors average over both sides
};

/// The surface next to the edges: pixels around edge points, as coloured points.
/// @param edges  ideal px
/// @param frame  as the lens saw it; grey where it has no colour
/// @param camera  of the frame, with its distortion
/// @param radius_px  how far from an edge point pixels are taken; 0: the points' own pixels
/// @param max_points  where there are more, this many of them, evenly along the edges
/// @return optical camera frame, m
std::vector<ColouredPoint> sampleSemiDense(const OrganizedEdges& edges, const RgbdFrame& frame,
                                           const PinholeCamera& camera, int radius_px,
                                           const SurfaceLimits& limits, int max_points);

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
    void add(const OrganizedEdges& edges, const RgbdFrame& frame, const RowMotion& rows);

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
