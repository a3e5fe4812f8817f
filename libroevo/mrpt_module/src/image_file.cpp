#include "image_file.h"

#include <unistd.h>
#include <zlib.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <stdexcept>

#include "jpeg_damage.h"

namespace roevo {
namespace {

using Bytes = std::vector<std::uint8_t>;

constexpr std::array<std::uint8_t, 8> kPngHead = {0x89, 'P', 'N', 'G', '\r', '\n', 0x1a, '\n'};

bool startsWith(const Bytes& bytes, const std::uint8_t* head, std::size_t count) {
    // What is shorter than the head may be the beginning of it
    return !bytes.empty() && std::equal(head, head + std::min(count, bytes.size()), bytes.begin());
}

std::uint32_t bigEndian(const std::uint8_t* b) {
    return static_cast<std::uint32_t>(b[0]) << 24 | static_cast<std::uint32_t>(b[1] << 16 | b[2] << 8 | b[3]);
}

std::string truncated(const Bytes& bytes) {
    return "truncated after " + std::to_string(bytes.size()) + " bytes";
}

/// Pixels that the head claims and so few bytes cannot hold, of which the decoder would ask memory first;
/// else "".
/// @param head  IHDR's data: width, height, bits, kind of colour
std::string pngBomb(const std::uint8_t* head, std::size_t bytes) {
    constexpr std::uint64_t kDeflateAtBest = 1032;                             // bytes out of one
    constexpr std::array<std::uint64_t, 7> kChannels = {1, 4, 3, 1, 2, 4, 4};  // by the kind of colour
    const std::uint64_t width = bigEndian(head), height = bigEndian(head + 4);
    const std::uint64_t row = 1 + (width * head[8] * kChannels[std::min<std::size_t>(head[9], 6)] + 7) / 8;
    if (height <= kDeflateAtBest * bytes / row + 1) return "";
    return "damaged: " + std::to_string(width) + "x" + std::to_string(height) + " pixels are not in " +
           std::to_string(bytes) + " bytes";
}

/// Chunks of length (4 bytes), type (4), data and the checksum of type and data (4), up to IEND.
std::string pngDamage(const Bytes& bytes) {
    for (std::size_t at = kPngHead.size(); at + 12 <= bytes.size();) {
        const std::uint8_t* const chunk = bytes.data() + at;
        const std::size_t length = bigEndian(chunk);
        if (length > bytes.size() - at - 12) return truncated(bytes);
        const std::uint8_t* const type = chunk + 4;
        if (crc32(0, type, static_cast<uInt>(length + 4)) != bigEndian(type + 4 + length))
            return "damaged: wrong checksum of what begins at byte " + std::to_string(at) + " of " +
                   std::to_string(bytes.size());
        if (std::memcmp(type, "IEND", 4) == 0) return "";
        if (std::memcmp(type, "IHDR", 4) == 0 && length >= 13)
            if (std::string bomb = pngBomb(type + 4, bytes.size()); !bomb.empty()) return bomb;
        at += length + 12;
    }
    return truncated(bytes);
}

/// Segments of a marker (0xff and another byte) and mostly a length (2 bytes, counted in) with data; after
/// "start of scan" compressed data, in which 0xff is followed by 0; up to "end of image".
std::string jpegDamage(const Bytes& bytes) {
    constexpr std::uint8_t kRestart0 = 0xd0, kRestart7 = 0xd7, kEndOfImage = 0xd9;
    std::size_t at = 2;
    while (at + 1 < bytes.size()) {
        // The next marker, over compressed data if there is any
        const void* const found = std::memchr(bytes.data() + at, 0xff, bytes.size() - at - 1);
        if (found == nullptr) break;
        at = static_cast<std::size_t>(static_cast<const std::uint8_t*>(found) - bytes.data());
        const std::uint8_t marker = bytes[at + 1];
        if (marker == kEndOfImage) return "";
        if (marker == 0xff) {
            at++;  // filling
        } else if (marker <= 1 || (marker >= kRestart0 && marker <= kRestart7)) {
            at += 2;
        } else {
            if (at + 4 > bytes.size()) break;
            at += 2 + static_cast<std::size_t>(bytes[at + 2] << 8 | bytes[at + 3]);
        }
    }
    return truncated(bytes);
}

}  // namespace

std::vector<std::uint8_t> readImageFile(const std::string& file) {
    std::error_code error;
    const auto status = std::filesystem::status(file, error);
    // Behind a folder that may not be entered nobody knows: access() says why
    if (std::filesystem::status_known(status) && !std::filesystem::is_regular_file(status))
        throw std::runtime_error("image file not found: " + file);
    const auto fail = [&] {
        throw std::runtime_error("cannot read image (" + std::string(std::strerror(errno)) + "): " + file);
    };
    if (access(file.c_str(), R_OK) != 0) fail();
    const auto size = std::filesystem::file_size(file, error);
    if (error) throw std::runtime_error("cannot read image (" + error.message() + "): " + file);
    if (size == 0) throw std::runtime_error("cannot decode image (empty file): " + file);
    Bytes bytes(size);
    std::ifstream in(file, std::ios::binary);
    if (!in.read(reinterpret_cast<char*>(bytes.data()), static_cast<std::streamsize>(size))) fail();
    return bytes;
}

std::string imageDamage(const std::vector<std::uint8_t>& bytes) {
    constexpr std::array<std::uint8_t, 3> kJpegHead = {0xff, 0xd8, 0xff};
    if (startsWith(bytes, kPngHead.data(), kPngHead.size())) return pngDamage(bytes);
    if (startsWith(bytes, kJpegHead.data(), kJpegHead.size())) {
        if (std::string damage = jpegDamage(bytes); !damage.empty()) return damage;
        const std::string damage = jpegDataDamage(bytes);
        return damage.empty() ? "" : "damaged: " + damage;
    }
    return "";
}

}  // namespace roevo
