#include <gtest/gtest.h>
#include <mrpt/obs/CObservation3DRangeScan.h>
#include <sys/wait.h>

#include <cstdio>
#include <opencv2/core.hpp>

#include "datasets/dataset_reader.h"
#include "roevo_mrpt/observation_converter.h"
#include "roevo_mrpt/rawlog_reader.h"
#include "tum_folder.h"

namespace roevo {
namespace {

namespace fs = std::filesystem;
using test::TumFolder;

struct Outcome {
    int code = 0;
    std::string text;  ///< stdout and stderr
};

Outcome run(const std::string& arguments) {
    const std::string command = std::string(ROEVO_BIN_DIR) + "/rgbd2rawlog " + arguments + " 2>&1";
    FILE* pipe = popen(command.c_str(), "r");
    Outcome outcome;
    char buffer[512];
    while (std::fgets(buffer, sizeof buffer, pipe) != nullptr) outcome.text += buffer;
    outcome.code = WEXITSTATUS(pclose(pipe));
    return outcome;
}

std::string arguments(const std::string& input, const std::string& output) {
    return "--input '" + input + "' --output '" + output + "'";
}

#define EXPECT_CONTAINS(text, part) EXPECT_NE((text).find(part), std::string::npos) << (text)

void expectSameFrames(const std::string& rawlog, const std::string& folder) {
    const DatasetReader dataset = openDataset(folder);
    RawlogReader reader(rawlog);
    for (std::size_t i = 0; i < dataset.size(); i++) {
        const auto scan = reader.next();
        ASSERT_TRUE(scan);
        const RgbdFrame a = toRgbdFrame(*scan), b = dataset.readFrame(i);
        EXPECT_EQ(a.timestamp, b.timestamp);
        EXPECT_EQ(cv::norm(a.depth, b.depth, cv::NORM_INF), 0);
        EXPECT_EQ(cv::norm(a.grey, b.grey, cv::NORM_INF), 0);
        EXPECT_EQ(colourCameraOf(*scan), dataset.camera());
    }
    EXPECT_FALSE(reader.next());
}

TEST(Rgbd2rawlog, ConvertsAndVerifies) {
    const TumFolder input;
    input.write("groundtruth.txt", "# t\n1 0 0 0 0 0 0 1\n");
    const std::string rawlog = input / "out.rawlog";
    const Outcome outcome = run(arguments(input.path(), rawlog) + " --verify");
    EXPECT_EQ(outcome.code, 0) << outcome.text;
    EXPECT_CONTAINS(outcome.text, "verified: 3 frames, 9216 depth values");
    EXPECT_CONTAINS(outcome.text, "0 differences");
    expectSameFrames(rawlog, input.path());
    std::ifstream truth(input / "out_groundtruth.txt");
    EXPECT_EQ(std::string((std::istreambuf_iterator<char>(truth)), std::istreambuf_iterator<char>()),
              "# t\n1 0 0 0 0 0 0 1\n");
}

TEST(Rgbd2rawlog, RealClip) {
    const std::string clip = std::string(ROEVO_DATA_DIR) + "/tum_fr1_desk_9";
    if (!fs::exists(clip)) GTEST_SKIP() << clip << " not present";
    const test::TemporaryFolder output;
    const Outcome outcome = run(arguments(clip, output / "desk.rawlog") + " --verify");
    EXPECT_EQ(outcome.code, 0) << outcome.text;
    EXPECT_CONTAINS(outcome.text, "verified: 9 frames, 2764800 depth values");
    EXPECT_EQ(output.count(), 3u);  // rawlog, images, ground truth
    expectSameFrames(output / "desk.rawlog", clip);
}

TEST(Rgbd2rawlog, ABadFrameStopsItUnlessToldToSkip) {
    const TumFolder input;
    fs::resize_file(input / TumFolder::rgbName(1), 60);
    const std::string rawlog = input / "out.rawlog";
    const Outcome refused = run(arguments(input.path(), rawlog));
    EXPECT_EQ(refused.code, 1);
    EXPECT_CONTAINS(refused.text, "rgbd2rawlog: error: ");
    EXPECT_CONTAINS(refused.text, TumFolder::rgbName(1));
    EXPECT_CONTAINS(refused.text, "--skip-bad");
    for (const char* name : {"out.rawlog", "out_Images", "out.rawlog.part", "out_Images.part"})
        EXPECT_FALSE(fs::exists(input / name)) << name;
    const Outcome skipped = run(arguments(input.path(), rawlog) + " --skip-bad --verify");
    EXPECT_EQ(skipped.code, 0) << skipped.text;
    EXPECT_CONTAINS(skipped.text, "2 frames written, 1 left out");
    EXPECT_CONTAINS(skipped.text, "left out: cannot decode image");
    EXPECT_CONTAINS(skipped.text, "verified: 2 frames");
}

TEST(Rgbd2rawlog, ExitCodes) {
    const TumFolder input;
    EXPECT_EQ(run("--help").code, 0);
    EXPECT_CONTAINS(run("--help").text, "Example");
    EXPECT_EQ(run("--version").code, 0);
    EXPECT_EQ(run("").code, 2);
    EXPECT_EQ(run(arguments(input.path(), input / "x.bag")).code, 2);
    EXPECT_EQ(run(arguments(input.path(), input / "x.rawlog") + " --format oni").code, 2);
    EXPECT_EQ(run(arguments(input / "none", input / "x.rawlog")).code, 1);
    const Outcome unwritable = run(arguments(input.path(), "/nowhere/x.rawlog"));
    EXPECT_EQ(unwritable.code, 1);
    EXPECT_CONTAINS(unwritable.text, "/nowhere");
}

}  // namespace
}  // namespace roevo
