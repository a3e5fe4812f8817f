#pragma once
#include <cstddef>
#include <opencv2/core/mat.hpp>
#include <string>

#include "recordings/bags/bag_file.h"
#include "recordings/bags/messages.h"

namespace roevo {

/// rgb8, bgr8, rgba8, bgra8, 8UC3: colour; mono8, 8UC1: grey; 16UC1, 32FC1: depth; others: none.
ImageKind kindOf(const std::string& encoding);

/// By what its format says ("rgb8; jpeg compressed bgr8", "16UC1; compressedDepth"), or by the image itself
/// where that only says "png" or "jpeg".
ImageKind kindOf(const CompressedImageMessage& message);

/// An image message of either type, and how its pixels are to be read.
class BagImage {
  public:
    /// @param topic  of the message. @throws std::runtime_error as parseImage()
    BagImage(const BagTopic& topic, const MessageBytes& message);

    /// "16UC1", also where that is compressed.
    const std::string& encoding() const { return encoding_; }

    /// A colour or grey image as CV_8UC3 (BGR) or CV_8UC1. @throws std::runtime_error in one line.
    cv::Mat colour() const;

    /// A depth image as CV_16UC1 in depthUnitsPerMetre() of its encoding; 0 where it has no depth.
    /// @param too_far  set to the number of depths that do not fit (beyond 13.107 m for 32FC1), which become
    /// 0
    /// @throws std::runtime_error in one line.
    cv::Mat depth(std::size_t& too_far) const;

  private:
    std::string encoding_;
    ImageMessage raw_;
    CompressedImageMessage compressed_;
    bool is_raw_ = true;
};

/// Of what BagImage::depth() makes of this encoding. Millimetres stay what they are. Metres become fifths of
/// a millimetre, TUM's unit: that holds whole millimetres (what most drivers start from) without loss and
/// rounds others by 0.1 mm at most.
double depthUnitsPerMetre(const std::string& encoding);

}  // namespace roevo
