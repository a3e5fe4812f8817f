#include "programs/text.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdio>

#include "input/excerpt.h"

namespace roevo {
namespace {

std::string escape(const std::string& text, const std::string& special, const char* before) {
    std::string escaped;
    for (const char c : cleanText(text)) {
        if (special.find(c) != std::string::npos) escaped += before;
        escaped += c;
    }
    return escaped;
}

}  // namespace

std::string cleanText(const std::string& text) {
    std::string clean;
    for (std::size_t i = 0; i < text.size();) {
        const std::size_t length = utf8Length(text, i);
        if (length == 0)
            clean += "\xEF\xBF\xBD";
        else if (isControl(text, i))
            clean += ' ';
        else
            clean.append(text, i, length);
        i += length == 0 ? 1 : length;
    }
    return clean;
}

std::string csvField(const std::string& text) {
    const std::string clean = cleanText(text);
    if (clean.find_first_of(",\"") == std::string::npos) return clean;
    return '"' + replaceAll(clean, "\"", "\"\"") + '"';
}

std::string markdownText(const std::string& text) {
    return escape(text, "\\`*_[]<>&|#~!", "\\");
}

std::string htmlText(const std::string& text) {
    std::string escaped;
    for (const char c : cleanText(text)) {
        switch (c) {
            case '&':
                escaped += "&amp;";
                break;
            case '<':
                escaped += "&lt;";
                break;
            case '>':
                escaped += "&gt;";
                break;
            case '"':
                escaped += "&quot;";
                break;
            case '\'':
                escaped += "&#39;";
                break;
            default:
                escaped += c;
        }
    }
    return escaped;
}

std::string shownNumber(std::optional<double> value, int decimals) {
    if (!value || !std::isfinite(*value)) return "–";
    char text[400];
    std::snprintf(text, sizeof text, "%.*f", decimals, *value);
    return text;
}

std::string exactNumber(std::optional<double> value) {
    if (!value || !std::isfinite(*value)) return {};
    char text[64];
    return {text, std::to_chars(text, text + sizeof text, *value).ptr};
}

std::string plainNumber(double value) {
    char text[64];
    return {text, std::to_chars(text, text + sizeof text, value, std::chars_format::general).ptr};
}

std::string allDigits(double value) {
    char text[64];
    std::snprintf(text, sizeof text, "%.17g", value);
    return text;
}

std::string stampText(double timestamp) {
    char text[400];
    std::snprintf(text, sizeof text, "%.6f", timestamp);
    return text;
}

std::string counted(std::size_t count, const std::string& noun) {
    return std::to_string(count) + " " + noun + (count == 1 ? "" : "s");
}

std::size_t countCharacters(const std::string& text) {
    return static_cast<std::size_t>(std::count_if(
        text.begin(), text.end(), [](char c) { return (static_cast<unsigned char>(c) & 0xC0) != 0x80; }));
}

std::string shortened(const std::string& text, std::size_t limit) {
    if (countCharacters(text) <= limit) return text;
    std::string start;
    std::size_t count = 0;
    for (const char c : text) {
        count += (static_cast<unsigned char>(c) & 0xC0) != 0x80;
        if (count == limit) break;
        start += c;
    }
    return start + "…";
}

std::string replaceAll(std::string text, const std::string& from, const std::string& to) {
    for (std::size_t at = 0; (at = text.find(from, at)) != std::string::npos; at += to.size())
        text.replace(at, from.size(), to);
    return text;
}

std::string base64(const std::string& bytes) {
    static constexpr char digits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string text;
    text.reserve((bytes.size() + 2) / 3 * 4);
    for (std::size_t i = 0; i < bytes.size(); i += 3) {
        unsigned group = 0;
        for (std::size_t k = 0; k < 3; ++k)
            group = group << 8 | (i + k < bytes.size() ? static_cast<unsigned char>(bytes[i + k]) : 0u);
        for (std::size_t k = 0; k < 4; ++k)
            text += i + k > bytes.size() ? '=' : digits[group >> (18 - 6 * k) & 63];
    }
    return text;
}

}  // namespace roevo
