#include <gtest/gtest.h>
#include <mrpt/obs/CObservation3DRangeScan.h>

#include <fstream>
#include <opencv2/core.hpp>

#include "datasets/dataset_reader.h"
#include "roevo_mrpt/observation_converter.h"
#include "roevo_mrpt/rawlog_reader.h"
#include "tools/small_tum_folder.h"

namespace roevo {
namespace {

namespace fs = std::filesystem;
using test::countEntries;
using test::SmallTumFolder;

using test::ProgramResult;

ProgramResult run(std::vector<std::string> arguments) {
    return test::runProgram("rgbd2rawlog", arguments);
}

ProgramResult convert(const std::string& input, const std::string& output,
                      const std::vector<std::string>& more = {}) {
    std::vector<std::string> arguments = {"--input", input, "--output", output};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return run(arguments);
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
    const SmallTumFolder input;
    input.write("groundtruth.txt", "# t\n1 0 0 0 0 0 0 1\n");
    const std::string rawlog = input / "out.rawlog";
    const ProgramResult outcome = convert(input.path(), rawlog, {"--verify"});
    EXPECT_EQ(outcome.exit_code, 0) << outcome.all();
    EXPECT_CONTAINS(outcome.all(), "verified: 3 frames, 9216 depth values");
    EXPECT_CONTAINS(outcome.all(), "0 differences");
    expectSameFrames(rawlog, input.path());
    std::ifstream truth(input / "out_groundtruth.txt");
    EXPECT_EQ(std::string((std::istreambuf_iterator<char>(truth)), std::istreambuf_iterator<char>()),
              "# t\n1 0 0 0 0 0 0 1\n");
}

TEST(Rgbd2rawlog, RealClip) {
    const std::string clip = std::string(ROEVO_DATA_DIR) + "/tum_fr1_desk_9";
    if (!fs::exists(clip)) GTEST_SKIP() << clip << " not present";
    const test::TemporaryFolder output;
    const ProgramResult outcome = convert(clip, output / "desk.rawlog", {"--verify"});
    EXPECT_EQ(outcome.exit_code, 0) << outcome.all();
    EXPECT_CONTAINS(outcome.all(), "verified: 9 frames, 2764800 depth values");
    EXPECT_EQ(countEntries(output.path()), 3);  // rawlog, images, ground truth
    expectSameFrames(output / "desk.rawlog", clip);
}

TEST(Rgbd2rawlog, ABadFrameStopsItUnlessToldToSkip) {
    const SmallTumFolder input;
    fs::resize_file(input / SmallTumFolder::rgbName(1), 60);
    const std::string rawlog = input / "out.rawlog";
    const ProgramResult refused = convert(input.path(), rawlog);
    EXPECT_EQ(refused.exit_code, 1);
    EXPECT_CONTAINS(refused.all(), "rgbd2rawlog: error: ");
    EXPECT_CONTAINS(refused.all(), SmallTumFolder::rgbName(1));
    EXPECT_CONTAINS(refused.all(), "--skip-bad");
    for (const char* name : {"out.rawlog", "out_Images", "out.rawlog.part", "out_Images.part"})
        EXPECT_FALSE(fs::exists(input / name)) << name;
    const ProgramResult skipped = convert(input.path(), rawlog, {"--skip-bad", "--verify"});
    EXPECT_EQ(skipped.exit_code, 0) << skipped.all();
    EXPECT_CONTAINS(skipped.all(), "2 frames written, 1 left out");
    EXPECT_CONTAINS(skipped.all(), "left out: cannot decode image");
    EXPECT_CONTAINS(skipped.all(), "verified: 2 frames");
}

TEST(Rgbd2rawlog, ExitCodes) {
    const SmallTumFolder input;
    EXPECT_EQ(run({"--help"}).exit_code, 0);
    EXPECT_CONTAINS(run({"--help"}).out, "Example");
    EXPECT_EQ(run({"--version"}).exit_code, 0);
    EXPECT_EQ(run({}).exit_code, 2);
    EXPECT_EQ(convert(input.path(), input / "x.bag").exit_code, 2);
    EXPECT_EQ(convert(input.path(), input / "x.rawlog", {"--format", "oni"}).exit_code, 2);
    EXPECT_EQ(convert(input / "none", input / "x.rawlog").exit_code, 1);
    const ProgramResult unwritable = convert(input.path(), "/nowhere/x.rawlog");
    EXPECT_EQ(unwritable.exit_code, 1);
    EXPECT_CONTAINS(unwritable.all(), "/nowhere");
}

}  // namespace
}  // namespace roevo
