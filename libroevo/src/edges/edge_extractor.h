#pragma once
#include <opencv2/core/mat.hpp>

#include "edges/canny.h"
#include "edges/gradient.h"
#include "edges/organize.h"
#include "edges/organized_edges.h"
#include "roevo/options.h"

namespace roevo {

/// Grey image to organized edges: gradient, Otsu thresholds smoothed over time, Canny, adjacency, oriented
/// BFS, ordering, normals. Keeps its buffers; one per image stream.
class EdgeExtractor {
  public:
    explicit EdgeExtractor(const EdgeOptions& options) : options_(options) {}
    /// @param mask  the pixels that the edges were made of
    /// @param frames  of 30 Hz since the image before
    void extract(const cv::Mat& grey, OrganizedEdges& out, EdgeMask& mask, double frames = 1);
    double highThreshold() const { return high_; }

  private:
    EdgeOptions options_;
    Gradient gradient_;
    EdgeOrganizer organizer_;
    double high_ = 0;        ///< 0 before the first image
    bool had_none_ = false;  ///< the threshold comes from an image without contrast
};

}  // namespace roevo
