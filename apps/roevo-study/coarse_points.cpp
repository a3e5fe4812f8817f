#include "coarse_points.h"

#include <algorithm>

#include "point_selection.h"

namespace roevo {

const char* label(CoarsePoints points) {
    switch (points) {
        case CoarsePoints::kDso:
            return "DSO's selection";
        case CoarsePoints::kCanny:
            return "raw Canny";
        case CoarsePoints::kOrganized:
            return "organized edges";
        case CoarsePoints::kOriented:
            return "organized edges + oriented patches";
    }
    return "";
}

PhotometricPoints CoarsePointsTracker::choosePoints(const EdgePoints3D& edges, const Frame& frame,
                                                    const RowMotion& rows) const {
    if (kind_ == CoarsePoints::kOriented) return Tracker::choosePoints(edges, frame, rows);
    const int most = options_.coarse.max_points;
    EdgePoints3D points;
    if (kind_ == CoarsePoints::kOrganized) {
        points = edges;
        points.image.gradient_x.assign(points.size(), 1);
        points.image.gradient_y.assign(points.size(), 0);
    } else {
        Gradient gradient;
        computeGradient(frame.pyramid.level(0), options_.edges.blur_sigma, gradient);
        points = liftPixels(kind_ == CoarsePoints::kDso ? selectDsoPixels(gradient, most)
                                                        : selectCannyPixels(gradient, options_.edges),
                            gradient, frame.images.depth, camera_, rows, options_.edges, options_.sensor);
    }
    PhotometricPoints sample = samplePhotometricPoints(points, frame.pyramid, most);
    sample.source.clear();  // they are no edge points of the keyframe
    if (kind_ != CoarsePoints::kOrganized)
        std::fill(sample.edge_of.begin(), sample.edge_of.end(), -1);  // no edge
    sample.turning = false;
    return sample;
}

}  // namespace roevo
