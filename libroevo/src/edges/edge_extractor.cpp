#include "edges/edge_extractor.h"

#include <algorithm>
#include <cmath>

namespace roevo {

void EdgeExtractor::extract(const cv::Mat& grey, OrganizedEdges& out, EdgeMask& mask, double frames) {
    computeGradient(grey, options_.blur_sigma, gradient_);
    const double otsu = options_.canny_high_factor * otsuThreshold(gradient_.magnitude);
    if (high_ == 0 || otsu > options_.min_high_threshold) {  // a black image says nothing about those to come
        const double fresh = std::max(options_.min_high_threshold, otsu);
        const double keep = high_ == 0 || had_none_ ? 0 : std::pow(options_.threshold_smoothing, frames);
        high_ = keep * high_ + (1 - keep) * fresh;
        had_none_ = otsu <= options_.min_high_threshold;
    }
    canny(gradient_, options_.canny_low_ratio * high_, high_, mask);
    adjustAdjacency(mask);
    organizer_.organize(gradient_, mask, options_.angle_deg, options_.min_length, out);
    computeNormals(out, options_.tangent_span);
}

}  // namespace roevo
