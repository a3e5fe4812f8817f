// Whether the unit of depth makes sense.
#include <gtest/gtest.h>

#include <limits>

#include "recordings/depth_scale.h"
#include "recordings/frame_source.h"

namespace roevo {
namespace {

RgbdFrame frameOf(float metres) {
    RgbdFrame frame;
    frame.depth = cv::Mat(4, 5, CV_32FC1, cv::Scalar(0));
    frame.depth.rowRange(0, 2).setTo(metres);
    return frame;
}

TEST(DepthScale, TheMedianIsOfWhatIsKnown) {
    const cv::Mat units = (cv::Mat_<std::uint16_t>(2, 4) << 0, 0, 7, 65535, 65535, 65535, 9, 8);
    EXPECT_EQ(medianDepth(units, 65535), 8);
    EXPECT_EQ(medianDepth(units), 65535);
    EXPECT_EQ(medianDepth(cv::Mat(3, 3, CV_16UC1, cv::Scalar(0))), 0);
    constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();
    EXPECT_EQ(medianDepth((cv::Mat_<float>(1, 6) << kNaN, -1, 0, 1.5f, 2.5f, 3.5f)), 2.5);
    EXPECT_EQ(medianDepth(cv::Mat()), 0);
}

TEST(DepthScale, PlausibleIsATenthOfAMetreToTwentyMetres) {
    EXPECT_TRUE(isPlausibleMedianDepth(0.1));
    EXPECT_TRUE(isPlausibleMedianDepth(20));
    EXPECT_FALSE(isPlausibleMedianDepth(0.0999));
    EXPECT_FALSE(isPlausibleMedianDepth(20.001));
    EXPECT_FALSE(isPlausibleMedianDepth(std::numeric_limits<double>::quiet_NaN()));
}

TEST(DepthScale, LikelyScalesComeNearestToTwoMetresFirst) {
    EXPECT_EQ(likelyDepthScales(20500), "depth_scale 10000 would give 2.05 m, 5000 would give 4.1 m");
    EXPECT_EQ(likelyDepthScales(0.01), "");
}

TEST(DepthScale, AFaultNamesTheLikelyFactor) {
    EXPECT_EQ(depthScaleFault(frameOf(2)), "");
    EXPECT_EQ(depthScaleFault(frameOf(0)), "") << "no depth says nothing about the scale";
    EXPECT_EQ(depthScaleFault(RgbdFrame()), "");
    EXPECT_EQ(depthScaleFault(frameOf(2500)),
              "the depth scale makes no sense: the median depth of the first frame is 2500 m (0.1 to 20 m is "
              "plausible); depths are likely to be 1000 times too large, which would make it 2.5 m");
    EXPECT_EQ(depthScaleFault(frameOf(0.002f)),
              "the depth scale makes no sense: the median depth of the first frame is 0.002 m (0.1 to 20 m "
              "is plausible); depths are likely to be 1000 times too small, which would make it 2 m");
}

TEST(DepthScale, OnlyTheFirstGoodFrameIsLookedAt) {
    SourceFrame unreadable, good, wrong;
    unreadable.fault = "no image";
    good.frame = frameOf(2);
    wrong.frame = frameOf(2000);

    DepthScaleCheck check;
    EXPECT_EQ(check.faultOf(unreadable), "");
    EXPECT_FALSE(check.isDone());
    EXPECT_EQ(check.faultOf(good), "");
    EXPECT_TRUE(check.isDone());
    EXPECT_EQ(check.faultOf(wrong), "");
    EXPECT_NE(DepthScaleCheck().faultOf(wrong), "");
}

}  // namespace
}  // namespace roevo
