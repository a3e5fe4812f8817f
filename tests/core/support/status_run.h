#pragma once
/// An odometry that is fed frame by frame, and what must hold of every answer.

#include <gtest/gtest.h>

#include "core/support/simulated.h"
#include "roevo/odometry.h"

namespace roevo::testing {

inline const Sequence& room() {
    static const Sequence sequence = simulate(smallRoom(), 30);
    return sequence;
}

class StatusRun : public ::testing::Test {
  protected:
    FrameResult feed(const RgbdFrame& frame) {
        FrameResult result = odometry_.processFrame(frame);
        EXPECT_TRUE(result.T_world_camera.isFinite());
        EXPECT_TRUE(result.covariance.allFinite());
        if (result.status != FrameStatus::kOk) {
            EXPECT_FALSE(result.reason.empty());
        }
        EXPECT_EQ(result.reason.find('\n'), std::string::npos);
        return result;
    }
    void feedRoom(int first, int end) {
        for (int i = first; i < end; ++i) {
            const FrameResult result = feed(frameAt(i));
            EXPECT_EQ(result.status, i == 0 ? FrameStatus::kInitialised : FrameStatus::kOk)
                << i << " " << result.reason;
        }
    }
    /// With images of its own: what a test does to them it does not do to the room's.
    static RgbdFrame frameAt(int i) {
        RgbdFrame frame = room().frames[static_cast<std::size_t>(i)];
        for (cv::Mat* image : {&frame.grey, &frame.depth}) *image = image->clone();
        return frame;
    }
    static double errorAt(const FrameResult& result, int i) {
        return (result.T_world_camera.translation() -
                room().truth[static_cast<std::size_t>(i)].T_world_camera.translation())
            .norm();
    }
    Odometry odometry_{room().camera, OdometryOptions(), room().start()};
};

}  // namespace roevo::testing
