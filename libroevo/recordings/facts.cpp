#include "recordings/facts.h"

#include <cstdio>

#include "programs/text.h"
#include "recordings/lens.h"

namespace roevo {

std::string factsText(std::size_t pairs, const PinholeCamera& camera, const cv::Size& depth, double step,
                      double median_depth) {
    std::string text = pairs > 0 ? counted(pairs, "pair") + " of " : "pairs of ";
    text += std::to_string(camera.width) + "x" + std::to_string(camera.height);
    if (depth != cv::Size(camera.width, camera.height))
        text += " (depth " + std::to_string(depth.width) + "x" + std::to_string(depth.height) + ")";
    char numbers[120];
    std::snprintf(numbers, sizeof numbers, ", fx %g fy %g cx %g cy %g", camera.fx, camera.fy, camera.cx,
                  camera.cy);
    text += numbers;
    if (step > 0) {
        std::snprintf(numbers, sizeof numbers, ", %.1f Hz", 1 / step);
        text += numbers;
    }
    std::snprintf(numbers, sizeof numbers, ", median depth %.3g m", median_depth);
    return text + ", " + lensText(camera) + numbers;
}

}  // namespace roevo
