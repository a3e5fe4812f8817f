// What the messages of bags hold: images of all encodings, cameras, frames.
#include <gtest/gtest.h>

#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include "mrpt/test_helpers.h"
#include "recordings/bags/bag_camera.h"
#include "recordings/bags/inverse_lens.h"
#include "recordings/bags/messages.h"
#include "roevo_mrpt/image_conversions.h"
#include "tools/ros_recording.h"
#include "tools/small_dataset.h"

namespace roevo {
namespace {

using namespace test;

class RosMessages : public testing::TestWithParam<Encoding> {
  protected:
    Wire wire() const { return GetParam() == Encoding::kRos1 ? Wire::kPacked : Wire::kCdr; }
};
INSTANTIATE_TEST_SUITE_P(Encodings, RosMessages,
                         testing::Values(Encoding::kRos1, Encoding::kCdrLittle, Encoding::kCdrBig));

TEST_P(RosMessages, HaveTheirFieldsWhateverLengthTheStringsBeforeThemHave) {
    for (const std::string frame : {"", "a", "ab", "abc", "/abcd", "abcdefgh"}) {
        const std::string plain = frame.substr(0, 1) == "/" ? frame.substr(1) : frame;
        const std::string image = imageMessage(GetParam(), 1305031453.123457, frame, tinyColour(0), "bgr8");
        const ImageMessage parsed = parseImage({image, wire()});
        EXPECT_EQ(parsed.header.timestamp, 1305031453.123457);
        EXPECT_EQ(parsed.header.frame_id, plain);
        EXPECT_EQ(parsed.width, 40u);
        EXPECT_EQ(parsed.step, 120u);
        EXPECT_EQ(parsed.data, pixelsOf(tinyColour(0)));
        EXPECT_EQ(parseStamp({std::string_view(image).substr(0, 12), wire()}), 1305031453.123457);

        const PinholeCamera camera = tinyCamera();
        const std::string info = infoMessage(GetParam(), frame, camera);
        const CameraInfoMessage read = parseCameraInfo({info, wire()});
        EXPECT_EQ(read.D, std::vector<double>(camera.distortion.begin(), camera.distortion.end()));
        EXPECT_EQ(read.K[4], camera.fy);
        EXPECT_EQ(read.P[6], camera.cy);

        const Pose pose =
            Pose(Eigen::Translation3d(1, 2, 3)) * Pose(Eigen::AngleAxisd(0.5, Eigen::Vector3d::UnitY()));
        const std::string transforms = transformsMessage(GetParam(), frame, frame + "x", pose);
        const auto tf = parseTransforms({transforms, wire()});
        ASSERT_EQ(tf.size(), 1u);
        EXPECT_EQ(tf[0].parent, plain);
        ASSERT_TRUE(tf[0].T_parent_child);
        EXPECT_TRUE(tf[0].T_parent_child->isApprox(pose, 1e-12));
    }
}

// Every message that is cut, and every count that is larger than what follows it.
TEST_P(RosMessages, ThatEndTooEarlyAreRefused) {
    const std::string info = infoMessage(GetParam(), "rgb", tinyCamera());
    const std::size_t unread = GetParam() == Encoding::kRos1 ? 9 : 16;  // behind the region of interest
    for (std::size_t size = 0; size + unread < info.size(); size++)
        EXPECT_THROW(parseCameraInfo({std::string_view(info).substr(0, size), wire()}), std::runtime_error)
            << size;
    const std::string image = imageMessage(GetParam(), 1, "rgb", tinyColour(0), "bgr8");
    for (std::size_t size = 0; size < image.size(); size++)
        EXPECT_THROW(parseImage({std::string_view(image).substr(0, size), wire()}), std::runtime_error)
            << size;
    const std::string text = "bgr8";
    for (std::size_t at = image.find(text) - 4; at < image.find(text); at++) {
        std::string wrong = image;
        wrong[at] = '\x7F';
        EXPECT_THROW(parseImage({wrong, wire()}), std::runtime_error) << at;
    }
}

/// A bag of single frames, in ROS 1's encoding, and what becomes of it.
class RosImages : public testing::Test {
  protected:
    void image(const cv::Mat& pixels, const std::string& encoding, const std::string& topic,
               bool big = false) {
        recording_.push_back({topic, "sensor_msgs/Image",
                              imageMessage(Encoding::kRos1, tinyStamp(0), "rgb", pixels, encoding, big)});
    }
    void compressed(const std::string& data, const std::string& format, const std::string& topic) {
        recording_.push_back({topic, "sensor_msgs/CompressedImage",
                              compressedMessage(Encoding::kRos1, tinyStamp(0), "rgb", format, data)});
    }
    DatasetReader open() {
        recording_.push_back(
            {kColourInfo, "sensor_msgs/CameraInfo", infoMessage(Encoding::kRos1, "rgb", tinyCamera())});
        const std::string path = writeRos1<'n'>(folder_ / "x.bag", recording_);
        recording_.clear();
        return openDataset(path);
    }
    TemporaryFolder folder_;
    Recording recording_;
};

TEST_F(RosImages, OfAllEncodings) {
    struct Case {
        const char* encoding;
        int code, channels;
    };
    for (const auto& [encoding, code, channels] :
         {Case{"rgb8", cv::COLOR_RGB2BGR, 3}, Case{"bgr8", -1, 3}, Case{"mono8", -1, 1}, Case{"8UC1", -1, 1},
          Case{"8UC3", -1, 3}, Case{"rgba8", cv::COLOR_RGBA2BGR, 4}, Case{"bgra8", cv::COLOR_BGRA2BGR, 4}}) {
        image(tinyColour(5, channels), encoding, kColour);
        image(tinyDepth(0), "16UC1", kDepth);
        cv::Mat expected = tinyColour(5, channels);
        if (code >= 0) cv::cvtColor(expected, expected, code);
        const DatasetReader bag = open();
        EXPECT_TRUE(same(bag.readImage(0), expected)) << encoding;
        EXPECT_TRUE(same(bag.readDepth(0), tinyDepth(0))) << encoding;
        EXPECT_EQ(bag.depthUnit(), 1e-3f);
    }
}

TEST_F(RosImages, WhoseRowsEndWithinAValueAreRefusedByName) {
    cv::Mat padded(32, 41, CV_16UC1, cv::Scalar(900));
    std::string message = imageMessage(Encoding::kRos1, tinyStamp(0), "rgb", padded, "16UC1");
    const auto put = [&](std::uint32_t from, std::uint32_t to) {  // the first such number
        const std::string bytes(reinterpret_cast<const char*>(&from), 4);
        const std::size_t at = message.find(bytes);
        ASSERT_NE(at, std::string::npos);
        message.replace(at, 4, reinterpret_cast<const char*>(&to), 4);
    };
    put(41, 40);
    put(82, 81);
    image(tinyColour(0), "bgr8", kColour);
    recording_.push_back({kDepth, "sensor_msgs/Image", message});
    EXPECT_CONTAINS(errorOf([&] { open().readDepth(0); }), "rows of 81 bytes");
}

TEST_F(RosImages, OfACameraOneOfWhoseMessagesIsDamaged) {
    image(tinyColour(0), "bgr8", kColour);
    image(tinyDepth(0), "16UC1", kDepth);
    recording_.push_back({kColourInfo, "sensor_msgs/CameraInfo", "cut"});
    const DatasetReader bag = open();  // a whole one follows
    EXPECT_NEAR(bag.camera().fx, tinyCamera().fx, 1e-9);
    EXPECT_TRUE(same(bag.readDepth(0), tinyDepth(0)));
}

TEST_F(RosImages, OfEitherByteOrder) {
    cv::Mat metres;
    tinyDepth(0).convertTo(metres, CV_32FC1, 1e-3);
    for (const cv::Mat& depth : {tinyDepth(0), metres}) {
        cv::Mat turned = depth.clone();
        for (std::size_t i = 0; i < turned.total(); i++)
            std::reverse(turned.data + i * turned.elemSize(), turned.data + (i + 1) * turned.elemSize());
        const bool is_metres = depth.depth() == CV_32F;
        image(tinyColour(0), "bgr8", kColour);
        image(turned, is_metres ? "32FC1" : "16UC1", kDepth, true);
        EXPECT_TRUE(same(open().readDepth(0), is_metres ? cv::Mat(5 * tinyDepth(0)) : tinyDepth(0)));
    }
}

TEST_F(RosImages, CompressedAsPngAndJpeg) {
    for (const char* format : {"bgr8; png compressed bgr8", "png"}) {
        compressed(encoded(".png", tinyColour(1)), format, kColour + "/compressed");
        compressed(encoded(".png", tinyDepth(1)),
                   std::string(format) == "png" ? "png" : "16UC1; png compressed ", kDepth + "/compressed");
        const DatasetReader bag = open();
        EXPECT_TRUE(same(bag.readImage(0), tinyColour(1))) << format;
        EXPECT_TRUE(same(bag.readDepth(0), tinyDepth(1))) << format;
        EXPECT_EQ(bag.depthUnit(), 1e-3f);
    }
    for (const char* format : {"rgb8; jpeg compressed bgr8", "jpeg"}) {
        const std::string jpeg = encoded(".jpg", tinyColour(2));
        compressed(jpeg, format, kColour + "/compressed");
        image(tinyDepth(0), "16UC1", kDepth);
        const std::vector<std::uint8_t> bytes(jpeg.begin(), jpeg.end());
        EXPECT_TRUE(same(open().readImage(0), cv::imdecode(bytes, cv::IMREAD_COLOR))) << format;
    }
}

TEST_F(RosImages, TheRawOnesAreTakenWhereBothWereRecorded) {
    image(tinyColour(0), "bgr8", kColour);
    compressed(encoded(".jpg", tinyColour(0)), "bgr8; jpeg compressed bgr8", kColour + "/compressed");
    image(tinyDepth(0), "16UC1", kDepth);
    compressed(std::string(12, '\0') + encoded(".png", tinyDepth(7)), "16UC1; compressedDepth",
               kDepth + "/compressedDepth");
    const DatasetReader bag = open();
    EXPECT_TRUE(same(bag.readImage(0), tinyColour(0)));
    EXPECT_TRUE(same(bag.readDepth(0), tinyDepth(0)));
}

/// What image_transport writes: kind of compression, two numbers, PNG.
std::string depthBytes(float a, float b, const cv::Mat& values) {
    FieldWriter head(Encoding::kRos1);
    return head.put(std::int32_t{1}).put(a).put(b).bytes() + encoded(".png", values);
}

TEST_F(RosImages, CompressedDepthOfMillimetresLosesNothing) {
    image(tinyColour(0), "bgr8", kColour);
    compressed(depthBytes(0, 0, tinyDepth(3)), "16UC1; compressedDepth png", kDepth + "/compressedDepth");
    const DatasetReader bag = open();
    EXPECT_TRUE(same(bag.readDepth(0), tinyDepth(3)));
    EXPECT_EQ(bag.depthUnit(), 1e-3f);
}

TEST_F(RosImages, CompressedDepthOfMetresIsAsGoodAsItsSteps) {
    // As the encoder takes them with depths up to 10 m and a quantisation of 100: value = a / depth + b
    const float a = 100 * 101, b = 1 - a / 10;
    cv::Mat values(32, 40, CV_16UC1, cv::Scalar(0));
    const cv::Mat depth = tinyDepth(0);
    for (int v = 0; v < depth.rows; v++)
        for (int u = 0; u < depth.cols; u++)
            if (const double metres = 1e-3 * depth.at<std::uint16_t>(v, u); metres > 0)
                values.at<std::uint16_t>(v, u) = static_cast<std::uint16_t>(a / metres + b);
    image(tinyColour(0), "bgr8", kColour);
    compressed(depthBytes(a, b, values), "32FC1; compressedDepth", kDepth + "/compressedDepth");
    const DatasetReader bag = open();
    const cv::Mat read = bag.toFrameDepth(bag.readDepth(0));
    for (int v = 0; v < depth.rows; v++)
        for (int u = 0; u < depth.cols; u++) {
            const double metres = 1e-3 * depth.at<std::uint16_t>(v, u);
            if (metres == 0)
                ASSERT_EQ(read.at<float>(v, u), 0);
            else  // one step of the inverse depth, and half of one of the 16 bits
                ASSERT_NEAR(read.at<float>(v, u), metres, 1.1 * metres * metres / a + 1.1e-4);
        }
}

// The head of a PNG with its right checksum claims gigabytes: they are not asked for.
TEST_F(RosImages, APngThatCannotHoldItsPixelsIsNotBelieved) {
    std::string png = encoded(".png", tinyDepth(0));
    for (const std::size_t side : {16, 20}) png.replace(side, 4, std::string("\0\0\x75\x30", 4));  // 30000
    const auto sum = crc32(0, reinterpret_cast<const Bytef*>(png.data()) + 12, 17);
    for (std::size_t i = 0; i < 4; i++) png[29 + i] = static_cast<char>(sum >> (24 - 8 * i) & 0xFF);
    image(tinyColour(0), "bgr8", kColour);
    compressed(png, "16UC1; png compressed ", kDepth + "/compressed");
    EXPECT_CONTAINS(errorOf([&] { open(); }), "30000x30000 pixels are not in");
    cv::Mat black(2000, 3000, CV_16UC1, cv::Scalar(0));  // as small as it gets
    const std::string small = encoded(".png", black);
    EXPECT_EQ(decodeDepth(small, "black").size(), black.size()) << small.size() << " bytes";
}

TEST_F(RosImages, CompressedDepthByRvlIsNamed) {
    image(tinyColour(0), "bgr8", kColour);
    compressed(std::string(40, '\1'), "16UC1; compressedDepth rvl", kDepth + "/compressedDepth");
    EXPECT_CONTAINS(errorOf([&] { open(); }), "RVL");
}

// A stream's folder stands for its frame; its transform maps points of the reference into it.
TEST_F(RosImages, OfRealSenseViewer) {
    const Pose T_colour_reference = Pose(Eigen::Translation3d(0.015, 1e-3, 2e-4)) *
                                    Pose(Eigen::AngleAxisd(0.02, Eigen::Vector3d(1, 2, 3).normalized()));
    const std::string device = "/device_0/sensor_";
    const std::string depth = device + "0/Depth_0", colour = device + "1/Color_0",
                      infrared = device + "0/Infrared_1";
    const auto add = [&](const std::string& stream, const cv::Mat& pixels, const char* encoding,
                         const PinholeCamera& camera, const Pose& T_stream_reference) {
        const std::string frame = stream == colour ? "1" : "0";
        std::string bytes = imageMessage(Encoding::kRos1, tinyStamp(0), frame, pixels, encoding);
        if (frame == "1") bytes += std::string(4, '\0');  // the depth unit that newer recordings add
        recording_.push_back({stream + "/image/data", "sensor_msgs/Image", bytes});
        recording_.push_back({stream + "/info/camera_info", "sensor_msgs/CameraInfo",
                              infoMessage(Encoding::kRos1, "0", camera, "Brown Conrady")});
        recording_.push_back({stream + "/tf/0", "geometry_msgs/Transform",
                              FieldWriter(Encoding::kRos1).transform(T_stream_reference).bytes()});
    };
    add(depth, tinyDepth(0), "mono16", tinyCamera(33), Pose::Identity());
    add(infrared, tinyColour(0, 1), "8UC1", tinyCamera(33), Pose::Identity());
    add(colour, tinyColour(0), "rgb8", tinyCamera(60), T_colour_reference);
    recording_.push_back({device + "0/option/Depth Units/value", "std_msgs/Float32",
                          FieldWriter(Encoding::kRos1).put(0.00025f).bytes()});
    const DatasetReader bag = openDataset(writeRos1<'l'>(folder_ / "viewer.bag", recording_));
    EXPECT_EQ(bag.camera(), tinyCamera(60));
    EXPECT_EQ(bag.depthScale(), 4000);
    EXPECT_TRUE(same(bag.readDepth(0), tinyDepth(0)));
    ASSERT_TRUE(bag.description().registration);
    EXPECT_EQ(bag.depthCamera(), tinyCamera(33));
    EXPECT_TRUE(bag.description().registration->T_colour_depth.isApprox(T_colour_reference, 1e-9));
}

/// Depth in a frame of its own; transforms are added by the test.
class RosFrames : public RosImages {
  protected:
    void SetUp() override {
        image(tinyColour(0), "bgr8", kColour);
        recording_.push_back({kDepth, "sensor_msgs/Image",
                              imageMessage(Encoding::kRos1, tinyStamp(0), "ir", tinyDepth(0), "16UC1")});
        recording_.push_back(
            {kDepthInfo, "sensor_msgs/CameraInfo", infoMessage(Encoding::kRos1, "ir", tinyCamera(33))});
    }
    void transform(const char* topic, const char* parent, const char* child, const Pose& T_parent_child) {
        recording_.push_back({topic, std::string(topic) == "/tf" ? "tf/tfMessage" : "tf2_msgs/TFMessage",
                              transformsMessage(Encoding::kRos1, parent, child, T_parent_child)});
    }
    static Pose shift(double x) { return Pose(Eigen::Translation3d(x, 0.02, -0.01)); }
};

TEST_F(RosFrames, AreJoinedByTfWhereThereIsNoTfStatic) {
    for (int i = 0; i < 3; i++) {
        transform("/tf", "world", "link", shift(0.1 * i));  // the robot moves
        transform("/tf", "link", "rgb", shift(0.3));
        transform("/tf", "link", "ir", shift(0.35));
    }
    const DatasetReader bag = open();
    ASSERT_TRUE(bag.description().registration);
    const Pose expected = shift(0.3).inverse() * shift(0.35);
    EXPECT_TRUE(bag.description().registration->T_colour_depth.isApprox(expected, 1e-9));
}

TEST_F(RosFrames, ThatMoveAgainstOneAnotherDoNotCount) {
    for (int i = 0; i < 3; i++) {
        transform("/tf", "link", "rgb", shift(0.3 + 0.01 * i));
        transform("/tf", "link", "ir", shift(0.35));
    }
    const std::string error = errorOf([&] { open(); });
    EXPECT_CONTAINS(error, "'ir' and 'rgb'");
    EXPECT_CONTAINS(error, "record /tf_static");
}

TEST(CameraInfo, OfAPartOfTheSensorIsThatOfTheImage) {
    CameraInfoMessage message;
    message.width = 1280, message.height = 960;
    message.K = {1000, 0, 640, 0, 900, 480, 0, 0, 1};
    message.P = {1000, 0, 640, 0, 0, 900, 480, 0, 0, 0, 1, 0};
    message.roi_x = 100, message.roi_y = 40, message.roi_width = 800, message.roi_height = 600;
    message.binning_x = message.binning_y = 2;
    for (const bool rectified : {false, true}) {
        const PinholeCamera camera = cameraOf(message, rectified, false);
        EXPECT_EQ(camera.width, 400);
        EXPECT_EQ(camera.height, 300);
        EXPECT_EQ(camera.fx, 500);
        EXPECT_EQ(camera.fy, 450);
        EXPECT_EQ(camera.cx, 270);
        EXPECT_EQ(camera.cy, 220);
    }
}

TEST(InverseLens, IsThatOfDepthOnly) {
    CameraInfoMessage message;
    message.width = 1280, message.height = 720;
    message.K = {640, 0, 645, 0, 639, 362, 0, 0, 1};
    message.distortion_model = "Inverse Brown Conrady";
    message.D = {-0.056, 0.067, -7e-4, 4e-4, -0.021};
    const auto terms = cameraOf(message, false, false).distortion;
    EXPECT_EQ(std::vector<double>(terms.begin(), terms.end()), message.D);
    EXPECT_GT(cameraOf(message, false, true).distortion[0], 0.05);
}

// Of a D455's colour camera, about. Rays by the definition of the inverse model; our lens must lead them
// back.
TEST(InverseLens, LeadsEveryRayBackToItsPixel) {
    PinholeCamera camera;
    camera.width = 1280, camera.height = 720;
    camera.fx = 640, camera.fy = 639, camera.cx = 645, camera.cy = 362;
    const double k1 = -0.056, k2 = 0.067, p1 = -7e-4, p2 = 4e-4, k3 = -0.021;
    const PinholeCamera ideal = camera;
    camera.distortion = distortionOfInverse(ideal, {k1, k2, p1, p2, k3});
    double largest = 0;
    for (int v = 0; v < 720; v += 17)
        for (int u = 0; u < 1280; u += 17) {
            const double x = (u - ideal.cx) / ideal.fx, y = (v - ideal.cy) / ideal.fy, r2 = x * x + y * y;
            const double radial = 1 + r2 * (k1 + r2 * (k2 + r2 * k3));
            const Eigen::Vector2d ray(x * radial + 2 * p1 * x * y + p2 * (r2 + 2 * x * x),
                                      y * radial + 2 * p2 * x * y + p1 * (r2 + 2 * y * y));
            const Eigen::Vector2d undistorted(ideal.fx * ray.x() + ideal.cx, ideal.fy * ray.y() + ideal.cy);
            largest = std::max(largest, (camera.distortPixel(undistorted) - Eigen::Vector2d(u, v)).norm());
        }
    EXPECT_LT(largest, 0.1 * std::sqrt(2));
    EXPECT_GT((ideal.distortPixel({0, 0}) - camera.distortPixel({0, 0})).norm(), 1)
        << "there is something to fit";
    EXPECT_CONTAINS(errorOf([&] { distortionOfInverse(ideal, {9, -9, 0, 0, 9}); }), "pixels off");
    EXPECT_CONTAINS(errorOf([&] { distortionOfInverse(ideal, {NAN, 0, 0, 0, 0}); }), "pixels off");
}

}  // namespace
}  // namespace roevo
