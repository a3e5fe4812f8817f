#pragma once
/// The messages of ROS that an RGB-D recording is made of, as ROS 1 and ROS 2 both write them.

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "recordings/bags/field_reader.h"
#include "roevo/types.h"

namespace roevo {

/// A message's bytes and how to read them.
struct MessageBytes {
    std::string_view bytes;
    Wire wire = Wire::kPacked;
};

struct MessageHeader {
    double timestamp = 0;  ///< s, to the microsecond; 0 when the message has none
    std::string frame_id;  ///< without the leading '/' of older recordings
};

/// sensor_msgs/Image
struct ImageMessage {
    MessageHeader header;
    std::uint32_t height = 0, width = 0, step = 0;
    std::string encoding;
    bool big_endian = false;
    std::string_view data;
};

/// sensor_msgs/CompressedImage
struct CompressedImageMessage {
    MessageHeader header;
    std::string format;
    std::string_view data;
};

/// sensor_msgs/CameraInfo, what is used of it
struct CameraInfoMessage {
    MessageHeader header;
    std::uint32_t height = 0, width = 0;
    std::string distortion_model;
    std::vector<double> D;
    std::array<double, 9> K{};
    std::array<double, 12> P{};
    std::uint32_t binning_x = 0, binning_y = 0;                         ///< 0 as 1
    std::uint32_t roi_x = 0, roi_y = 0, roi_height = 0, roi_width = 0;  ///< of the sensor; no size: all of it
};

/// geometry_msgs/TransformStamped
struct TransformMessage {
    std::string parent, child;           ///< names of frames, without leading '/'
    std::optional<Pose> T_parent_child;  ///< none when it is not finite or its quaternion has not length one
};

/// Each throws std::runtime_error in one line where the bytes are not such a message. What they return refers
/// to the bytes.
ImageMessage parseImage(const MessageBytes& message);
CompressedImageMessage parseCompressedImage(const MessageBytes& message);
CameraInfoMessage parseCameraInfo(const MessageBytes& message);
std::vector<TransformMessage> parseTransforms(const MessageBytes& message);  ///< tf2_msgs/TFMessage
std::optional<Pose> parseTransform(const MessageBytes& message);             ///< geometry_msgs/Transform
float parseFloat(const MessageBytes& message);                               ///< std_msgs/Float32

/// The stamp alone, for which the first 12 bytes of any message with a header do; s, to the microsecond.
double parseStamp(const MessageBytes& message);

}  // namespace roevo
