// rgbd2rawlog: parts of a recording, depth as files, JPEG, inertial samples, interruption, memory.
#include <gtest/gtest.h>
#include <mrpt/obs/CObservationIMU.h>

#include <chrono>
#include <csignal>
#include <regex>
#include <thread>

#include "tools/rawlog_tools_check.h"
#include "tools/small_tum_folder.h"

namespace roevo {
namespace {

namespace fs = std::filesystem;
using test::convert;
using test::countEntries;
using test::expectError;
using test::expectFrames;
using test::ProgramResult;
using test::SmallTumFolder;

std::vector<std::string> namesIn(const fs::path& folder) {
    std::vector<std::string> names;
    for (const auto& entry : fs::directory_iterator(folder)) names.push_back(entry.path().filename());
    std::sort(names.begin(), names.end());
    return names;
}

TEST(Rgbd2rawlogOptions, DepthAsFilesIsLossless) {
    const SmallTumFolder input;
    const test::TemporaryFolder output;
    const ProgramResult outcome =
        convert(input.path(), output / "o.rawlog", {"--externalize-depth", "--verify"});
    EXPECT_EQ(outcome.exit_code, 0) << outcome.all();
    EXPECT_CONTAINS(outcome.out, "verified: 3 frames, 9216 depth values");
    expectFrames(output / "o.rawlog", input.path(), {0, 1, 2});
    const auto names = namesIn(output / "o_Images");
    ASSERT_EQ(names.size(), 6u);
    EXPECT_EQ(names[0], "RGBD_" + SmallTumFolder::stamp(0) + ".png");
    EXPECT_EQ(names[1], "RGBD_" + SmallTumFolder::stamp(0) + "_RANGES.bin");
    EXPECT_LT(fs::file_size(output / "o.rawlog"), 3000u) << "depth is still inside";
}

TEST(Rgbd2rawlogOptions, JpegSaysThatItIsLossyAndLeavesDepthAlone) {
    const SmallTumFolder input;
    cv::Mat noise(48, 64, CV_8UC3);
    cv::RNG(7).fill(noise, cv::RNG::UNIFORM, 0, 256);
    cv::imwrite(input / SmallTumFolder::rgbName(1), noise);
    const test::TemporaryFolder output;
    const ProgramResult outcome = convert(input.path(), output / "o.rawlog", {"--jpeg", "60", "--verify"});
    EXPECT_EQ(outcome.exit_code, 0) << outcome.all();
    EXPECT_CONTAINS(outcome.out, "colour is lossy: JPEG of quality 60");
    std::smatch found;
    ASSERT_TRUE(std::regex_search(outcome.out, found, std::regex("([0-9.]+) dB or better"))) << outcome.out;
    EXPECT_LT(std::stod(found[1]), 30) << "noise cannot be kept";
    for (const std::string& name : namesIn(output / "o_Images")) EXPECT_CONTAINS(name, ".jpg");
    const DatasetReader dataset = openDataset(input.path());
    RawlogReader reader(output / "o.rawlog");
    for (std::size_t i = 0; i < 3; i++) {
        const RgbdFrame stored = toRgbdFrame(*reader.next());
        EXPECT_TRUE(test::sameImage(stored.depth, dataset.readFrame(i).depth));
        EXPECT_EQ(test::sameImage(stored.colour, dataset.readImage(i)), false) << "not through JPEG";
    }
    for (const char* quality : {"0", "101", "good"})
        EXPECT_EQ(convert(input.path(), output / "x.rawlog", {"--jpeg", quality}).exit_code, 2) << quality;
}

TEST(Rgbd2rawlogOptions, APartOfTheRecording) {
    const SmallTumFolder input(10);  // 10 Hz
    struct Case {
        std::vector<std::string> options;
        std::vector<std::size_t> frames;
    };
    const std::string third = "@" + SmallTumFolder::stamp(3);
    const std::vector<Case> cases = {
        {{"--from", "0.7"}, {7, 8, 9}},
        {{"--to", "0.2"}, {0, 1, 2}},
        {{"--from", "0.25", "--to", "0.55"}, {3, 4, 5}},
        {{"--from", third, "--to", third}, {3}},  // to the microsecond, both ends
        {{"--from", third, "--to", "0.5"}, {3, 4, 5}},
        {{"--every", "4"}, {0, 4, 8}},
        {{"--from", "0.1", "--every", "3"}, {1, 4, 7}},
        {{"--from", "-5", "--to", "0"}, {0}},
    };
    for (const Case& each : cases) {
        auto options = each.options;
        options.emplace_back("--verify");
        const ProgramResult outcome = convert(input.path(), input / "o.rawlog", options);
        ASSERT_EQ(outcome.exit_code, 0) << outcome.all();
        expectFrames(input / "o.rawlog", input.path(), each.frames);
        EXPECT_EQ(static_cast<std::size_t>(countEntries(input / "o_Images")), each.frames.size());
    }
}

TEST(Rgbd2rawlogOptions, WrongLimitsAreExplained) {
    const SmallTumFolder input;
    const std::string rawlog = input / "o.rawlog";
    // A stamp without the @ is the likely mistake: the answer names the spelling
    expectError(convert(input.path(), rawlog, {"--from", SmallTumFolder::stamp(1)}), 1, "rgbd2rawlog",
                {input.path(), "0.200000 s", "@" + SmallTumFolder::stamp(0)});
    expectError(convert(input.path(), rawlog, {"--from", "0.2", "--to", "0.1"}), 1, "rgbd2rawlog",
                {"no frame between"});
    expectError(convert(input.path(), rawlog, {"--from", "noon"}), 2, "rgbd2rawlog", {"--from", "noon"});
    expectError(convert(input.path(), rawlog, {"--to", "@"}), 2, "rgbd2rawlog", {"--to"});
    expectError(convert(input.path(), rawlog, {"--every", "0"}), 2, "rgbd2rawlog", {"--every"});
    EXPECT_FALSE(fs::exists(rawlog));
    EXPECT_FALSE(fs::exists(input / "o.rawlog.part"));
}

/// Stamps and classes in the order of the file.
std::vector<std::pair<double, bool>> timeline(const std::string& rawlog) {
    std::vector<std::pair<double, bool>> all;
    RawlogReader reader(rawlog);
    reader.onOther([&](const mrpt::obs::CObservation& observation) {
        const auto* imu = dynamic_cast<const mrpt::obs::CObservationIMU*>(&observation);
        ASSERT_NE(imu, nullptr);
        EXPECT_EQ(imu->sensorLabel, "IMU");
        EXPECT_EQ(imu->get(mrpt::obs::IMU_Z_ACC), 9.75);
        EXPECT_FALSE(imu->has(mrpt::obs::IMU_WX));
        all.emplace_back(fromMrptTime(imu->timestamp), true);
    });
    while (const auto scan = reader.next()) all.emplace_back(fromMrptTime(scan->timestamp), false);
    return all;
}

TEST(Rgbd2rawlogOptions, AccelerometerSamplesAreInTheOrderOfTime) {
    const SmallTumFolder input;  // frames at 0, 0.1, 0.2 s
    std::string text = "# accelerometer\n";
    for (int i = -2; i < 10; i++) text += SmallTumFolder::stamp(0, 0.04 * i + 0.01) + " 0.5 -0.25 9.75\n";
    input.write("accelerometer.txt", text);
    const ProgramResult outcome = convert(input.path(), input / "o.rawlog", {"--verify"});
    ASSERT_EQ(outcome.exit_code, 0) << outcome.all();
    EXPECT_CONTAINS(outcome.out, "3 frames written, 0 left out, 12 inertial samples");
    EXPECT_CONTAINS(outcome.out, "12 inertial samples, stamps");
    const auto all = timeline(input / "o.rawlog");
    EXPECT_EQ(all.size(), 15u);
    EXPECT_TRUE(std::is_sorted(all.begin(), all.end()));
    EXPECT_TRUE(all.front().second) << "samples before the first frame are kept";

    ASSERT_EQ(convert(input.path(), input / "o.rawlog", {"--from", "0.1", "--to", "0.2"}).exit_code, 0);
    const auto part = timeline(input / "o.rawlog");
    EXPECT_EQ(part.size(), 4u) << "two frames, and the samples at 0.13 and 0.17 s";
}

TEST(Rgbd2rawlogOptions, PathsWithSpacesAndLetters) {
    const SmallTumFolder input;
    const fs::path folder = fs::path(input.path()) / "Küche 1 (neu)";
    fs::create_directory(folder);
    for (const char* name : {"rgb", "depth", "rgb.txt", "depth.txt", "camera.txt"})
        fs::rename(input / name, folder / name);
    const std::string rawlog = folder / "été 2.rawlog";
    const ProgramResult outcome = convert(folder, rawlog, {"--verify", "--externalize-depth"});
    ASSERT_EQ(outcome.exit_code, 0) << outcome.all();
    expectFrames(rawlog, folder, {0, 1, 2});
}

TEST(Rgbd2rawlogOptions, BadOutputsAndInputs) {
    const SmallTumFolder input;
    fs::create_directory(input / "dir.rawlog");
    expectError(convert(input.path(), input / "dir.rawlog"), 1, "rgbd2rawlog",
                {"dir.rawlog", "it is a folder"});
    expectError(convert(input / "rgb.txt", input / "o.rawlog"), 1, "rgbd2rawlog",
                {"rgb.txt", "not a folder", ".bag"});
    expectError(convert(input.path(), "/sys/o.rawlog"), 1, "rgbd2rawlog", {"/sys/o"});  // not even root may
    expectError(convert(input.path(), input / "rgb.txt/o.rawlog"), 1, "rgbd2rawlog",
                {"rgb.txt is not a folder"});
    // The folder is named, not what would have been written into it first
    input.write("groundtruth.txt", "1 0 0 0 0 0 0 1\n");
    const ProgramResult nowhere = convert(input.path(), input / "nodir/o.rawlog");
    expectError(nowhere, 1, "rgbd2rawlog",
                {"nodir/o.rawlog: folder " + (input / "nodir") + " does not exist: create it"});
    EXPECT_EQ(nowhere.err.find("groundtruth"), std::string::npos) << nowhere.err;
    // The ground truth cannot be written: then the rawlog is not, either
    fs::create_directory(input / "o_groundtruth.txt");
    expectError(convert(input.path(), input / "o.rawlog"), 1, "rgbd2rawlog", {"o_groundtruth.txt"});
    for (const char* name : {"o.rawlog", "o_Images", "o.rawlog.part"})
        EXPECT_FALSE(fs::exists(input / name)) << name;
}

TEST(Rgbd2rawlogOptions, AnOlderGroundTruthOfSomethingElseIsPointedOut) {
    const SmallTumFolder input;
    input.write("o_groundtruth.txt", "1 0 0 0 0 0 0 1\n");
    const ProgramResult outcome = convert(input.path(), input / "o.rawlog");
    EXPECT_EQ(outcome.exit_code, 0);
    EXPECT_CONTAINS(outcome.err, "warning: ");
    EXPECT_CONTAINS(outcome.err, "o_groundtruth.txt");
}

TEST(Rgbd2rawlogOptions, AGroundTruthThatIsNamedGoesWithTheRawlogAndIsNotWrittenOver) {
    const SmallTumFolder input;
    const test::TemporaryFolder output;
    const std::string truth = "# of the other camera\n100 1 2 3 0 0 0 1\n101 1 2 3 0 0 0 1\n";
    test::writeFile(output / "truth.txt", truth);
    const ProgramResult outcome =
        convert(input.path(), output / "o.rawlog", {"--ground-truth", output / "truth.txt"});
    ASSERT_EQ(outcome.exit_code, 0) << outcome.all();
    EXPECT_CONTAINS(test::readFile(output / "o_groundtruth.txt"),
                    " 1.000000000000 2.000000000000 3.000000000000 ");

    test::writeFile(output / "o_groundtruth.txt", truth);
    expectError(convert(input.path(), output / "o.rawlog", {"--ground-truth", output / "o_groundtruth.txt"}),
                2, "rgbd2rawlog", {"o_groundtruth.txt"});
    EXPECT_EQ(test::readFile(output / "o_groundtruth.txt"), truth);
}

/// Lists the same few images so often that there is much to do.
void repeatFrames(const SmallTumFolder& folder, int count) {
    std::string rgb, depth;
    for (int i = 0; i < count; i++) {
        rgb += SmallTumFolder::stamp(i) + " " + SmallTumFolder::rgbName(i % 3) + "\n";
        depth += SmallTumFolder::stamp(i) + " " + SmallTumFolder::depthName(i % 3) + "\n";
    }
    folder.write("rgb.txt", rgb);
    folder.write("depth.txt", depth);
}

TEST(Rgbd2rawlogOptions, AnInterruptionLeavesNothing) {
    const SmallTumFolder input;
    repeatFrames(input, 20000);
    const test::TemporaryFolder output;
    const std::string rawlog = output / "o.rawlog";
    std::thread interrupter([&] {
        const auto give_up = std::chrono::steady_clock::now() + std::chrono::seconds(20);
        while (!fs::exists(rawlog + ".part") && std::chrono::steady_clock::now() < give_up)
            std::this_thread::sleep_for(std::chrono::milliseconds(5));
        // The program is this process' only child
        std::ifstream children("/proc/self/task/" + std::to_string(getpid()) + "/children");
        pid_t child = 0;
        if (children >> child) kill(child, SIGINT);
    });
    const ProgramResult outcome = convert(input.path(), rawlog);
    interrupter.join();
    expectError(outcome, 1, "rgbd2rawlog", {"interrupted", "nothing was written"});
    EXPECT_EQ(countEntries(output.path()), 0);
}

double peakMb(const ProgramResult& outcome) {
    std::smatch found;
    EXPECT_TRUE(std::regex_search(outcome.out, found, std::regex("memory at most ([0-9]+) MB")))
        << outcome.all();
    return found.empty() ? 0 : std::stod(found[1]);
}

class Rgbd2rawlogMemory : public ::testing::TestWithParam<std::string> {};

TEST_P(Rgbd2rawlogMemory, DoesNotGrowWithTheNumberOfFrames) {
#ifdef __SANITIZE_ADDRESS__
    GTEST_SKIP() << "AddressSanitizer keeps what was freed for a while";
#endif
    const SmallTumFolder input;
    // 150 kB of depth each: what is kept of 450 frames would show as 68 MB
    for (int i = 0; i < 3; i++) {
        cv::imwrite(input / SmallTumFolder::rgbName(i), cv::Mat(240, 320, CV_8UC1, cv::Scalar(50 + i)));
        cv::imwrite(input / SmallTumFolder::depthName(i), cv::Mat(240, 320, CV_16UC1, cv::Scalar(9000 + i)));
    }
    input.write("camera.txt",
                "width: 320\nheight: 240\nfx: 300\nfy: 300\ncx: 160\ncy: 120\ndepth_scale: 5000\n");
    const test::TemporaryFolder output;
    const std::vector<std::string> options = {"--verify", GetParam()};
    repeatFrames(input, 50);
    const double few = peakMb(convert(input.path(), output / "o.rawlog", options));
    const double few_back = peakMb(test::convertBack(output / "o.rawlog", output / "few"));
    repeatFrames(input, 500);
    const double many = peakMb(convert(input.path(), output / "o.rawlog", options));
    const double many_back = peakMb(test::convertBack(output / "o.rawlog", output / "many"));
    EXPECT_LE(many, few + 5) << "MB";
    EXPECT_LE(many_back, few_back + 5) << "MB";
}

INSTANTIATE_TEST_SUITE_P(Depth, Rgbd2rawlogMemory, ::testing::Values("--every=1", "--externalize-depth"),
                         [](const auto& info) { return info.index == 0 ? "Inside" : "InFiles"; });

}  // namespace
}  // namespace roevo
