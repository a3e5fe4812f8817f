#include <gtest/gtest.h>

#include <fstream>

#include "tools/rawlog_tools_check.h"
#include "tools/small_tum_folder.h"

namespace roevo {
namespace {

namespace fs = std::filesystem;
using test::convert;
using test::countEntries;
using test::expectFrames;
using test::ProgramResult;
using test::SmallTumFolder;

TEST(Rgbd2rawlog, ConvertsAndVerifies) {
    const SmallTumFolder input;
    input.write("groundtruth.txt", "# t\n1 0 0 0 0 0 0 1\n");
    const std::string rawlog = input / "out.rawlog";
    const ProgramResult outcome = convert(input.path(), rawlog, {"--verify"});
    EXPECT_EQ(outcome.exit_code, 0) << outcome.all();
    EXPECT_CONTAINS(outcome.all(), "verified: 3 frames, 9216 depth values");
    EXPECT_CONTAINS(outcome.all(), "0 differences");
    expectFrames(rawlog, input.path(), {0, 1, 2});
    std::ifstream truth(input / "out_groundtruth.txt");
    EXPECT_EQ(std::string((std::istreambuf_iterator<char>(truth)), std::istreambuf_iterator<char>()),
              "# t\n1 0 0 0 0 0 0 1\n");
}

TEST(Rgbd2rawlog, RealClip) {
    const std::string clip = test::dataFolder() + "/tum_fr1_desk_9";
    if (!fs::exists(clip)) GTEST_SKIP() << clip << " is not there; set ROEVO_DATA_DIR";
    const test::TemporaryFolder output;
    const ProgramResult outcome = convert(clip, output / "desk.rawlog", {"--verify"});
    EXPECT_EQ(outcome.exit_code, 0) << outcome.all();
    EXPECT_CONTAINS(outcome.all(), "verified: 9 frames, 2764800 depth values");
    EXPECT_EQ(countEntries(output.path()), 4);  // rawlog, images, ground truth, depth times
    expectFrames(output / "desk.rawlog", clip, {0, 1, 2, 3, 4, 5, 6, 7, 8});
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
    EXPECT_CONTAINS(skipped.all(), "left out: cannot decode image (truncated after 60 bytes): ");
    EXPECT_CONTAINS(skipped.all(), "verified: 2 frames");
}

TEST(Rgbd2rawlog, ExitCodes) {
    const SmallTumFolder input;
    EXPECT_EQ(test::runProgram("rgbd2rawlog", {"--help"}).exit_code, 0);
    EXPECT_CONTAINS(test::runProgram("rgbd2rawlog", {"--help"}).out, "Example");
    EXPECT_EQ(test::runProgram("rgbd2rawlog", {"--version"}).exit_code, 0);
    EXPECT_EQ(test::runProgram("rgbd2rawlog", {}).exit_code, 2);
    EXPECT_EQ(convert(input.path(), input / "x.bag").exit_code, 2);
    EXPECT_EQ(convert(input.path(), input / "x.rawlog", {"--format", "oni"}).exit_code, 2);
    EXPECT_EQ(convert(input / "none", input / "x.rawlog").exit_code, 1);
    const ProgramResult unwritable = convert(input.path(), "/nowhere/x.rawlog");
    EXPECT_EQ(unwritable.exit_code, 1);
    EXPECT_CONTAINS(unwritable.all(), "/nowhere");
}

}  // namespace
}  // namespace roevo
