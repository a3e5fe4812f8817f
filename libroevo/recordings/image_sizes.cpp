#include "recordings/image_sizes.h"

#include <opencv2/core/mat.hpp>
#include <stdexcept>

#include "roevo_mrpt/image_conversions.h"

namespace roevo {
namespace {

cv::Size firstSize(const std::vector<DatasetEntry>& frames, std::string DatasetEntry::*file,
                   cv::Mat (*read)(const std::string&)) {
    std::string fault;
    for (const DatasetEntry& frame : frames) {
        try {
            return read(frame.*file).size();
        } catch (const std::runtime_error& error) {
            if (fault.empty()) fault = error.what();
        }
    }
    throw std::runtime_error(fault);
}

}  // namespace

cv::Size colourSize(const std::vector<DatasetEntry>& frames) {
    return firstSize(frames, &DatasetEntry::image, &readColourFile);
}

cv::Size depthSize(const std::vector<DatasetEntry>& frames) {
    return firstSize(frames, &DatasetEntry::depth, &readAnyDepthFile);
}

}  // namespace roevo
