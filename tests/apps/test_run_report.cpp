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

/// Dropped frames are told by themselves, and it is no fault of the recording that they are many.
TEST(RunReport, HalfOfTheFramesRejectedIsWarnedOfButNotThatTheyWereDropped) {
    RunReport report = trackedReport();
    report.frames.resize(10, report.frames.back());
    for (std::size_t i = 1; i < 7; ++i) {
        FrameRecord& frame = report.frames[i];
        frame.result.status = FrameStatus::kRejected;
        frame.result.reason = "dropped: not done in time";
        frame.dropped = true;
    }
    EXPECT_EQ(report.dropped(), 6U);
    EXPECT_EQ(report.rejectionWarning(), "");
    report.frames[7].result.status = report.frames[8].result.status = FrameStatus::kRejected;
    report.frames[7].result.reason = report.frames[8].result.reason = "it is dark";
    EXPECT_EQ(report.rejectionWarning(), "2 of the 4 frames are rejected, 2 of them: it is dark");
    report.frames[8].result.status = FrameStatus::kOk;
    EXPECT_EQ(report.rejectionWarning(), "");
}

TEST(RunReport, LossesReadWellOneAndMany) {
    Losses losses;
    losses.lost = 1;
    EXPECT_EQ(losses.toText(), "lost once");  // and begun anew
    losses.regained = 1;
    EXPECT_EQ(losses.toText(), "lost once, regained by tracking once");
    losses.regained = 0;
    losses.found_in_map = true;
    EXPECT_EQ(losses.toText(), "lost once, found in the map");
    losses.found_in_map = false;
    losses.to_the_end = true;
    EXPECT_EQ(losses.toText(), "lost once, to the end");
    losses.lost = 3;
    EXPECT_EQ(losses.toText(), "lost 3 times, the last time to the end");
    losses.to_the_end = false;
    losses.lost = 1;
    losses.found_again = 1;
    EXPECT_EQ(losses.toText(), "lost once, found again once");
    losses.lost = 3;
    losses.joined = 2;
    EXPECT_EQ(losses.toText(), "lost 3 times, found again once, begun anew and joined later 2 times");
}

TEST(RunReport, LossesAreCountedOnceEach) {
    RunReport report = trackedReport();
    const auto add = [&](FrameStatus status) -> FrameResult& {
        report.frames.emplace_back();
        report.frames.back().result.status = status;
        return report.frames.back().result;
    };
    EXPECT_EQ(report.losses().lost, 0U);
    EXPECT_EQ(report.losses().pieces, 1U);
    add(FrameStatus::kPredicted);
    add(FrameStatus::kRejected);  // says nothing
    add(FrameStatus::kLost);
    add(FrameStatus::kOk).found_at = 3;  // the end of the loss
    add(FrameStatus::kOk);
    add(FrameStatus::kOk).found_at = 5;  // lost and found in one
    add(FrameStatus::kPredicted);
    EXPECT_TRUE(report.losses().to_the_end);
    add(FrameStatus::kInitialised);
    EXPECT_FALSE(report.losses().to_the_end);
    EXPECT_EQ(report.losses().lost, 3U);
    EXPECT_EQ(report.losses().found_again, 2U);
    EXPECT_EQ(report.losses().pieces, 2U);
    add(FrameStatus::kOk).joined_at = 1;
    add(FrameStatus::kOk).closed_at = 2;
    EXPECT_EQ(report.losses().joined, 1U);
    EXPECT_EQ(report.losses().loops_closed, 1U);
    EXPECT_EQ(report.losses().pieces, 1U);
}

TEST(RunReport, ALossThatTrackingCameOutOfByItselfIsToldSo) {
    RunReport report = trackedReport();
    const auto add = [&](FrameStatus status) {
        report.frames.emplace_back();
        report.frames.back().result.status = status;
    };
    add(FrameStatus::kPredicted);  // a black frame
    EXPECT_EQ(report.losses().regained, 0U);
    EXPECT_EQ(report.losses().toText(), "lost once, to the end");
    add(FrameStatus::kOk);
    add(FrameStatus::kOk);
    EXPECT_EQ(report.losses().regained, 1U);
    EXPECT_EQ(report.losses().toText(), "lost once, regained by tracking once");
    EXPECT_EQ(report.losses().pieces, 1U);
    add(FrameStatus::kLost);
    add(FrameStatus::kInitialised);
    add(FrameStatus::kOk);
    EXPECT_EQ(report.losses().lost, 2U);
    EXPECT_EQ(report.losses().regained, 1U) << "begun anew";
}

TEST(RunReport, ThePathHasNoJumpsBetweenItsPieces) {
    RunReport report = trackedReport();  // three poses, in one place
    const auto add = [&](int keyframe, double x) {
        report.frames.emplace_back();
        report.frames.back().result.status = keyframe < 0 ? FrameStatus::kRejected : FrameStatus::kOk;
        report.frames.back().result.keyframe = keyframe;
        if (keyframe >= 0) report.trajectory.push_back({20 + x, Pose(Eigen::Translation3d(x, 0, 0))});
    };
    report.keyframes = {{0, 10, {}, 0}, {1, 15, {}, 1}};
    add(0, 1), add(-1, 0), add(0, 2);  // on the way
    EXPECT_NEAR(report.pathLength(), 2, 1e-12);
    add(1, 5), add(1, 6.5);
    EXPECT_NEAR(report.pathLength(), 3.5, 1e-12) << "without the 3 m between the pieces";
    report.keyframes[1].track = 0;  // joined
    EXPECT_NEAR(report.pathLength(), 6.5, 1e-12);
}

TEST(RunReport, KeyframesThatTheMapDoesNotHaveAreCounted) {
    RunReport report = trackedReport();
    const auto expect = [&](std::size_t left_out, std::size_t covered) {
        EXPECT_EQ(report.leftOut(), left_out);
        EXPECT_EQ(report.covered(), covered);
    };
    expect(0, 0);
    report.keyframes = {{0, 10, {}, 0}, {1, 15, {}, 0}, {2, 16, {}, 0}};
    report.map_out = {"room.map", 3};
    expect(0, 0);
    report.map_out.keyframes = 2;
    expect(0, 1);
    report.keyframes[1].track = report.keyframes[2].track = 1;  // not joined to the first
    expect(1, 0);
    report.map_in = LoadedMap{"old.map", 5, false};
    report.map_out.keyframes = 5;
    report.keyframes = {{5, 10, {}, 5}, {6, 15, {}, 6}, {7, 16, {}, 6}};
    expect(3, 0);  // nothing of this recording
    report.keyframes = {{5, 10, {}, 0}, {6, 15, {}, 0}, {7, 16, {}, 7}};
    report.map_out.keyframes = 6;
    expect(1, 1);
}

TEST(RunReport, SegmentsAreTheTracksThatFramesAreInInTheEnd) {
    RunReport report = trackedReport();  // three frames of keyframe 0
    const auto add = [&](FrameStatus status, int keyframe) {
        report.frames.emplace_back();
        report.frames.back().result.status = status;
        report.frames.back().result.keyframe = keyframe;
    };
    report.keyframes = {{0, 10, {}, 0}, {1, 15, {}, 1}, {2, 16, {}, 1}, {3, 17, {}, 0}, {4, 18, {}, 4}};
    add(FrameStatus::kPredicted, 0);
    add(FrameStatus::kRejected, -1);
    add(FrameStatus::kInitialised, 1);
    add(FrameStatus::kOk, 2);
    add(FrameStatus::kOk, 3);  // found again in the first one
    add(FrameStatus::kInitialised, 4);
    EXPECT_EQ(report.segments(), (std::vector<int>{1, 1, 1, 1, 0, 2, 2, 1, 3}));
    report.keyframes[4].track = 1;  // joined
    EXPECT_EQ(report.segments(), (std::vector<int>{1, 1, 1, 1, 0, 2, 2, 1, 2}));
    report.keyframes[1].track = report.keyframes[2].track = report.keyframes[4].track = 0;
    EXPECT_EQ(report.segments(), (std::vector<int>{1, 1, 1, 1, 0, 1, 1, 1, 1}));
    const std::string csv = framesCsv(report);
    EXPECT_NE(csv.find("map_reason,segment\n"), std::string::npos);
    EXPECT_EQ(csv.substr(csv.size() - 3), ",1\n");
}

TEST(RunReport, IntrinsicsOfALargerImageAreWarnedOf) {
    RunReport report = trackedReport();
    report.camera = {320, 240, 262, 262, 159.5, 119.5, {}};
    EXPECT_EQ(report.cameraWarning(), "");
    report.camera = {320, 240, 525, 525, 319.5, 239.5, {}};
    report.camera_source = "--intrinsics";
    EXPECT_EQ(report.cameraWarning(),
              "the optical axis is far from the middle of the image: pixel 319.5, 239.5 of 320 x 240. Are "
              "these the "
              "intrinsics of another image size? They are from --intrinsics");
    report.camera = {320, 240, 262, 262, 159.5, 239.5, {}};
    EXPECT_NE(report.cameraWarning(), "");
}

TEST(RunReport, AMapIsOnePieceWithWhatWasRecognisedInIt) {
    RunReport report = trackedReport();
    report.map_in = LoadedMap{"room.map", 5, false};
    EXPECT_EQ(report.localised(), nullptr);
    EXPECT_NE(report.mapWarning().find("room.map: never recognised"), std::string::npos);
    EXPECT_EQ(report.losses().pieces, 1U);
    report.frames[2].result.joined_at = 7;
    EXPECT_EQ(report.localised(), nullptr) << "a keyframe of this recording";
    report.frames[2].result.joined_at = 4;
    ASSERT_EQ(report.localised(), &report.frames[2].result);
    EXPECT_EQ(report.mapKeyframeOf(*report.localised()), 4);
    EXPECT_EQ(report.mapWarning(), "");
    EXPECT_EQ(report.losses().pieces, 1U) << "begun in a world of its own, and joined";
    report.frames[2].result.joined_at = -1;
    report.frames[0].result.found_at = 0;
    EXPECT_EQ(report.localised(), &report.frames[0].result);
    EXPECT_EQ(report.losses().pieces, 1U);
    EXPECT_EQ(report.losses().found_again, 0U) << "nothing was lost";
    report.frames[0].result.found_at = -1;
    report.frames[2].result.found_at = 3;
    EXPECT_EQ(report.losses().pieces, 2U) << "what came before was not joined";
    EXPECT_EQ(report.losses().toText(), "lost once, found in the map");
    EXPECT_EQ(report.losses().found_again, 0U) << "it was never there before";
    report.frames[2].result.found_at = -1;
    report.frames[2].result.joined_at = 3;
    EXPECT_EQ(report.losses().joined, 0U) << "nothing was begun anew";
}

TEST(RunReport, ThePieceThatIsInTheMapsWorldIsNamed) {
    RunReport report = trackedReport();
    report.map_in = LoadedMap{"room.map", 5, false};
    report.keyframes = {{5, 10, {}, 5}, {6, 15, {}, 6}};
    for (const std::size_t i : {0U, 1U}) report.frames[i].result.keyframe = 5;
    report.frames[2].result.keyframe = 6;
    EXPECT_EQ(report.mapSegment(), 0);
    report.frames[2].result.found_at = 3;
    report.keyframes[1].track = 0;
    EXPECT_EQ(report.mapSegment(), 2);
    const std::string warning = report.mapWarning();
    EXPECT_NE(warning.find("room.map: only segment 2 of 2 "), std::string::npos) << warning;
    EXPECT_NE(
        covariancesText(report).find("# relative to the first keyframe of the map from 12.000000 on, and "
                                     "to the run's own start before\n"),
        std::string::npos);
    report.keyframes[0].track = 0;  // joined later
    EXPECT_EQ(report.mapSegment(), 1);
    EXPECT_EQ(report.mapWarning(), "");
    report.frames[2].result.found_at = -1;  // or only when the last frame had been
    EXPECT_EQ(report.mapSegment(), 1);
    EXPECT_EQ(report.mapWarning(), "");
}

}  // namespace
}  // namespace roevo
