// The real clips: folder -> rawlog -> folder changes nothing. Skips, visibly, without the data.
#include <gtest/gtest.h>

#include "roevo_mrpt/time_conversions.h"
#include "tools/rawlog_tools_check.h"

namespace roevo {
namespace {

namespace fs = std::filesystem;

void expectSamePoses(const std::vector<StampedPose>& a, const std::vector<StampedPose>& b) {
    ASSERT_EQ(a.size(), b.size());
    for (std::size_t i = 0; i < a.size(); i++) {
        EXPECT_EQ(roundToMicroseconds(a[i].timestamp), roundToMicroseconds(b[i].timestamp));
        const Eigen::Matrix4d difference = a[i].T_world_camera.matrix() - b[i].T_world_camera.matrix();
        EXPECT_LT(difference.cwiseAbs().maxCoeff(), 1e-9) << i;
    }
}

/// folder -> rawlog -> folder
void expectRoundTrip(const std::string& folder) {
    const test::TemporaryFolder output;
    const auto there = test::convert(folder, output / "o.rawlog");
    ASSERT_EQ(there.exit_code, 0) << there.all();
    const auto back = test::convertBack(output / "o.rawlog", output / "back");
    ASSERT_EQ(back.exit_code, 0) << back.all();
    test::expectSameDataset(folder, output / "back");
    expectSamePoses(openDataset(folder).groundTruth().poses,
                    openDataset(output / "back").groundTruth().poses);
}

class ClipRoundTrip : public ::testing::TestWithParam<const char*> {};

TEST_P(ClipRoundTrip, ChangesNothing) {
    const std::string clip = test::dataFolder() + "/" + GetParam();
    if (!fs::exists(clip))
        GTEST_SKIP() << clip << " is not there; set ROEVO_DATA_DIR to the folder with the clips";
    expectRoundTrip(clip);
}

INSTANTIATE_TEST_SUITE_P(Clips, ClipRoundTrip,
                         ::testing::Values("tum_fr1_desk_9", "tum_fr1_xyz_150", "tum_fr1_rpy_100",
                                           "tum_fr3_structure_notexture_far_80", "icl_office_kt0_50"),
                         [](const auto& info) { return std::string(info.param); });

class LayoutRoundTrip : public ::testing::TestWithParam<const char*> {};

TEST_P(LayoutRoundTrip, ChangesNothing) {
    const test::TemporaryFolder folder;
    const std::string layout = GetParam();
    std::vector<std::string> arguments = {
        "--scene", "livingroom", "--frames", "3",        "--noise",
        "kinect",  "--layout",   layout,     "--output", folder / "simulated"};
    const bool fixed_size = layout == "icl" || layout == "7scenes";  // their camera is published
    if (!fixed_size) arguments.insert(arguments.end(), {"--size", "160x120"});
    const auto made = test::runProgram("rawlog-simulate", arguments);
    ASSERT_EQ(made.exit_code, 0) << made.all();
    const DatasetReader dataset = openDataset(folder / "simulated");
    EXPECT_EQ(dataset.description().format, layout);
    EXPECT_EQ(dataset.size(), 3u);
    EXPECT_GE(dataset.groundTruth().poses.size(), 3u);
    expectRoundTrip(folder / "simulated");
}

INSTANTIATE_TEST_SUITE_P(Layouts, LayoutRoundTrip,
                         ::testing::Values("tum", "icl", "eth3d", "7scenes", "plain"),
                         [](const auto& info) { return "layout_" + std::string(info.param); });

}  // namespace
}  // namespace roevo
