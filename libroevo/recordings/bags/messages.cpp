#include "recordings/bags/messages.h"

#include <Eigen/Geometry>
#include <cmath>
#include <stdexcept>

namespace roevo {
namespace {

/// To the microsecond: whole numbers below 2^53 divide to the nearest double.
double readStamp(FieldReader& in) {
    if (in.wire() == Wire::kPacked) in.skip(4);  // ROS 1 counts its messages
    const auto seconds = in.get<std::uint32_t>();
    const double micro = std::round(in.get<std::uint32_t>() / 1e3);
    return (seconds * 1e6 + micro) / 1e6;
}

std::string readFrameId(FieldReader& in) {
    const std::string id = in.text();
    return id.substr(0, 1) == "/" ? id.substr(1) : id;
}

MessageHeader readHeader(FieldReader& in) {
    const double stamp = readStamp(in);
    return {stamp, readFrameId(in)};
}

std::optional<Pose> readTransform(FieldReader& in) {
    Eigen::Vector3d t;
    Eigen::Vector4d q;  // x y z w
    for (double& value : t) value = in.get<double>();
    for (double& value : q) value = in.get<double>();
    if (!t.allFinite() || !(std::abs(q.norm() - 1) < 1e-2)) return std::nullopt;
    Pose pose = Pose::Identity();
    pose.setRotation(Eigen::Quaterniond(q).normalized().toRotationMatrix());
    pose.translation() = t;
    return pose;
}

/// CDR may be padded; ROS 1 is not, and what is left over is a message of another definition.
void requireEnd(const FieldReader& in) {
    if (in.wire() == Wire::kPacked && in.left() > 0)
        throw std::runtime_error(std::to_string(in.left()) +
                                 " bytes longer than such a message (another version of it?)");
}

}  // namespace

ImageMessage parseImage(const MessageBytes& message) {
    FieldReader in(message.bytes, message.wire);
    ImageMessage out;
    out.header = readHeader(in);
    out.height = in.get<std::uint32_t>();
    out.width = in.get<std::uint32_t>();
    out.encoding = in.text();
    out.big_endian = in.get<std::uint8_t>() != 0;
    out.step = in.get<std::uint32_t>();
    out.data = in.blob();
    // Newer RealSense recordings add the depth unit to images, and say so where the frame's name belongs
    if (message.wire == Wire::kPacked && out.header.frame_id == "1" && in.left() == sizeof(float)) return out;
    requireEnd(in);
    return out;
}

CompressedImageMessage parseCompressedImage(const MessageBytes& message) {
    FieldReader in(message.bytes, message.wire);
    CompressedImageMessage out;
    out.header = readHeader(in);
    out.format = in.text();
    out.data = in.blob();
    requireEnd(in);
    return out;
}

CameraInfoMessage parseCameraInfo(const MessageBytes& message) {
    FieldReader in(message.bytes, message.wire);
    CameraInfoMessage out;
    out.header = readHeader(in);
    out.height = in.get<std::uint32_t>();
    out.width = in.get<std::uint32_t>();
    out.distortion_model = in.text();
    out.D = in.doubles();
    for (double& value : out.K) value = in.get<double>();
    for (int i = 0; i < 9; i++) in.get<double>();  // R, of stereo cameras
    for (double& value : out.P) value = in.get<double>();
    for (std::uint32_t* value :
         {&out.binning_x, &out.binning_y, &out.roi_x, &out.roi_y, &out.roi_height, &out.roi_width})
        *value = in.get<std::uint32_t>();
    return out;
}

std::vector<TransformMessage> parseTransforms(const MessageBytes& message) {
    FieldReader in(message.bytes, message.wire);
    std::vector<TransformMessage> out;
    for (auto count = in.get<std::uint32_t>(); count > 0; count--) {
        TransformMessage& transform = out.emplace_back();
        transform.parent = readHeader(in).frame_id;
        transform.child = readFrameId(in);
        transform.T_parent_child = readTransform(in);
    }
    requireEnd(in);
    return out;
}

std::optional<Pose> parseTransform(const MessageBytes& message) {
    FieldReader in(message.bytes, message.wire);
    return readTransform(in);
}

float parseFloat(const MessageBytes& message) {
    return FieldReader(message.bytes, message.wire).get<float>();
}

double parseStamp(const MessageBytes& message) {
    FieldReader in(message.bytes, message.wire);
    return readStamp(in);
}

}  // namespace roevo
