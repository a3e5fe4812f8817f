#include "coarse_points.h"

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

OdometryStages coarseStages(CoarsePoints kind, const PinholeCamera& camera, const OdometryOptions& options) {
    OdometryStages stages;
    stages.photometric_points = [kind, camera, options](const KeyframeView& view) {
        const int most = options.coarse.max_points;
        if (kind == CoarsePoints::kOriented) return samplePhotometricPoints(view.edges, view.pyramid, most);
        EdgePoints3D points;
        if (kind == CoarsePoints::kOrganized) {
            points = view.edges;
            points.image.gradient_x.assign(points.size(), 1);
            points.image.gradient_y.assign(points.size(), 0);
        } else {
            Gradient gradient;
            computeGradient(view.pyramid.level(0), options.edges.blur_sigma, gradient);
            points = liftPixels(kind == CoarsePoints::kDso ? selectDsoPixels(gradient, most)
                                                           : selectCannyPixels(gradient, options.edges),
                                gradient, view.depth, camera, view.rows, options.edges, options.sensor);
        }
        PhotometricPoints sample = samplePhotometricPoints(points, view.pyramid, most);
        sample.source.clear();  // they are no edge points of the keyframe
        sample.turning = false;
        return sample;
    };
    return stages;
}

}  // namespace roevo
