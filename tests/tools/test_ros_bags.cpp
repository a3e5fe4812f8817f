// Bags of every kind as input: the frames are those of the folder that they were made of.
#include <gtest/gtest.h>

#include <cstdio>
#include <filesystem>
#include <opencv2/imgcodecs.hpp>
#include <regex>

#include "mrpt/test_helpers.h"
#include "recordings/bags/message_store.h"
#include "tools/ros_recording.h"

namespace roevo {
namespace {

namespace fs = std::filesystem;
using namespace test;

/// A simulated recording, made once for all tests.
const std::string& simulatedFolder() {
    static const TemporaryFolder folder;
    static const std::string path = [] {
        const std::string made = folder / "walk";
        const auto result =
            runProgram("rawlog-simulate", {"--scene", "shadows", "--frames", "10", "--noise", "kinect",
                                           "--speed", "2", "--size", "160x120", "--intrinsics", "120.25",
                                           "121.5", "79.75", "60.125", "--layout", "tum", "--output", made});
        EXPECT_EQ(result.exit_code, 0) << result.all();
        return made;
    }();
    return path;
}

class BagsOfEveryKind : public testing::TestWithParam<BagKind> {};
INSTANTIATE_TEST_SUITE_P(Ros, BagsOfEveryKind, testing::ValuesIn(kBagKinds),
                         [](const auto& info) { return info.param.name; });

TEST_P(BagsOfEveryKind, GiveTheFramesOfTheFolder) {
    const DatasetReader folder = openDataset(simulatedFolder());
    const TemporaryFolder output;
    const auto& kind = GetParam();
    const std::string path =
        kind.write(output / (std::string("walk") + kind.ending), recordingOf(folder, kind.encoding));
    EXPECT_TRUE(isBag(path));
    const DatasetReader bag = openDataset(path);
    EXPECT_EQ(bag.description().format, "bag");
    EXPECT_EQ(bag.camera(), folder.camera());
    EXPECT_EQ(bag.depthUnit(), folder.depthUnit());
    EXPECT_FALSE(bag.description().registration);
    ASSERT_EQ(bag.size(), folder.size());
    for (std::size_t i = 0; i < bag.size(); i++) {
        const RgbdFrame a = folder.readFrame(i), b = bag.readFrame(i);
        EXPECT_EQ(a.timestamp, b.timestamp);
        EXPECT_EQ(folder.entry(i).depth_timestamp, bag.entry(i).depth_timestamp);
        EXPECT_TRUE(same(a.colour, b.colour)) << i;
        EXPECT_TRUE(same(a.depth, b.depth)) << i;
    }
}

/// trajectory.txt of a run that must succeed.
std::string trajectoryOf(const std::string& input, const TemporaryFolder& folder,
                         const std::vector<std::string>& more = {}) {
    std::vector<std::string> arguments{"--input", input, "--output", folder / "out"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    const auto result = runProgram("roevo-odometry", arguments);
    EXPECT_EQ(result.exit_code, 0) << result.all();
    return readFile(folder / "out/trajectory.txt");
}

TEST(RosBags, OdometryAndConverterTakeThemAsTheyAre) {
    const TemporaryFolder folder;
    const DatasetReader dataset = openDataset(simulatedFolder());
    const std::string expected = trajectoryOf(simulatedFolder(), folder);
    ASSERT_EQ(std::count(expected.begin(), expected.end(), '\n'), 1 + 10) << expected;
    for (const BagKind& kind : kBagKinds) {
        const std::string name = kind.name;
        if (name != "Ros1Lz4" && name != "SqliteFolder" && name != "McapZstd") continue;
        const std::string bag =
            kind.write(folder / (name + kind.ending), recordingOf(dataset, kind.encoding));
        EXPECT_TRUE(trajectoryOf(bag, folder) == expected) << name;
        const std::string rawlog = folder / (name + ".rawlog");
        const auto converted = runProgram("rgbd2rawlog", {"--input", bag, "--output", rawlog, "--verify"});
        EXPECT_EQ(converted.exit_code, 0) << converted.all();
        EXPECT_NE(converted.out.find("verified: 10 frames"), std::string::npos) << converted.out;
        EXPECT_TRUE(trajectoryOf(rawlog, folder) == expected) << name;
    }
}

TEST(RosBags, TheInputLinesTellTopicsSizesRateLensAndDepth) {
    const TemporaryFolder folder;
    writeFile(folder / "walk_groundtruth.txt", readFile(simulatedFolder() + "/groundtruth.txt"));
    const std::string bag =
        writeRos1<'n'>(folder / "walk.bag", recordingOf(openDataset(simulatedFolder()), Encoding::kRos1));
    const auto result = runProgram("roevo-odometry", {"--input", bag, "--output", folder / "out"});
    EXPECT_EQ(result.exit_code, 0) << result.all();
    for (const std::string& words :
         {std::string("walk.bag (bag), 160 x 120, intrinsics from " + kColourInfo),
          "colour: " + kColour + " (sensor_msgs/Image, bgr8, 10 messages)",
          "depth: " + kDepth + " (sensor_msgs/Image, 32FC1, 10 messages)",
          std::string("depth is aligned to colour"), std::string("10 frames matched"),
          std::string("30.0 Hz, no lens distortion, median depth"), std::string("ground truth: 10 poses")})
        EXPECT_NE(result.out.find(words), std::string::npos) << words << " in\n" << result.out;
}

TEST(RosBags, StudyAndCompareTakeThemAndTheirTopics) {
    const TemporaryFolder folder;
    Recording recording = recordingOf(openDataset(simulatedFolder()), Encoding::kCdrLittle);
    recording.push_back({"/other/image_raw", "sensor_msgs/Image",
                         imageMessage(Encoding::kCdrLittle, 5, "other", tinyColour(0), "rgb8")});
    const std::string bag = writeMcap<'n'>(folder / "walk.mcap", recording);
    writeFile(folder / "walk_groundtruth.txt", readFile(simulatedFolder() + "/groundtruth.txt"));
    const std::vector<std::string> compare{"--input",           bag,         "--output",
                                           folder / "compared", "--methods", "roevo-tr"};
    expectError(runProgram("roevo-compare", compare), 1, "roevo-compare",
                {"--colour-topic", "/other/image_raw"});
    auto chosen = compare;
    chosen.insert(chosen.end(), {"--colour-topic", kColour});
    const auto compared = runProgram("roevo-compare", chosen);
    EXPECT_EQ(compared.exit_code, 0) << compared.all();
    const auto study = runProgram("roevo-study", {"--input", bag, "--output", folder / "study",
                                                  "--colour-topic", kColour, "--experiment", "distribution"});
    EXPECT_EQ(study.exit_code, 0) << study.all();
}

TEST(RosBags, TopicsAreForBagsOnly) {
    const TemporaryFolder folder;
    const auto refused = [&](const char* program, const std::string& input) {
        expectError(
            runProgram(program, {"--input", input, "--output", folder / "o.rawlog", "--depth-topic", "/d"}),
            2, program, {"topics are for bags", input});
    };
    refused("roevo-odometry", simulatedFolder());
    refused("rgbd2rawlog", simulatedFolder());
}

/// A recording with other messages in it than those of recordingOf().
using Change = void (*)(RecordedMessage& message, const cv::Mat& colour, const cv::Mat& depth_u16,
                        double stamp);

cv::Mat millimetres(const cv::Mat& depth_u16) {
    cv::Mat out;
    depth_u16.convertTo(out, CV_16UC1, 0.2);
    return out;
}

Recording changed(const DatasetReader& dataset, Change change) {
    Recording recording = recordingOf(dataset, Encoding::kCdrLittle);
    for (std::size_t i = 0; i < dataset.size(); i++)
        for (std::size_t k = 1; k <= 2; k++)
            change(recording.at(2 * i + k), dataset.readImage(i), dataset.readDepth(i),
                   dataset.entry(i).timestamp);
    return recording;
}

void asJpeg(RecordedMessage& message, const cv::Mat& colour, const cv::Mat&, double stamp) {
    if (message.topic == kColour)
        message = {kColour + "/compressed", "sensor_msgs/CompressedImage",
                   compressedMessage(Encoding::kCdrLittle, stamp, "rgb", "bgr8; jpeg compressed bgr8",
                                     encoded(".jpg", colour))};
}
void asPng(RecordedMessage& message, const cv::Mat& colour, const cv::Mat&, double stamp) {
    if (message.topic == kColour)
        message = {kColour + "/compressed", "sensor_msgs/CompressedImage",
                   compressedMessage(Encoding::kCdrLittle, stamp, "rgb", "bgr8; png compressed bgr8",
                                     encoded(".png", colour))};
}
void asMillimetres(RecordedMessage& message, const cv::Mat&, const cv::Mat& depth, double stamp) {
    if (message.topic == kDepth)
        message.bytes = imageMessage(Encoding::kCdrLittle, stamp, "rgb", millimetres(depth), "16UC1");
}
void asCompressedMillimetres(RecordedMessage& message, const cv::Mat&, const cv::Mat& depth, double stamp) {
    if (message.topic == kDepth)
        message = {kDepth + "/compressedDepth", "sensor_msgs/CompressedImage",
                   compressedMessage(Encoding::kCdrLittle, stamp, "rgb", "16UC1; compressedDepth png",
                                     std::string(12, '\0') + encoded(".png", millimetres(depth)))};
}
void asCompressedMetres(RecordedMessage& message, const cv::Mat&, const cv::Mat& depth, double stamp) {
    if (message.topic != kDepth) return;
    const float a = 100 * 101, b = 1 - a / 10;  // image_transport's defaults: up to 10 m, quantisation 100
    cv::Mat values(depth.size(), CV_16UC1, cv::Scalar(0));
    for (int v = 0; v < depth.rows; v++)
        for (int u = 0; u < depth.cols; u++)
            if (const float metres = depth.at<std::uint16_t>(v, u) / 5000.f; metres > 0 && metres < 10)
                values.at<std::uint16_t>(v, u) = static_cast<std::uint16_t>(a / metres + b);
    FieldWriter head(Encoding::kRos1);
    message = {kDepth + "/compressedDepth", "sensor_msgs/CompressedImage",
               compressedMessage(Encoding::kCdrLittle, stamp, "rgb", "32FC1; compressedDepth",
                                 head.put(std::int32_t{1}).put(a).put(b).bytes() + encoded(".png", values))};
}

/// The table of docs/inputs.md: `--gtest_also_run_disabled_tests --gtest_filter=*Table*`.
TEST(RosBags, DISABLED_TableOfInputs) {
    const TemporaryFolder folder;
    const std::string walk = folder / "walk";
    ASSERT_EQ(runProgram("rawlog-simulate", {"--scene", "shadows", "--frames", "90", "--noise", "kinect",
                                             "--size", "320x240", "--layout", "tum", "--output", walk})
                  .exit_code,
              0);
    const std::string truth = walk + "/groundtruth.txt";
    std::string original;
    const auto row = [&](const std::string& what, const std::string& input) {
        const auto run = runProgram("roevo-odometry",
                                    {"--input", input, "--output", folder / "out", "--ground-truth", truth});
        const std::string trajectory = readFile(folder / "out/trajectory.txt");
        if (original.empty()) original = trajectory;
        std::smatch ate;
        std::regex_search(run.out, ate, std::regex("ATE +([0-9.]+ cm)"));
        std::printf("| %s | %s | %s |\n", what.c_str(), ate.str(1).c_str(),
                    trajectory == original ? "the same bytes" : "another");
    };
    const DatasetReader dataset = openDataset(walk);
    row("folder", walk);
    for (const BagKind& kind : kBagKinds)
        row(kind.name,
            kind.write(folder / (kind.name + std::string(kind.ending)), recordingOf(dataset, kind.encoding)));
    const std::vector<std::pair<const char*, Change>> changes{
        {"png", &asPng},
        {"jpeg", &asJpeg},
        {"millimetres", &asMillimetres},
        {"compressedDepth of 16UC1", &asCompressedMillimetres},
        {"compressedDepth of 32FC1", &asCompressedMetres}};
    for (const auto& [name, change] : changes)
        row(name, writeMcap<'n'>(folder / "changed.mcap", changed(dataset, change)));
}

}  // namespace
}  // namespace roevo
