#pragma once
#include "camera/undistorter.h"
#include "edges/edge_extractor.h"
#include "roevo/options.h"
#include "tracking/frame.h"

namespace roevo {

/// From an image pair to organized edges (Sec. IV).
class FrontEnd {
  public:
    /// @param camera  with its lens
    FrontEnd(const PinholeCamera& camera, const OdometryOptions& options)
        : undistorter_(camera), extractor_(options.edges), levels_(options.coarse.levels) {}

    /// @param frame  with its images; its other buffers are used again
    void process(Frame& frame);

  private:
    /// Forgets the depth of what is no scene. @return the scene in the ideal image; empty: all of it
    cv::Mat sceneOf(RgbdFrame& images) const;

    Undistorter undistorter_;
    EdgeExtractor extractor_;
    int levels_;
};

}  // namespace roevo
