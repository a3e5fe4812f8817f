#include "recordings/facts.h"

#include <cstdio>

#include "programs/text.h"
#include "recordings/lens.h"

namespace roevo {

std::string sizeText(const cv::Size& size) {
    return std::to_string(size.width) + "x" + std::to_string(size.height);
}

std::string factsText(std::size_t pairs, const PinholeCamera& camera, const cv::Size& depth, double step,
                      double median_depth) {
    std::string text = pairs > 0 ? counted(pairs, "pair") + " of " : "pairs of ";
    const cv::Size colour(camera.width, camera.height);
    text += sizeText(colour);
    if (depth != colour) text += " (depth " + sizeText(depth) + ")";
    char numbers[120];
    std::snprintf(numbers, sizeof numbers, ", fx %g fy %g cx %g cy %g", camera.fx, camera.fy, camera.cx,
                  camera.cy);
    text += numbers;
    constexpr double kSlowest = 20;  // s; above, one of the two stamps is damaged or missing
    if (step > 0 && step < kSlowest) {
        std::snprintf(numbers, sizeof numbers, ", %.1f Hz", 1 / step);
        text += numbers;
    }
    std::snprintf(numbers, sizeof numbers, ", median depth %.3g m", median_depth);
    return text + ", " + lensText(camera) + numbers;
}

}  // namespace roevo
