#pragma once
#include <functional>
#include <memory>
#include <mutex>
#include <opencv2/core/mat.hpp>

#include "baked_light.h"
#include "roevo/camera/pinhole_camera.h"
#include "view.h"

namespace roevo::simulator {

/// What one rendering gives; the geometry holds for the pixels' centres.
struct Rendering {
    cv::Mat colour;         ///< CV_32FC3, BGR, 0..1, anti-aliased
    cv::Mat depth;          ///< CV_32FC1
    cv::Mat objects;        ///< CV_32SC1
    cv::Mat moving_shadow;  ///< CV_8UC1: 1 where only a moving primitive keeps a sharp lamp's light away
};

/// Ray caster: one ray through every pixel's centre, eight more wherever the colours or objects of neighbours
/// differ.
class Renderer {
  public:
    Renderer(const Scene& scene, const PinholeCamera& camera, int threads);

    /// @param instant_of_row  moment at which a row is read out  @param by_row  whether it differs between
    /// rows
    Rendering render(const std::function<Instant(double row)>& instant_of_row, bool by_row) const {
        return render(instant_of_row, by_row, true);
    }
    /// The same without colour and shadows, for a sensor of depth only: many times faster.
    Rendering renderDepth(const std::function<Instant(double row)>& instant_of_row, bool by_row) const {
        return render(instant_of_row, by_row, false);
    }

  private:
    Rendering render(const std::function<Instant(double row)>& instant_of_row, bool by_row,
                     bool with_colour) const;
    struct Band;
    void renderCentres(const Band& band, Rendering& out) const;
    void refine(const Band& band, const Rendering& centres, cv::Mat& colour) const;
    Colour shade(const View& view, double x, double y, const ViewHit& hit, float pixel_width,
                 bool* moving_shadow) const;
    void forEachBand(int count, const std::function<void(int)>& work) const;

    const Scene& scene_;
    PinholeCamera camera_;
    int threads_;
    cv::Mat rays_;  ///< CV_64FC2: ideal image coordinates x/z, y/z of every pixel's centre
    mutable std::once_flag bake_once_;  ///< soft light takes a second: only when a picture is wanted
    mutable std::unique_ptr<const BakedLight> baked_;
};

}  // namespace roevo::simulator
