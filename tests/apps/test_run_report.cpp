// What roevo-odometry makes of a run before it writes anything.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "roevo-odometry/run_report.h"

namespace roevo {
namespace {

RunReport trackedReport() {
    RunReport report;
    for (int i = 0; i < 3; ++i) {
        FrameRecord record;
        record.result.timestamp = 10 + i;
        record.result.status = i == 0 ? FrameStatus::kInitialised : FrameStatus::kOk;
        report.frames.push_back(record);
        report.trajectory.push_back({10. + i, Pose::Identity()});
    }
    return report;
}

TEST(RunReport, ATrackedRunIsNoFailure) {
    EXPECT_EQ(trackedReport().failure(), "");
}

TEST(RunReport, APoseThatIsNotANumberIsAFailureThatSaysWhere) {
    for (const double bad : {std::nan(""), std::numeric_limits<double>::infinity()}) {
        RunReport report = trackedReport();
        report.trajectory[1].T_world_camera.translation().x() = bad;
        const std::string failure = report.failure();
        EXPECT_NE(failure.find("frame at 11.000000 s"), std::string::npos) << failure;
        EXPECT_NE(failure.find("not a number"), std::string::npos) << failure;
    }
}

}  // namespace
}  // namespace roevo
