#pragma once
#include <opencv2/core/mat.hpp>

#include "roevo/camera/pinhole_camera.h"

namespace roevo::simulator {

struct SensorOptions {
    double noise = 1;  ///< scale of the depth noise, 0: none
    bool holes = false;
};

/// Depth as a structured-light sensor measures it. @param exact CV_32FC1 metres  @param key seed of this
/// frame
cv::Mat measureDepth(const cv::Mat& exact, const PinholeCamera& camera, const SensorOptions& options,
                     uint64_t key);

/// Adds independent Gaussian noise of `sigma` grey levels to a CV_32FC3 image in 0..255.
void addImageNoise(cv::Mat& image, double sigma, uint64_t key);

}  // namespace roevo::simulator
