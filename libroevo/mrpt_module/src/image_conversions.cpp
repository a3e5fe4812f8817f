#include "roevo_mrpt/image_conversions.h"

#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <new>
#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <stdexcept>

#include "checked_memory.h"
#include "image_file.h"
#include "npy.h"

namespace roevo {
namespace {

// For the first image OpenCV starts all its decoders, of which GDAL ends the program when it finds no room.
constexpr std::size_t kRoomToDecode = std::size_t{64} << 20;  // bytes

using Bytes = std::vector<std::uint8_t>;

cv::Mat decode(const Bytes& bytes, const std::string& file, int flags) {
    if (const std::string damage = imageDamage(bytes); !damage.empty())
        throw std::runtime_error("cannot decode image (" + damage + "): " + file);
    requireRoom(kRoomToDecode);
    cv::Mat image;
    try {
        image = cv::imdecode(bytes, flags);
    } catch (const cv::Exception& e) {
        if (e.code == cv::Error::StsNoMem) throw std::bad_alloc();  // nothing is known of the image then
        image.release();
    }
    if (image.empty()) throw std::runtime_error("cannot decode image (damaged or not an image): " + file);
    return image;
}

cv::Mat asDepth(const Bytes& bytes, const std::string& file) {
    cv::Mat depth = decode(bytes, file, cv::IMREAD_UNCHANGED);
    if (depth.type() != CV_16UC1)
        throw std::runtime_error("depth image must be 16-bit with one channel, but has " +
                                 std::to_string(8 * depth.elemSize1()) + " bits and " +
                                 std::to_string(depth.channels()) + " channel(s): " + file);
    return depth;
}

bool startsWith(const Bytes& bytes, std::string_view head) {
    return bytes.size() >= head.size() && std::memcmp(bytes.data(), head.data(), head.size()) == 0;
}

/// OpenCV reads EXR only where this is set before its first image of that kind.
void allowExr() {
    static const bool once = [] { return setenv("OPENCV_IO_ENABLE_OPENEXR", "1", 0) == 0; }();
    (void)once;
}

/// The depth of an image whose channels all say the same, as some programs write it.
cv::Mat onlyChannel(const cv::Mat& image) {
    if (image.channels() == 1) return image;
    std::vector<cv::Mat> channels;
    cv::split(image, channels);
    for (std::size_t i = 1; i < std::min<std::size_t>(3, channels.size()); i++)
        if (cv::norm(channels[0], channels[i], cv::NORM_INF) != 0) return image;
    return channels[0];
}

cv::Mat asAnyDepth(const Bytes& bytes, const std::string& file) {
    if (startsWith(bytes, kNpyHead)) return decodeNpy(bytes, file);
    const bool exr = startsWith(bytes, "\x76\x2f\x31\x01");
    const bool tiff =
        startsWith(bytes, std::string_view("II*\0", 4)) || startsWith(bytes, std::string_view("MM\0*", 4));
    if (!exr && !tiff) return asDepth(bytes, file);
    if (exr) allowExr();
    const cv::Mat depth = onlyChannel(decode(bytes, file, cv::IMREAD_UNCHANGED));
    if (depth.type() == CV_16UC1 || depth.type() == CV_32FC1) return depth;
    throw std::runtime_error("depth image must hold 16-bit numbers or floats in one channel, but has " +
                             std::to_string(8 * depth.elemSize1()) + " bits and " +
                             std::to_string(depth.channels()) + " channel(s): " + file);
}

cv::Mat asColour(const Bytes& bytes, const std::string& file) {
    // Not turned as a camera was held: depth and intrinsics are of the pixels as they are stored
    constexpr int kAsStored = cv::IMREAD_ANYCOLOR | cv::IMREAD_IGNORE_ORIENTATION;
    const cv::Mat image = decode(bytes, file, kAsStored | cv::IMREAD_ANYDEPTH);
    if (image.depth() == CV_8U) return image;
    double most = 0;
    if (image.depth() == CV_16U) cv::minMaxLoc(image.reshape(1), nullptr, &most);
    if (most >= 256 && most < 4096)  // of 16 bits the upper ones are taken: it would be black
        throw std::runtime_error(
            "the image has 16 bits, of which no more than 12 are used: make one of 8 bits of it: " + file);
    return decode(bytes, file, kAsStored);
}

}  // namespace

cv::Mat readColourFile(const std::string& file) {
    return asColour(readImageFile(file), file);
}

cv::Mat readDepthFile(const std::string& file) {
    return asDepth(readImageFile(file), file);
}

cv::Mat readAnyDepthFile(const std::string& file) {
    return asAnyDepth(readImageFile(file), file);
}

cv::Mat decodeColour(std::string_view bytes, const std::string& name) {
    return asColour(Bytes(bytes.begin(), bytes.end()), name);
}

cv::Mat decodeDepth(std::string_view bytes, const std::string& name) {
    return asDepth(Bytes(bytes.begin(), bytes.end()), name);
}

void writeImageFile(const std::string& file, const cv::Mat& image, const std::vector<int>& parameters) {
    std::vector<std::uint8_t> bytes;
    bool encoded = false;
    try {
        encoded = cv::imencode(std::filesystem::path(file).extension().string(), image, bytes, parameters);
    } catch (const cv::Exception&) {  // whose words go over several lines
    }
    if (!encoded) throw std::runtime_error("cannot write " + file + ": the image cannot be encoded");
    errno = 0;
    std::ofstream out(file, std::ios::binary);
    out.write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
    out.close();
    if (!out)
        throw std::runtime_error("cannot write " + file + ": " +
                                 (errno ? std::strerror(errno) : "disk full?"));
}

float depthUnit(double units_per_metre) {
    return 1.f / static_cast<float>(units_per_metre);
}

cv::Mat depthToMetres(const cv::Mat& depth_u16, float unit) {
    if (depth_u16.type() != CV_16UC1) throw std::runtime_error("depth image must be 16-bit with one channel");
    cv::Mat metres(depth_u16.size(), CV_32FC1);
    for (int v = 0; v < depth_u16.rows; v++) {
        const auto* from = depth_u16.ptr<std::uint16_t>(v);
        auto* to = metres.ptr<float>(v);
        for (int u = 0; u < depth_u16.cols; u++) to[u] = static_cast<float>(from[u]) * unit;
    }
    return metres;
}

cv::Mat toGrey(const cv::Mat& image) {
    cv::Mat grey;
    switch (image.type()) {
        case CV_8UC1:
            return image;
        case CV_8UC3:
            cv::cvtColor(image, grey, cv::COLOR_BGR2GRAY);
            return grey;
        case CV_8UC4:
            cv::cvtColor(image, grey, cv::COLOR_BGRA2GRAY);
            return grey;
        default:
            throw std::runtime_error("image must be 8-bit grey or colour, but has " +
                                     std::to_string(8 * image.elemSize1()) + " bits and " +
                                     std::to_string(image.channels()) + " channel(s)");
    }
}

}  // namespace roevo
