#include "npy.h"

#include <cstdio>
#include <cstring>
#include <opencv2/core.hpp>
#include <stdexcept>

#include "input/excerpt.h"

namespace roevo {
namespace {

/// What the head, a Python dictionary, has after a key: up to the ',' or '}' that ends it, brackets apart.
std::string valueOf(const std::string& head, const std::string& key) {
    std::size_t at = head.find("'" + key + "'");
    if (at == std::string::npos) return "";
    at = head.find(':', at);
    if (at == std::string::npos) return "";
    std::string out;
    for (int open = 0; ++at < head.size();) {
        const char c = head[at];
        if (open == 0 && (c == ',' || c == '}')) break;
        open += c == '(' ? 1 : c == ')' ? -1 : 0;
        if (c != ' ' && c != '\'') out += c;
    }
    return out;
}

/// "(480,640)" or "(480,640,1)". @return 0x0 for anything else
cv::Size sizeOf(const std::string& shape) {
    constexpr int kLargest = 8192;
    int height = 0, width = 0, channels = 1, used = 0;
    const int found =
        std::sscanf(shape.c_str(), "(%5d,%5d%n,%1d%n", &height, &width, &used, &channels, &used);
    const std::string rest = found >= 2 ? shape.substr(static_cast<std::size_t>(used)) : "";
    if ((rest != ")" && rest != ",)") || channels != 1 || height < 1 || width < 1 || height > kLargest ||
        width > kLargest)
        return {};
    return {width, height};
}

}  // namespace

cv::Mat decodeNpy(const std::vector<std::uint8_t>& bytes, const std::string& file) {
    const auto fail = [&](const std::string& what) {
        throw std::runtime_error("cannot decode image (" + what + "): " + file);
    };
    constexpr std::size_t kVersion = 6, kLength = 8;
    if (bytes.size() < 12) fail("truncated array");
    const std::size_t width = bytes[kVersion] == 1 ? 2 : 4;  // of the head's length
    std::size_t length = 0;
    for (std::size_t i = 0; i < width; i++) length |= std::size_t{bytes[kLength + i]} << (8 * i);
    const std::size_t begin = kLength + width;
    if (length > bytes.size() - begin) fail("truncated array");
    const std::string head(reinterpret_cast<const char*>(bytes.data()) + begin, length);

    const std::string type = valueOf(head, "descr"), shape = valueOf(head, "shape");
    const int stored = type == "<u2" ? CV_16UC1 : type == "<f4" ? CV_32FC1 : type == "<f8" ? CV_64FC1 : -1;
    if (stored < 0)
        fail("an array of '" + excerpt(type) + "'; depth must be uint16, float32 or float64, little-endian");
    if (valueOf(head, "fortran_order") != "False")
        fail("an array by columns: save numpy.ascontiguousarray() of it");
    const cv::Size size = sizeOf(shape);
    if (size.empty()) fail("an array of shape " + excerpt(shape) + "; depth must be (height, width)");
    const std::size_t wanted = static_cast<std::size_t>(size.area()) * CV_ELEM_SIZE(stored),
                      there = bytes.size() - begin - length;
    if (there != wanted)
        fail("truncated array: " + std::to_string(there) + " of " + std::to_string(wanted) + " bytes");
    cv::Mat image(size, stored);
    std::memcpy(image.data, bytes.data() + begin + length, wanted);
    if (stored == CV_64FC1) image.convertTo(image, CV_32F);
    return image;
}

}  // namespace roevo
