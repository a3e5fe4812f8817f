#pragma once
#include <cstddef>
#include <string>
#include <string_view>

namespace roevo {

/// Length of the valid UTF-8 sequence that starts at `i`; 0 when there is none (RFC 3629).
inline std::size_t utf8Length(std::string_view text, std::size_t i) {
    const auto byte = [&](std::size_t k) {
        return k < text.size() ? static_cast<unsigned char>(text[k]) : 0u;
    };
    const unsigned lead = byte(i), next = byte(i + 1);
    const std::size_t length = lead < 0x80                    ? 1
                               : lead >= 0xC2 && lead <= 0xDF ? 2
                               : lead >= 0xE0 && lead <= 0xEF ? 3
                               : lead >= 0xF0 && lead <= 0xF4 ? 4
                                                              : 0;
    for (std::size_t k = 1; k < length; ++k)
        if ((byte(i + k) & 0xC0) != 0x80) return 0;
    const bool overlong = (lead == 0xE0 && next < 0xA0) || (lead == 0xF0 && next < 0x90);
    const bool surrogate = lead == 0xED && next > 0x9F;
    const bool noncharacter = lead == 0xEF && next == 0xBF && byte(i + 2) >= 0xBE;
    const bool too_large = lead == 0xF4 && next > 0x8F;
    return overlong || surrogate || noncharacter || too_large ? 0 : length;
}

/// Whether the valid sequence at `i` is a control character, which could move a terminal's cursor.
inline bool isControl(std::string_view text, std::size_t i) {
    const auto byte = static_cast<unsigned char>(text[i]);
    return byte < 0x20 || byte == 0x7F || (byte == 0xC2 && static_cast<unsigned char>(text[i + 1]) < 0xA0);
}

/// What was read from a file, fit to be shown in an error: what cannot be printed as '?', and no more than
/// `limit` characters, the last of them an ellipsis where more was there.
inline std::string excerpt(std::string_view text, std::size_t limit = 80) {
    std::string shown;
    std::size_t begin_of_last = 0, count = 0;
    for (std::size_t i = 0; i < text.size(); ++count) {
        if (count == limit) return shown.replace(begin_of_last, std::string::npos, "…");
        const std::size_t length = utf8Length(text, i);
        begin_of_last = shown.size();
        if (length == 0 || isControl(text, i))
            shown += '?';
        else
            shown += text.substr(i, length);
        i += length == 0 ? 1 : length;
    }
    return shown;
}

/// First meaningful line of an exception's text (MRPT's carry the source position and a call stack), fit for
/// a terminal: printable, and not of hundreds of pages.
inline std::string firstLine(const std::string& message) {
    constexpr std::size_t kLongest = 1500;  // characters; a path alone may have some hundreds
    const std::size_t begin = message.find_first_not_of(" \n\r\t");
    if (begin == std::string::npos) return "unknown error";
    const std::size_t end = message.find_first_of("\r\n", begin);
    return excerpt(message.substr(begin, end == std::string::npos ? end : end - begin), kLongest);
}

}  // namespace roevo
