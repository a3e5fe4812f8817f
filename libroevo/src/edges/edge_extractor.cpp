#include "roevo/edges/edge_extractor.h"

#include <algorithm>

namespace roevo {

void EdgeExtractor::extract(const cv::Mat& grey, OrganizedEdges& out) {
    computeGradient(grey, options_.blur_sigma, gradient_);
    const double otsu = std::max(options_.min_high_threshold,
                                 options_.canny_high_factor * otsuThreshold(gradient_.magnitude));
    high_ =
        high_ == 0 ? otsu : options_.threshold_smoothing * high_ + (1 - options_.threshold_smoothing) * otsu;
    canny(gradient_, options_.canny_low_ratio * high_, high_, mask_);
    adjustAdjacency(mask_);
    organizer_.organize(gradient_, mask_, options_.angle_deg, options_.min_length, out);
    computeNormals(out, options_.tangent_span);
}

}  // namespace roevo
