// Bags of every kind as input: the frames are those of the folder that they were made of.
#include <gtest/gtest.h>

#include <cstdlib>

#include "mrpt/test_helpers.h"
#include "recordings/bags/message_store.h"
#include "tools/ros_recording.h"

namespace roevo {
namespace {

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
        EXPECT_TRUE(equal(a.colour, b.colour)) << i;
        EXPECT_TRUE(equal(a.depth, b.depth)) << i;
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

}  // namespace
}  // namespace roevo
