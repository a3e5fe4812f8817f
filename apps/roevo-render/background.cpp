#include "background.h"

#include <algorithm>
#include <cctype>
#include <stdexcept>

namespace roevo {
namespace {

constexpr float kDarkInk = 0.13f, kLightInk = 0.92f;  // brightness of text
constexpr float kMiddle = 0.45f;                      // backgrounds brighter than this are written on in dark

std::string digitsOf(const std::string& text) {
    if (text == "dark") return "0e1117";
    if (text == "black") return "000000";
    if (text == "white") return "ffffff";
    if (text.size() == 7 && text[0] == '#' &&
        std::all_of(text.begin() + 1, text.end(), [](unsigned char c) { return std::isxdigit(c) != 0; }))
        return text.substr(1);
    throw std::invalid_argument("'" + text + "' is neither dark, white, black nor #rrggbb, e.g. #f4f1e8");
}

}  // namespace

Background::Background(const std::string& text) {
    const std::string digits = digitsOf(text);
    for (std::size_t c = 0; c < 3; ++c)
        colour_[c] = static_cast<float>(std::stoi(digits.substr(2 * c, 2), nullptr, 16)) / 255;
    brightness_ = 0.299f * colour_[0] + 0.587f * colour_[1] + 0.114f * colour_[2];
}

Colour Background::ink() const {
    const float level = brightness_ > kMiddle ? kDarkInk : kLightInk;
    return {level, level, level};
}

Colour Background::standingOut(const Colour& colour, float distance) const {
    Colour changed = colour;
    const float brightest = *std::max_element(colour.begin(), colour.end());
    if (brightness_ > kMiddle) {
        const float share = std::max(0.f, brightness_ - distance) / std::max(brightest, 1e-3f);
        for (float& level : changed) level *= std::min(1.f, share);
    } else {
        const float lift = std::max(0.f, std::min(1.f, brightness_ + distance) - brightest);
        for (float& level : changed) level += lift;
    }
    return changed;
}

Colour Background::faded(const Colour& colour, float share) const {
    Colour changed;
    for (std::size_t c = 0; c < 3; ++c) changed[c] = colour[c] + share * (colour_[c] - colour[c]);
    return changed;
}

}  // namespace roevo
