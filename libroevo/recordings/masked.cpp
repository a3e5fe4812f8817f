#include "recordings/masked.h"

#include <opencv2/core.hpp>
#include <stdexcept>
#include <utility>
#include <vector>

#include "programs/text.h"
#include "recordings/facts.h"
#include "recordings/forwarding_source.h"
#include "roevo_mrpt/image_conversions.h"

namespace roevo {
namespace {

cv::Mat readMask(const std::string& file, const PinholeCamera& camera) {
    cv::Mat mask = toGrey(readColourFile(file));
    if (mask.size() != cv::Size(camera.width, camera.height))
        throw std::runtime_error("the mask " + file + " is " + sizeText(mask.size()) +
                                 ", the colour images are " + sizeText({camera.width, camera.height}));
    double brightest = 0;
    cv::minMaxLoc(mask, nullptr, &brightest);
    if (brightest == 0)
        throw std::runtime_error("the mask " + file + " is all black, which leaves nothing of the images");
    mask = mask > brightest / 2;  // of 0 and 1, too; black is not quite 0 in a JPEG
    if (cv::countNonZero(mask) == static_cast<int>(mask.total()))
        throw std::runtime_error("the mask " + file +
                                 " is black nowhere (transparency does not count), which leaves nothing out: "
                                 "paint black what is to be left out, or give no mask");
    return mask;
}

class MaskedSource : public ForwardingSource {
  public:
    MaskedSource(std::unique_ptr<FrameSource> source, const std::string& mask)
        : ForwardingSource(std::move(source)),
          mask_(readMask(mask, camera())),
          left_out_(mask_ == 0),
          file_(mask) {}

    bool next(SourceFrame& frame) override {
        if (!ForwardingSource::next(frame)) return false;
        if (!frame.fault.empty()) return true;
        frame.frame.mask = mask_;
        frame.frame.depth.setTo(0, left_out_);  // for methods that do not know of masks
        return true;
    }

    bool isAtEnd() const override { return source().isAtEnd(); }

    std::vector<std::string> notes() const override {
        std::vector<std::string> notes = ForwardingSource::notes();
        const double share =
            static_cast<double>(cv::countNonZero(left_out_)) / static_cast<double>(left_out_.total());
        notes.push_back("mask " + file_ + " leaves out " + shownNumber(100 * share, 1) + " % of the image");
        return notes;
    }

  private:
    cv::Mat mask_, left_out_;
    std::string file_;
};

}  // namespace

std::unique_ptr<FrameSource> maskedFrames(std::unique_ptr<FrameSource> source, const std::string& mask) {
    return std::make_unique<MaskedSource>(std::move(source), mask);
}

}  // namespace roevo
