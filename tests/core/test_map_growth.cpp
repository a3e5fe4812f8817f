// Maps do not grow where the camera only comes by again.
#include <gtest/gtest.h>

#include <sstream>

#include "core/support/mapped_run.h"

namespace roevo {
namespace {

class MapGrowth : public ::testing::TestWithParam<Mode> {};

TEST_P(MapGrowth, ARoomIsMappedOnce) {
    const testing::Sequence path = testing::backAndForth(2 * testing::kRendered - 1);
    OdometryOptions options = testing::manyKeyframes();
    options.mode = GetParam();
    std::string map;
    int first = 0;
    std::size_t first_edges = 0;
    for (int day = 0; day < 4; ++day) {
        Odometry odometry(path.camera, options, path.start());
        if (std::istringstream in(map); day > 0) odometry.loadMap(in, MapUse::kExtend);
        for (const RgbdFrame& frame : path.frames) ASSERT_TRUE(odometry.processFrame(frame).hasPose());
        for (std::size_t i = 0; i < path.frames.size(); ++i)
            EXPECT_LT(
                testing::distance(odometry.trajectory()[i].T_world_camera, path.truth[i].T_world_camera),
                0.01);
        std::ostringstream out;
        const int keyframes = odometry.saveMap(out);
        if (day == 0) {
            first = keyframes;
            first_edges = odometry.map().size();
            EXPECT_GT(first, 4) << "else it is no test";
        }
        EXPECT_GT(static_cast<int>(odometry.keyframes().size()), day == 0 ? 4 : first)
            << "else it is no test";
        EXPECT_LE(keyframes, first + 1) << day;
        map = out.str();
    }
    Odometry odometry(path.camera, options, path.start());
    std::istringstream in(map);
    odometry.loadMap(in, MapUse::kExtend);
    ASSERT_TRUE(odometry.processFrame(path.frames[0]).hasPose());
    RecordProperty("edges_first", std::to_string(first_edges));
    RecordProperty("edges_last", std::to_string(odometry.map().size()));
}

INSTANTIATE_TEST_SUITE_P(Modes, MapGrowth, ::testing::Values(Mode::kTracking, Mode::kBundleAdjustment));

}  // namespace
}  // namespace roevo
