#include "edges/edge_extractor.h"

#include <algorithm>

namespace roevo {

void EdgeExtractor::extract(const cv::Mat& grey, OrganizedEdges& out, EdgeMask& mask, const cv::Mat& scene) {
    computeGradient(grey, options_.blur_sigma, gradient_);
    if (!scene.empty()) gradient_.magnitude.setTo(0, scene == 0);
    const double high =
        std::max(options_.min_high_threshold, options_.canny_factor * otsuThreshold(gradient_.magnitude));
    canny(gradient_, options_.canny_low_ratio * high, high, mask);
    adjustAdjacency(mask);
    organizer_.organize(gradient_, mask, options_.angle_deg, options_.min_length, out);
    computeNormals(out, options_.tangent_span);
}

}  // namespace roevo
