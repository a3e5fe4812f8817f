#include "recordings/bags/image_messages.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <opencv2/imgproc.hpp>
#include <stdexcept>

#include "input/excerpt.h"
#include "recordings/depth_scale.h"
#include "roevo_mrpt/image_conversions.h"

namespace roevo {
namespace {

constexpr double kWrittenUnitsPerMetre = 5000;

bool contains(std::string_view text, std::string_view part) {
    return text.find(part) != std::string_view::npos;
}

/// The pixels of a message, without copying. @throws std::runtime_error when the message is shorter than it
/// says.
cv::Mat viewOf(const ImageMessage& message, int type) {
    constexpr std::uint32_t kMaxSide = 1 << 15;
    const std::size_t row_bytes =
        static_cast<std::size_t>(message.width) * static_cast<std::size_t>(CV_ELEM_SIZE(type));
    if (message.width == 0 || message.height == 0 || message.width > kMaxSide || message.height > kMaxSide)
        throw std::runtime_error("image of " + std::to_string(message.width) + "x" +
                                 std::to_string(message.height) + " pixels");
    if (message.step < row_bytes ||
        message.data.size() < static_cast<std::size_t>(message.step) * (message.height - 1) + row_bytes)
        throw std::runtime_error("image data of " + std::to_string(message.data.size()) +
                                 " bytes is too short for " + std::to_string(message.width) + "x" +
                                 std::to_string(message.height) + " " + excerpt(message.encoding));
    if (message.step % static_cast<std::size_t>(CV_ELEM_SIZE1(type)) != 0)
        throw std::runtime_error("rows of " + std::to_string(message.step) +
                                 " bytes, which are no whole number of " + excerpt(message.encoding) +
                                 " values");
    return {static_cast<int>(message.height), static_cast<int>(message.width), type,
            const_cast<char*>(message.data.data()), message.step};
}

/// A copy whose values are in this machine's order; rows need not begin at multiples of their size before.
cv::Mat ordered(const cv::Mat& view, bool big_endian) {
    cv::Mat out = view.clone();
    if (!big_endian) return out;
    const std::size_t size = out.elemSize();
    for (std::size_t i = 0; i < out.total(); i++)
        std::reverse(out.data + i * size, out.data + (i + 1) * size);
    return out;
}

cv::Mat converted(const cv::Mat& image, int code) {
    cv::Mat out;
    cv::cvtColor(image, out, code);
    return out;
}

/// What image_transport calls compressedDepth: the kind of compression and two numbers, then a PNG. Of 32FC1
/// that holds a / depth + b, rounded; 0 where there is no depth.
cv::Mat compressedDepth(const CompressedImageMessage& message, const std::string& encoding,
                        std::size_t& too_far) {
    if (contains(message.format, "rvl"))
        throw std::runtime_error("compressedDepth by RVL is not supported, only PNG: republish it as raw");
    FieldReader in(message.data);
    in.get<std::int32_t>();
    const auto a = in.get<float>(), b = in.get<float>();
    const cv::Mat stored = decodeDepth(in.bytes(in.left()), "its PNG");
    if (encoding != "32FC1") return stored;
    cv::Mat metres(stored.size(), CV_32FC1);
    for (int v = 0; v < stored.rows; v++)
        for (int u = 0; u < stored.cols; u++) {
            const auto value = stored.at<std::uint16_t>(v, u);
            metres.at<float>(v, u) = value == 0 ? 0.f : a / (static_cast<float>(value) - b);
        }
    return depthInUnits(metres, kWrittenUnitsPerMetre, too_far);
}

}  // namespace

ImageKind kindOf(const std::string& encoding) {
    if (encoding == "rgb8" || encoding == "bgr8" || encoding == "rgba8" || encoding == "bgra8" ||
        encoding == "8UC3")
        return ImageKind::kColour;
    if (encoding == "mono8" || encoding == "8UC1") return ImageKind::kGrey;
    if (encoding == "16UC1" || encoding == "32FC1") return ImageKind::kDepth;
    return ImageKind::kNone;
}

ImageKind kindOf(const CompressedImageMessage& message) {
    if (const std::size_t end = message.format.find(';'); end != std::string::npos)
        return kindOf(message.format.substr(0, end));
    if (message.format != "png")
        return contains(message.format, "jp") ? ImageKind::kColour : ImageKind::kNone;
    // In a PNG, bits per value and kind of colour (0: grey) follow the head, "IHDR", width and height
    constexpr std::size_t kBits = 24, kColourKind = 25;
    if (message.data.size() <= kColourKind) return ImageKind::kNone;
    if (message.data[kBits] == 16) return ImageKind::kDepth;
    return message.data[kColourKind] == 0 ? ImageKind::kGrey : ImageKind::kColour;
}

double depthUnitsPerMetre(const std::string& encoding) {
    return encoding == "32FC1" ? kWrittenUnitsPerMetre : 1000;
}

BagImage::BagImage(const BagTopic& topic, const MessageBytes& message) : is_raw_(topic.isRaw()) {
    if (is_raw_) {
        raw_ = parseImage(message);
        encoding_ = raw_.encoding;
    } else {
        compressed_ = parseCompressedImage(message);
        const std::size_t end = compressed_.format.find(';');
        encoding_ = end != std::string::npos                   ? compressed_.format.substr(0, end)
                    : kindOf(compressed_) == ImageKind::kDepth ? "16UC1"
                                                               : compressed_.format;
    }
}

cv::Mat BagImage::colour() const {
    if (!is_raw_) return decodeColour(compressed_.data, "its " + excerpt(compressed_.format));
    if (kindOf(encoding_) == ImageKind::kGrey) return viewOf(raw_, CV_8UC1).clone();
    if (encoding_ == "bgr8" || encoding_ == "8UC3") return viewOf(raw_, CV_8UC3).clone();
    if (encoding_ == "rgb8") return converted(viewOf(raw_, CV_8UC3), cv::COLOR_RGB2BGR);
    if (encoding_ == "rgba8") return converted(viewOf(raw_, CV_8UC4), cv::COLOR_RGBA2BGR);
    if (encoding_ == "bgra8") return converted(viewOf(raw_, CV_8UC4), cv::COLOR_BGRA2BGR);
    throw std::runtime_error("encoding " + excerpt(encoding_) + " is no 8-bit colour or grey image");
}

cv::Mat BagImage::depth(std::size_t& too_far) const {
    too_far = 0;
    if (!is_raw_) {
        if (contains(compressed_.format, "compressedDepth"))
            return compressedDepth(compressed_, encoding_, too_far);
        return decodeDepth(compressed_.data, "its " + excerpt(compressed_.format));
    }
    if (encoding_ == "16UC1" || encoding_ == "mono16")
        return ordered(viewOf(raw_, CV_16UC1), raw_.big_endian);
    if (encoding_ != "32FC1")
        throw std::runtime_error("encoding " + excerpt(encoding_) + " is no depth image");
    return depthInUnits(ordered(viewOf(raw_, CV_32FC1), raw_.big_endian), kWrittenUnitsPerMetre, too_far);
}

}  // namespace roevo
