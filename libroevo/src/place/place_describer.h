#pragma once
#include <Eigen/Core>
#include <cstdint>
#include <opencv2/core/mat.hpp>
#include <vector>

#include "place/place_points.h"
#include "roevo/camera/pinhole_camera.h"
#include "roevo/camera/rgbd_frame.h"
#include "roevo/types.h"
#include "tracking/edge_points.h"

namespace roevo {

/// How much of a place a frame shows at the pose where the place should be.
struct Likeness {
    int visible = 0;  ///< points of the place that are in the image, and that nothing hides
    int alike = 0;    ///< of them, those whose surroundings look as they did

    double share() const { return visible > 0 ? static_cast<double>(alike) / visible : 0; }
};

/// Chooses the points that a keyframe is recognised by, and describes them. They are those where the image
/// tells where along its edge a point is (ends, junctions, bends, change of what is beside the edge), spread
/// over the image. Their patches are of one size in metres, and turned so that the edge's signed normal comes
/// to lie on the x axis. Keeps its buffers.
class PlaceDescriber {
  public:
    /// @param camera  with its lens or not: edges and images are those of the ideal one
    explicit PlaceDescriber(const PinholeCamera& camera) : lens_(camera), camera_(camera.undistorted()) {}

    /// @param edges  of the keyframe
    /// @param grey   that they were found in: CV_8UC1, height x width, without the lens's distortion
    /// @return at most kMaxPlacePoints, the most distinct ones of every part of the image first
    PlacePoints describe(const EdgePoints3D& edges, const cv::Mat& grey);

    /// Looks in an image for what surrounds the points of a place. No edges need to be found there, so that
    /// blur costs little, and what is missing tells as much as what is there.
    /// @param grey    as for describe()
    /// @param images  of the same frame, as seen through the lens: what is nearer there or masked hides
    /// points
    Likeness compare(const PlacePoints& place, const Pose& T_frame_place, const cv::Mat& grey,
                     const RgbdFrame& images);

  private:
    struct Corner {
        std::int32_t point;  ///< of the edges
        float strength;
        std::int32_t rank;  ///< among those of its cell of the image, from 0
    };
    void findCorners(const OrganizedEdges& edges, const cv::Mat& grey);
    void chooseCorners(const OrganizedEdges& edges);
    /// Mean grey level of a square, as far as it is inside the image.
    float boxMean(const Eigen::Vector2d& centre, double half_width) const;
    Descriptor describePatch(const Eigen::Vector2d& centre, const Eigen::Vector2d& normal,
                             double radius) const;
    double patchRadius(double depth) const;

    PinholeCamera lens_, camera_;
    std::vector<Corner> corners_;
    cv::Mat integral_;  ///< of the grey image
};

}  // namespace roevo
