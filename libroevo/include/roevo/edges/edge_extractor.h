#pragma once
#include <opencv2/core/mat.hpp>

#include "roevo/edges/canny.h"
#include "roevo/edges/gradient.h"
#include "roevo/edges/organize.h"
#include "roevo/edges/organized_edges.h"
#include "roevo/options.h"

namespace roevo {

/// Grey image to organized edges: gradient, Otsu thresholds smoothed over time, Canny, adjacency, oriented
/// BFS, ordering, normals. Keeps its buffers; one per image stream.
class EdgeExtractor {
  public:
    explicit EdgeExtractor(const EdgeOptions& options) : options_(options) {}
    void extract(const cv::Mat& grey, OrganizedEdges& out);
    double highThreshold() const { return high_; }
    const EdgeMask& mask() const { return mask_; }

  private:
    EdgeOptions options_;
    Gradient gradient_;
    EdgeMask mask_;
    EdgeOrganizer organizer_;
    double high_ = 0;        ///< 0 before the first image
    bool had_none_ = false;  ///< the threshold comes from an image without contrast
};

}  // namespace roevo
