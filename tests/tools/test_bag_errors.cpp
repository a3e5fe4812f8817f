// bag2rawlog: bags that cannot be converted, or not whole.
#include <gtest/gtest.h>
#include <sys/stat.h>

#include "support/environment.h"
#include "tools/bag_fixture.h"

namespace roevo {
namespace {

using namespace test;

class Bag2RawlogErrors : public Bag2Rawlog {};

TEST_F(Bag2RawlogErrors, WrongUsage) {
    expectError(runProgram(kName, {}), 2, kName, {"--input"});
    expectError(runProgram(kName, {"--input", "x.bag"}), 2, kName, {"--output is required"});
    expectError(runProgram(kName, {"--input", "x.bag", "--output", "x.bag"}), 2, kName, {".rawlog"});
    expectError(runProgram(kName, {"--no-such-option"}), 2, kName, {"--no-such-option"});
    const auto help = runProgram(kName, {"--help"});
    EXPECT_EQ(help.exit_code, 0);
    EXPECT_NE(help.out.find("\n  bag2rawlog --input"), std::string::npos) << help.out;
}

TEST_F(Bag2RawlogErrors, NoSuchFile) {
    expectRefusal({"recording.bag", "no such file"});
}

TEST_F(Bag2RawlogErrors, APipeIsNotWaitedFor) {
    ASSERT_EQ(mkfifo(bagPath().c_str(), 0600), 0);
    expectError(runForSeconds(10, kName, {"--input", bagPath(), "--list"}), 1, kName,
                {"recording.bag", "it is a pipe"});
}

TEST_F(Bag2RawlogErrors, LeavesNothingInTheHomeDirectory) {
    // Debian's ROS libraries put a cache into ~/.ros
    const std::string home = std::filesystem::path(bagPath()).parent_path() / "home";
    std::filesystem::create_directory(home);
    const test::WithEnvironment with("HOME", home);
    expectRefusal({"recording.bag", "no such file"});
    write([](BagWriter& bag) { bag.frames(2); });
    std::filesystem::remove_all(home + "/.ros");  // of this process, which wrote the bag
    EXPECT_EQ(runProgram(kName, {"--input", bagPath(), "--list"}).exit_code, 0);
    EXPECT_TRUE(std::filesystem::is_empty(home));
}

TEST_F(Bag2RawlogErrors, NoBag) {
    writeFile(bagPath(), "just a text, but a long one");
    expectRefusal({"recording.bag", "not a ROS bag"});
    writeFile(bagPath(), "");
    expectRefusal({"recording.bag", "not a ROS bag"});
}

TEST_F(Bag2RawlogErrors, RecordingsOfRos2ThatAreNone) {
    writeFile(bagPath(), std::string("SQLite format 3\0 and so on", 26));
    expectRefusal({"recording.bag", "SQLite", "ros2 bag reindex"});
    writeFile(bagPath(), "\x89MCAP0\r\n");
    expectRefusal({"recording.bag", "MCAP", "mcap recover"});
    std::filesystem::remove(bagPath());
    std::filesystem::create_directory(bagPath());
    expectRefusal({"recording.bag", "neither .db3 nor .mcap files"});
    writeFile(bagPath() + "/metadata.yaml", "rosbag2_bagfile_information:\n");
    expectRefusal({"recording.bag", "neither .db3 nor .mcap files"});
}

TEST_F(Bag2RawlogErrors, TruncatedAnywhere) {
    write([](BagWriter& bag) { bag.frames(3); });
    const std::string whole = readFile(bagPath());
    for (const double share : {0.001, 0.01, 0.2, 0.5, 0.9, 0.999}) {
        writeFile(bagPath(),
                  whole.substr(0, static_cast<std::size_t>(share * static_cast<double>(whole.size()))));
        expectRefusal({"recording.bag"});
    }
    writeFile(bagPath(), whole.substr(0, whole.size() / 2));
    expectRefusal({"truncated", "rosbag reindex"});
}

TEST_F(Bag2RawlogErrors, EmptyBag) {
    write([](BagWriter&) {});
    expectRefusal({"recording.bag", "empty"});
}

TEST_F(Bag2RawlogErrors, NoDepthTopicSaysWhatThereIs) {
    write([](BagWriter& bag) { bag.info(kColourInfo), bag.colour(0), bag.colour(1); });
    expectRefusal(
        {"no topic with depth", kColourTopic, "bgr8, 2 messages", "sensor_msgs/CameraInfo, 1 message)"});
}

TEST_F(Bag2RawlogErrors, NoColourTopicSaysWhatThereIs) {
    write([](BagWriter& bag) { bag.info(kDepthInfo), bag.depth(0); });
    expectRefusal({"no topic with colour", kDepthTopic, "16UC1, 1 message)"});
}

TEST_F(Bag2RawlogErrors, SeveralTopicsMustBeChosenFrom) {
    write([](BagWriter& bag) {
        bag.frames(1);
        bag.colour(0, "left_optical", "/left/image_raw");
        bag.info("/left/camera_info", "left_optical", 71);
    });
    expectRefusal({"several topics with colour", "--colour-topic", kColourTopic, "/left/image_raw"});
    EXPECT_EQ(colourCameraOf(*scans({"--colour-topic", kColourTopic}).at(0)).fx, 60);

    write([](BagWriter& bag) {
        bag.frames(1);
        bag.depth(5, "rgb_optical", "/filtered/image");
    });
    expectRefusal({"several topics with depth", "--depth-topic", kDepthTopic, "/filtered/image"});
    EXPECT_TRUE(same(rangeImageOf(*scans({"--depth-topic", kDepthTopic}).at(0)), depthImage(0)));
}

TEST_F(Bag2RawlogErrors, NamedTopicsMustBeThereAndFit) {
    write([](BagWriter& bag) {
        bag.frames(1);
        bag.info("/other/camera_info", "other", 75);
    });
    expectRefusal({"no topic /nowhere", kColourTopic}, {"--colour-topic", "/nowhere"});
    expectRefusal({kColourInfo, "sensor_msgs/CameraInfo", "wanted"}, {"--depth-topic", kColourInfo});
    expectRefusal({kColourTopic, "bgr8", "no depth image"}, {"--depth-topic", kColourTopic});
    expectRefusal({kDepthTopic, "16UC1", "colour or grey"}, {"--colour-topic", kDepthTopic});
    expectRefusal({kDepthTopic, "wanted"}, {"--info-topic", kDepthTopic});
    EXPECT_EQ(colourCameraOf(*scans({"--info-topic", "/other/camera_info"}).at(0)).fx, 75);
}

TEST_F(Bag2RawlogErrors, NoCameraInfo) {
    write([](BagWriter& bag) {
        bag.colour(0), bag.depth(0);
        bag.info("/other/camera_info", "other");
    });
    expectRefusal({"no camera_info for " + kColourTopic, "--info-topic", "/other/camera_info"});
}

TEST_F(Bag2RawlogErrors, CompressedImagesThatAreNone) {
    write([](BagWriter& bag) {
        bag.info(kColourInfo);
        sensor_msgs::CompressedImage image;
        image.header.stamp = stampOf(0, 4);
        image.format = "jpeg";
        image.data.assign(100, 1);
        bag.add(kColourTopic + "/compressed", image);
        bag.depth(0, "");
    });
    expectRefusal({"no usable frame", kColourTopic + "/compressed, message 1", "cannot decode image"});
}

TEST_F(Bag2RawlogErrors, OtherEncodings) {
    for (const char* encoding : {"bayer_rggb8", "yuv422", "rgb16", ""}) {
        write([&](BagWriter& bag) {
            bag.info(kColourInfo);
            bag.add(kColourTopic, imageMessage(colourImage(0), encoding, "rgb_optical", stampOf(0)));
            bag.depth(0);
        });
        expectRefusal({kColourTopic, encoding});
        expectRefusal({kColourTopic, encoding, "rgb8"}, {"--colour-topic", kColourTopic});
    }
    write([&](BagWriter& bag) {
        bag.info(kColourInfo);
        bag.colour(0);
        bag.add(kDepthTopic, imageMessage(depthImage(0), "mono16", "rgb_optical", stampOf(0)));
    });
    expectRefusal({"no topic with depth", "mono16"});
    EXPECT_TRUE(same(rangeImageOf(*scans({"--depth-topic", kDepthTopic}).at(0)), depthImage(0)));
}

TEST_F(Bag2RawlogErrors, UnalignedDepthWithoutExtrinsicsOrIntrinsics) {
    write([](BagWriter& bag) {
        bag.info(kColourInfo);
        bag.info(kDepthInfo, "depth_optical");
        bag.colour(0), bag.depth(0, "depth_optical");
        bag.staticTransform("base", "rgb_optical", Eigen::Isometry3d::Identity());
    });
    expectRefusal({"not aligned", "/tf_static", "'depth_optical'", "'rgb_optical'"});
    write([](BagWriter& bag) {
        bag.info(kColourInfo);
        bag.colour(0), bag.depth(0, "depth_optical");
        bag.staticTransform("depth_optical", "rgb_optical", Eigen::Isometry3d::Identity());
    });
    expectRefusal({kDepthTopic, "'depth_optical'", "no camera_info", "--depth-info-topic"});
}

TEST_F(Bag2RawlogErrors, UnusableIntrinsics) {
    const auto withInfo = [&](const std::function<void(sensor_msgs::CameraInfo&)>& change) {
        write([&](BagWriter& bag) {
            auto info = infoMessage("rgb_optical", stampOf(0));
            change(info);
            bag.add(kColourInfo, info);
            bag.colour(0), bag.depth(0);
        });
    };
    withInfo([](auto& info) { info.K.assign(0); });
    expectRefusal({kColourInfo, "not calibrated"});
    withInfo([](auto& info) { info.K[0] = std::nan(""); });
    expectRefusal({kColourInfo});
    withInfo([](auto& info) { info.distortion_model = "omnidirectional"; });
    expectRefusal({kColourInfo, "omnidirectional", "plumb_bob", "equidistant"});
    withInfo([](auto& info) { info.distortion_model = "equidistant"; });
    expectRefusal({kColourInfo, "equidistant", "5 coefficients"});
    withInfo([](auto& info) { info.distortion_model = "rational_polynomial", info.D.resize(12, 0.1); });
    expectRefusal({kColourInfo, "rational_polynomial", "12 coefficients"});
    withInfo([](auto& info) { info.width = 640, info.height = 480; });
    expectRefusal({kColourTopic, "40x32", "640x480"});
}

TEST_F(Bag2RawlogErrors, NothingWithinTheAllowedTime) {
    write([](BagWriter& bag) { bag.frames(2); });
    expectRefusal({"within 0.001 s", "2 colour, 2 depth", "0.004 s apart", "--max-dt"},
                  {"--max-dt", "0.001"});
}

TEST_F(Bag2RawlogErrors, BadMessagesAreLeftOutAndNamed) {
    write([](BagWriter& bag) {
        bag.frames(2);
        auto image = imageMessage(colourImage(2), "bgr8", "rgb_optical", stampOf(2));
        image.data.resize(100);
        bag.add(kColourTopic, image), bag.depth(2);
        bag.colour(3);
        bag.add(kDepthTopic,
                imageMessage(cv::Mat(10, 10, CV_16UC1, cv::Scalar(9)), "16UC1", "rgb_optical", stampOf(3)));
        bag.add(kColourTopic, imageMessage(colourImage(4), "bgr8", "rgb_optical", ros::Time(0, 0)),
                stampOf(4));
        bag.colour(5);
        bag.add(kDepthTopic, imageMessage(cv::Mat(kBagHeight, kBagWidth, CV_32FC1, cv::Scalar(1)), "32FC1",
                                          "rgb_optical", stampOf(5)));
        bag.colour(6), bag.depth(6);
    });
    const auto all = scans();
    ASSERT_EQ(all.size(), 3u);
    EXPECT_TRUE(same(toRgbdFrame(*all[2]).colour, colourImage(6)));
    for (const char* words : {kColourTopic.c_str(), "message 3", "100 bytes is too short", "10x10",
                              "no time stamp", "32FC1, where others have 16UC1", "3 frames written"})
        EXPECT_TRUE(said(words)) << words << "\n" << result_.all();
}

TEST_F(Bag2RawlogErrors, ADamagedPieceCostsItsFramesOnly) {
    write([](BagWriter& bag) {
        bag.bag.setCompression(rosbag::compression::BZ2);
        bag.bag.setChunkThreshold(1000);  // a chunk for every image
        bag.frames(6);
    });
    std::string bytes = readFile(bagPath());
    std::size_t hit = bytes.find("BZh", bytes.size() / 2);
    ASSERT_NE(hit, std::string::npos);
    for (std::size_t i = hit + 20; i < hit + 60; i++) bytes[i] = static_cast<char>(bytes[i] ^ 0x5A);
    writeFile(bagPath(), bytes);
    const auto all = scans();
    EXPECT_EQ(all.size(), 5u);
    EXPECT_TRUE(said("left out: ")) << result_.all();
}

TEST_F(Bag2RawlogErrors, AllMessagesBad) {
    write([](BagWriter& bag) {
        bag.info(kColourInfo);
        auto image = imageMessage(colourImage(0), "bgr8", "rgb_optical", stampOf(0));
        image.data.clear();
        bag.add(kColourTopic, image), bag.depth(0);
    });
    expectRefusal({"no usable frame", kColourTopic, "too short"});
}

TEST_F(Bag2RawlogErrors, CameraInfoThatChangesIsReported) {
    write([](BagWriter& bag) {
        bag.frames(2);
        bag.add(kColourInfo, infoMessage("rgb_optical", stampOf(1), 77));
    });
    EXPECT_EQ(colourCameraOf(*scans().at(0)).fx, 60);
    EXPECT_TRUE(said("1 of 2 messages differ")) << result_.all();
}

TEST_F(Bag2RawlogErrors, ListNamesTopicsTypesAndCounts) {
    write([](BagWriter& bag) { bag.frames(4); });
    const auto result = runProgram(kName, {"--input", bagPath(), "--list"});
    EXPECT_EQ(result.exit_code, 0) << result.all();
    for (const std::string& words :
         {kColourTopic, std::string("4  sensor_msgs/Image, bgr8, frame rgb_optical"), kDepthInfo,
          std::string("1  sensor_msgs/CameraInfo, frame rgb_optical")})
        EXPECT_NE(result.out.find(words), std::string::npos) << words << "\n" << result.out;
}

TEST_F(Bag2RawlogErrors, OutputThatCannotBeWritten) {
    write([](BagWriter& bag) { bag.frames(1); });
    expectError(runProgram(kName, {"--input", bagPath(), "--output", folder_ / "none/out.rawlog"}), 1, kName,
                {"none/out.rawlog", "none does not exist: create it"});
}

TEST_F(Bag2RawlogErrors, AnOlderGroundTruthOfSomethingElseIsPointedOut) {
    write([](BagWriter& bag) { bag.frames(1); });
    scans();
    EXPECT_EQ(result_.err.find("warning: "), std::string::npos) << result_.err;
    writeFile(folder_ / "out_groundtruth.txt", "1 0 0 0 0 0 0 1\n");
    scans();
    EXPECT_NE(result_.err.find("bag2rawlog: warning: " + (folder_ / "out_groundtruth.txt")),
              std::string::npos)
        << result_.err;
}

TEST_F(Bag2RawlogErrors, AGroundTruthGoesWithTheRawlogAndIsNotWrittenOver) {
    write([](BagWriter& bag) { bag.frames(1); });
    const std::string text = "# mine\n100 1 2 3 0 0 0 1\n", truth = folder_ / "out_groundtruth.txt";
    writeFile(folder_ / "mine.txt", text);
    const std::vector<std::string> both{"--input", bagPath(), "--output", folder_ / "out.rawlog"};
    auto named = both;
    named.insert(named.end(), {"--ground-truth", folder_ / "mine.txt"});
    ASSERT_EQ(runProgram(kName, named).exit_code, 0);
    EXPECT_NE(test::readFile(truth).find(" 1.000000000000 2.000000000000 3.000000000000 "),
              std::string::npos);
    writeFile(truth, text);
    named.back() = truth;
    expectError(runProgram(kName, named), 2, kName, {truth});
    EXPECT_EQ(test::readFile(truth), text);
}

}  // namespace
}  // namespace roevo
