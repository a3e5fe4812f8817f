#pragma once
#include <mrpt/opengl/CFBORender.h>

#include <memory>
#include <opencv2/core/mat.hpp>
#include <vector>

#include "background.h"
#include "roevo_mrpt/mrpt_compat.h"
#include "view.h"

namespace roevo {

constexpr int kSuperSampling = 2;  ///< the scene is drawn this many times larger and shrunk

/// Draws a scene with no display. One per process: MRPT wants one renderer for a thread's whole life, and a
/// scene that one renderer has drawn cannot be drawn by another.
class OffscreenRenderer {
  public:
    /// @param size  of the picture, pixels
    /// @throws std::runtime_error when the machine has no OpenGL for offscreen drawing
    OffscreenRenderer(compat::Scene& scene, const Background& background, cv::Size size);

    /// @param below  objects that everything else is drawn over, however near they are
    /// @return CV_8UC3 (BGR)
    cv::Mat draw(const View& view, const std::vector<compat::SceneObject::Ptr>& below = {});

  private:
    cv::Mat drawLarge();

    compat::Scene& scene_;
    cv::Size size_;
    cv::Scalar background_;  // BGR, 0 to 255
    std::unique_ptr<mrpt::opengl::CFBORender> renderer_;
};

}  // namespace roevo
