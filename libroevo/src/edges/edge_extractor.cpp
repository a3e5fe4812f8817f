#include "edges/edge_extractor.h"

namespace roevo {

void EdgeExtractor::extract(const cv::Mat& grey, OrganizedEdges& out, EdgeMask& mask, const cv::Mat& scene) {
    computeGradient(grey, options_.blur_sigma, gradient_);
    if (!scene.empty()) gradient_.magnitude.setTo(0, scene == 0);
    canny(gradient_, cannyThresholds(gradient_, options_), mask);
    adjustAdjacency(mask);
    organizer_.organize(gradient_, mask, options_.angle_deg, options_.min_length, out);
    computeNormals(out, options_.tangent_span);
}

}  // namespace roevo
