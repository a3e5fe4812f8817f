#include "embedded_jpegs.h"

#include <mrpt/img/CImage.h>

#include <algorithm>
#include <cstring>
#include <limits>
#include <opencv2/imgcodecs.hpp>
#include <stdexcept>
#include <string_view>
#include <utility>
#include <vector>

#include "jpeg_damage.h"

namespace roevo {
namespace {

constexpr int kSide = 1;  ///< pixels of the replacement

const std::vector<std::uint8_t>& replacement() {
    static const std::vector<std::uint8_t> jpeg = [] {
        std::vector<std::uint8_t> bytes;
        cv::imencode(".jpg", cv::Mat::zeros(kSide, kSide, CV_8UC3), bytes);
        return bytes;
    }();
    return jpeg;
}

}  // namespace

/// An image is: class name, version, whether it is in a file (from version 6 on), whether it has colour (2),
/// width, height (7), number of bytes, and these. Colour images with a positive size are JPEG.
bool EmbeddedJpegs::isImage(std::size_t count) const {
    const std::size_t numbers = header_.size();
    if (numbers < 2 || header_.back().bytes != 4 || header_.back().value != count) return false;
    const std::uint32_t version = header_.front().value;
    const std::size_t expected = version >= 7 ? 6 : version == 6 ? 4 : version >= 2 ? 3 : 2;
    const auto is_positive = [](std::uint32_t n) { return n - 1 < std::numeric_limits<std::int32_t>::max(); };
    return numbers == expected && (version < 6 || header_[1].value == 0) &&
           (version < 7 || (is_positive(header_[3].value) && is_positive(header_[4].value)));
}

void EmbeddedJpegs::examine(std::uint8_t* data, std::size_t count, std::size_t wanted) {
    constexpr std::string_view kClass = "CImage";
    const std::string_view text(reinterpret_cast<const char*>(data), count);
    if (count >= kClass.size() && text.substr(count - kClass.size()) == kClass) {
        header_.clear();
        in_header_ = true;
    } else if (in_header_ && isImage(wanted)) {
        in_header_ = false;
        const std::string damage = jpegDataDamage(std::vector<std::uint8_t>(data, data + count));
        if (damage.empty()) return;
        if (count < replacement().size()) throw std::runtime_error(damage);
        std::copy(replacement().begin(), replacement().end(), data);
        if (damage_.empty()) damage_ = damage;
    } else if (in_header_) {
        in_header_ = count <= sizeof(std::uint32_t);
        if (!in_header_) return;
        header_.push_back({count, 0});
        std::memcpy(&header_.back().value, data, count);
    }
}

std::string EmbeddedJpegs::takeDamage() {
    return std::exchange(damage_, "");
}

bool EmbeddedJpegs::isReplacement(const mrpt::img::CImage& image) {
    return !image.isEmpty() && image.getWidth() == kSide && image.getHeight() == kSide;  // empty: a file, too
}

}  // namespace roevo
