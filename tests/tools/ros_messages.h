#pragma once
/// Messages as ROS 1 and ROS 2 write them, made from the definitions of their fields and the two encodings.

#include <array>
#include <cstdint>
#include <cstring>
#include <opencv2/core.hpp>
#include <string>
#include <utility>
#include <vector>

#include "roevo/camera/pinhole_camera.h"
#include "roevo/types.h"

namespace roevo::test {

enum class Encoding { kRos1, kCdrLittle, kCdrBig };

/// Writes fields one after the other.
class FieldWriter {
  public:
    explicit FieldWriter(Encoding encoding) : encoding_(encoding) {
        if (encoding != Encoding::kRos1) bytes_ = std::string("\0\1\0\0", 4);
        if (encoding == Encoding::kCdrBig) bytes_[1] = 0;
    }

    template <class T>
    FieldWriter& put(T value) {
        if (encoding_ != Encoding::kRos1)
            while ((bytes_.size() - 4) % sizeof(T) != 0) bytes_ += '\0';
        char raw[sizeof(T)];
        std::memcpy(raw, &value, sizeof value);
        for (std::size_t i = 0; i < sizeof value; i++)
            bytes_ += raw[encoding_ == Encoding::kCdrBig ? sizeof value - 1 - i : i];
        return *this;
    }
    FieldWriter& text(const std::string& value) {
        const bool zero = encoding_ != Encoding::kRos1;
        put(static_cast<std::uint32_t>(value.size() + (zero ? 1 : 0)));
        bytes_ += value;
        if (zero) bytes_ += '\0';
        return *this;
    }
    FieldWriter& blob(const std::string& value) {
        put(static_cast<std::uint32_t>(value.size()));
        bytes_ += value;
        return *this;
    }
    FieldWriter& numbers(const std::vector<double>& values) {
        for (const double value : values) put(value);
        return *this;
    }
    FieldWriter& header(double stamp, const std::string& frame) {
        const auto micro = static_cast<std::uint64_t>(stamp * 1e6 + 0.5);
        if (encoding_ == Encoding::kRos1) put(std::uint32_t{7});
        put(static_cast<std::uint32_t>(micro / 1000000));
        put(static_cast<std::uint32_t>(micro % 1000000 * 1000));
        return text(frame);
    }
    FieldWriter& transform(const Pose& pose) {
        const Eigen::Quaterniond q(pose.linear());
        const auto& t = pose.translation();
        return numbers({t.x(), t.y(), t.z(), q.x(), q.y(), q.z(), q.w()});
    }

    const std::string& bytes() const { return bytes_; }

  private:
    Encoding encoding_;
    std::string bytes_;
};

inline std::string pixelsOf(const cv::Mat& image, std::size_t padding = 0) {
    std::string out;
    for (int v = 0; v < image.rows; v++) {
        out.append(reinterpret_cast<const char*>(image.ptr(v)),
                   static_cast<std::size_t>(image.cols) * image.elemSize());
        out.append(padding, '\xAB');
    }
    return out;
}

/// sensor_msgs/Image
inline std::string imageMessage(Encoding encoding, double stamp, const std::string& frame,
                                const cv::Mat& image, const std::string& pixels, bool big_endian = false) {
    FieldWriter out(encoding);
    out.header(stamp, frame);
    out.put(static_cast<std::uint32_t>(image.rows)).put(static_cast<std::uint32_t>(image.cols));
    out.text(pixels).put(static_cast<std::uint8_t>(big_endian));
    out.put(static_cast<std::uint32_t>(static_cast<std::size_t>(image.cols) * image.elemSize()));
    out.blob(pixelsOf(image));
    return out.bytes();
}

/// sensor_msgs/CompressedImage
inline std::string compressedMessage(Encoding encoding, double stamp, const std::string& frame,
                                     const std::string& format, const std::string& data) {
    return FieldWriter(encoding).header(stamp, frame).text(format).blob(data).bytes();
}

/// sensor_msgs/CameraInfo
inline std::string infoMessage(Encoding encoding, const std::string& frame, const PinholeCamera& c,
                               const std::string& model = "plumb_bob") {
    FieldWriter out(encoding);
    out.header(1, frame);
    out.put(static_cast<std::uint32_t>(c.height)).put(static_cast<std::uint32_t>(c.width)).text(model);
    out.put(std::uint32_t{5});
    out.numbers({c.distortion.begin(), c.distortion.end()});
    out.numbers({c.fx, 0, c.cx, 0, c.fy, c.cy, 0, 0, 1});
    out.numbers({1, 0, 0, 0, 1, 0, 0, 0, 1});
    out.numbers({c.fx, 0, c.cx, 0, 0, c.fy, c.cy, 0, 0, 0, 1, 0});
    out.put(std::uint32_t{0}).put(std::uint32_t{0});
    for (int i = 0; i < 4; i++) out.put(std::uint32_t{0});
    out.put(std::uint8_t{0});
    return out.bytes();
}

/// tf2_msgs/TFMessage with one transform
inline std::string transformsMessage(Encoding encoding, const std::string& parent, const std::string& child,
                                     const Pose& T_parent_child) {
    FieldWriter out(encoding);
    return out.put(std::uint32_t{1}).header(1, parent).text(child).transform(T_parent_child).bytes();
}

}  // namespace roevo::test
