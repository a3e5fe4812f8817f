#pragma once
#include <cstddef>
#include <opencv2/core/mat.hpp>
#include <vector>

#include "roevo/camera/pinhole_camera.h"
#include "roevo/edges/organized_edges.h"
#include "roevo/options.h"

namespace roevo {

/// Corrects the depths of an edge's points by the surfaces on its two sides. A patch around an edge lies on
/// both, and a plane through it misses the edge: by half the step where a frame stands out from a wall by
/// less than the noise lets a single patch tell, by the bend's depth at the edge of a box. The points before
/// and after on the same edge see the same two surfaces, and together they can tell: on each side a line is
/// fitted to the inverse depths along the normals and continued to the edge. Where the two ends meet, the
/// edge is there; where they differ by more than they err, it belongs to the nearer side.
class EdgeSides {
  public:
    /// @param edges       in ideal pixels, with normals
    /// @param first, end  the edge's points
    /// @param depth       CV_32FC1, m, 0 where unknown, of the possibly distorted `camera`
    /// @param z           depths of the points, m, 0 where unknown (those stay); corrected in place
    void correct(const OrganizedEdges& edges, std::size_t first, std::size_t end, const cv::Mat& depth,
                 const PinholeCamera& camera, const EdgeOptions& options, std::vector<float>& z);

  private:
    /// Of samples (distance from the edge, px; inverse depth relative to the edge point's, minus 1).
    struct Sums {
        double count = 0, s = 0, q = 0, ss = 0, sq = 0, qq = 0;
        void add(double distance, double value, double weight);
        Sums operator-(const Sums& other) const;
    };
    /// Where a side's line meets the edge, and the variance of that.
    struct Meeting {
        bool known = false;
        double value = 0, variance = 0;
    };
    void sample(const OrganizedEdges& edges, std::size_t point, float z, const cv::Mat& depth,
                const PinholeCamera& camera, const EdgeOptions& options, Sums& plus, Sums& minus) const;
    static Meeting fit(const Sums& sums);
    static double correction(const Meeting& plus, const Meeting& minus);

    std::vector<Sums> plus_, minus_;  ///< of all samples before a point
};

}  // namespace roevo
