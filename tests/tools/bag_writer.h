#pragma once
/// Writes small ROS 1 bags for tests.

#include <geometry_msgs/TransformStamped.h>
#include <rosbag/bag.h>
#include <sensor_msgs/CameraInfo.h>
#include <sensor_msgs/CompressedImage.h>
#include <sensor_msgs/Image.h>
#include <tf2_msgs/TFMessage.h>

#include <Eigen/Geometry>
#include <cstdint>
#include <cstring>
#include <opencv2/core.hpp>
#include <string>
#include <vector>

namespace roevo::test {

inline constexpr int kBagWidth = 40, kBagHeight = 32;

inline const std::string kColourTopic = "/camera/rgb/image_color", kColourInfo = "/camera/rgb/camera_info";
inline const std::string kDepthTopic = "/camera/depth/image", kDepthInfo = "/camera/depth/camera_info";

/// Stamp of frame i, with nanoseconds that are no whole microseconds.
inline ros::Time stampOf(int i, int offset_ms = 0) {
    return ros::Time(1305031453 + static_cast<std::uint32_t>(i),
                     123456789 + 1000000 * static_cast<std::uint32_t>(offset_ms));
}
/// The same as the rawlog should have it.
inline double secondsOf(int i) {
    return 1305031453.123457 + i;
}

/// @param padding  unused bytes at the end of each row
inline sensor_msgs::Image imageMessage(const cv::Mat& image, const std::string& encoding,
                                       const std::string& frame, const ros::Time& stamp,
                                       std::uint32_t padding = 0) {
    sensor_msgs::Image message;
    message.header.stamp = stamp;
    message.header.frame_id = frame;
    message.width = static_cast<std::uint32_t>(image.cols);
    message.height = static_cast<std::uint32_t>(image.rows);
    message.encoding = encoding;
    const std::size_t row_bytes = static_cast<std::size_t>(image.cols) * image.elemSize();
    message.step = static_cast<std::uint32_t>(row_bytes) + padding;
    message.data.resize(static_cast<std::size_t>(message.step) * message.height, 0xAB);
    for (int v = 0; v < image.rows; v++)
        std::memcpy(&message.data[static_cast<std::size_t>(v) * message.step], image.ptr(v), row_bytes);
    return message;
}

inline sensor_msgs::CameraInfo infoMessage(const std::string& frame, const ros::Time& stamp, double fx = 60) {
    sensor_msgs::CameraInfo info;
    info.header.stamp = stamp;
    info.header.frame_id = frame;
    info.width = kBagWidth;
    info.height = kBagHeight;
    info.distortion_model = "plumb_bob";
    info.D = {0.1, -0.2, 0.001, 0.002, 0.3};
    info.K = {fx, 0, 15.5, 0, 61, 11.5, 0, 0, 1};
    info.P = {50, 0, 15, 0, 0, 51, 11, 0, 0, 0, 1, 0};
    return info;
}

/// A colour image in BGR of which every pixel is different.
inline cv::Mat colourImage(int i, int channels = 3) {
    cv::Mat image(kBagHeight, kBagWidth, CV_8UC(channels));
    for (int v = 0; v < image.rows; v++)
        for (int k = 0; k < image.cols * channels; k++)
            image.ptr(v)[k] = static_cast<std::uint8_t>(7 * v + 3 * k + 11 * i);
    return image;
}

/// Depth in millimetres with holes.
inline cv::Mat depthImage(int i) {
    cv::Mat image(kBagHeight, kBagWidth, CV_16UC1);
    for (int v = 0; v < image.rows; v++)
        for (int u = 0; u < image.cols; u++)
            image.at<std::uint16_t>(v, u) =
                static_cast<std::uint16_t>((u + v) % 9 == 0 ? 0 : 500 + 97 * u + 31 * v + i);
    return image;
}

class BagWriter {
  public:
    explicit BagWriter(const std::string& path) { bag.open(path, rosbag::bagmode::Write); }
    ~BagWriter() { bag.close(); }

    template <class Message>
    void add(const std::string& topic, const Message& message, const ros::Time& received) {
        bag.write(topic, received, message);
    }
    template <class Message>
    void add(const std::string& topic, const Message& message) {
        add(topic, message, message.header.stamp);
    }

    void colour(int i, const std::string& frame = "rgb_optical", const std::string& topic = kColourTopic) {
        add(topic, imageMessage(colourImage(i), "bgr8", frame, stampOf(i)));
    }
    void depth(int i, const std::string& frame = "rgb_optical", const std::string& topic = kDepthTopic) {
        add(topic, imageMessage(depthImage(i), "16UC1", frame, stampOf(i, 4)));
    }
    void info(const std::string& topic, const std::string& frame = "rgb_optical", double fx = 60) {
        add(topic, infoMessage(frame, stampOf(0), fx));
    }
    /// An ordinary recording with aligned depth.
    void frames(int count) {
        info(kColourInfo);
        info(kDepthInfo);
        for (int i = 0; i < count; i++) colour(i), depth(i);
    }
    void staticTransform(const std::string& parent, const std::string& child,
                         const Eigen::Isometry3d& T_parent_child) {
        const Eigen::Quaterniond q(T_parent_child.rotation());
        tf2_msgs::TFMessage message;
        message.transforms.resize(1);
        auto& stamped = message.transforms.front();
        stamped.header.frame_id = parent;
        stamped.child_frame_id = child;
        stamped.transform.translation.x = T_parent_child.translation().x();
        stamped.transform.translation.y = T_parent_child.translation().y();
        stamped.transform.translation.z = T_parent_child.translation().z();
        stamped.transform.rotation.w = q.w();
        stamped.transform.rotation.x = q.x();
        stamped.transform.rotation.y = q.y();
        stamped.transform.rotation.z = q.z();
        add("/tf_static", message, stampOf(0));
    }

    rosbag::Bag bag;
};

}  // namespace roevo::test
