#pragma once
#include <opencv2/core/mat.hpp>

#include "edges/canny.h"
#include "edges/gradient.h"
#include "edges/organize.h"
#include "edges/organized_edges.h"
#include "roevo/options.h"

namespace roevo {

/// Grey image to organized edges: gradient, Otsu thresholds, Canny, adjacency, oriented BFS, ordering,
/// normals. Keeps its buffers, and nothing else of an image.
class EdgeExtractor {
  public:
    explicit EdgeExtractor(const EdgeOptions& options) : options_(options) {}
    /// @param mask   the pixels that the edges were made of
    /// @param scene  CV_8UC1 of the same size: 0 where no edge is wanted; empty: wanted everywhere
    void extract(const cv::Mat& grey, OrganizedEdges& out, EdgeMask& mask, const cv::Mat& scene = {}) {
        computeGradient(grey, options_.blur_sigma, gradient_);
        if (!scene.empty()) gradient_.magnitude.setTo(0, scene == 0);
        canny(gradient_, cannyThresholds(gradient_, options_), mask);
        adjustAdjacency(mask);
        organizer_.organize(gradient_, mask, options_.angle_deg, options_.min_length, out);
        computeNormals(out, options_.tangent_span);
    }

  private:
    EdgeOptions options_;
    Gradient gradient_;
    EdgeOrganizer organizer_;
};

}  // namespace roevo
