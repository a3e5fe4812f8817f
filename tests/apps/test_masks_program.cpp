// --mask: what is always in view and moves with the camera.
#include <opencv2/imgcodecs.hpp>

#include "apps/odometry_fixture.h"
#include "recordings/frame_source.h"

namespace roevo {
namespace {

using test::expectError;
using test::OdometryProgram;
using test::readFile;
using test::slidingRecording;
using test::TumFrame;

const cv::Rect kArm(90, 130, 130, 110);

std::vector<TumFrame> withArm(int frames) {
    auto recording = slidingRecording(frames);
    for (TumFrame& frame : recording)
        for (int y = kArm.y; y < kArm.br().y; ++y)
            for (int x = kArm.x; x < kArm.br().x; ++x) {
                frame.colour.at<cv::Vec3b>(y, x) = cv::Vec3b::all((x + 2 * y) / 10 % 2 == 0 ? 30 : 220);
                frame.depth.at<std::uint16_t>(y, x) = 2500;
            }
    return recording;
}

class MaskOption : public OdometryProgram {
  protected:
    std::string mask(const cv::Mat& image) const {
        const std::string file = folder_ / "mask.png";
        cv::imwrite(file, image);
        return file;
    }
    std::string armMask() const {
        cv::Mat image(240, 320, CV_8UC1, cv::Scalar(255));
        image(kArm).setTo(0);
        return mask(image);
    }
    double error() const { return summary()["ground_truth"]["ate_m"]["rmse"]; }
};

TEST_F(MaskOption, LeavesTheRobotsArmOut) {
    ASSERT_EQ(runFrames(withArm(30)).exit_code, 0);
    const double misled = error();
    const auto result = run(folder_ / "recording", {"--mask", armMask()});
    ASSERT_EQ(result.exit_code, 0) << result.all();
    EXPECT_GT(misled, 0.02) << "else the arm is no test";
    EXPECT_LT(error(), 0.005);
    EXPECT_NE(result.out.find("mask.png leaves out 18.6 % of the image"), std::string::npos) << result.out;
}

TEST_F(MaskOption, BlackIsBlackInAJpegAndWhiteMayBeOne) {
    ASSERT_EQ(runFrames(withArm(12), {"--mask", armMask()}).exit_code, 0);
    const std::string trajectory = readFile(output() + "/trajectory.txt");
    cv::Mat ones(240, 320, CV_8UC1, cv::Scalar(1)), nearly(240, 320, CV_8UC1, cv::Scalar(251));
    ones(kArm).setTo(0);
    nearly(kArm).setTo(4);
    for (const cv::Mat& other : {ones, nearly}) {
        ASSERT_EQ(run(folder_ / "recording", {"--mask", mask(other)}).exit_code, 0);
        EXPECT_EQ(readFile(output() + "/trajectory.txt"), trajectory);
    }
}

TEST_F(MaskOption, OtherMethodsGetNoDepthThere) {
    test::writeTumFolder(folder_ / "recording", withArm(2));
    InputChoice choice;
    choice.mask = armMask();
    const auto source = openSource(folder_ / "recording", choice);
    for (SourceFrame frame; source->next(frame);) {
        EXPECT_EQ(cv::countNonZero(frame.frame.depth(kArm)), 0);
        EXPECT_GT(cv::countNonZero(frame.frame.depth), 20000);
        EXPECT_EQ(cv::countNonZero(frame.frame.mask), 320 * 240 - kArm.area());
    }
}

TEST_F(MaskOption, WhatIsNoMaskIsRefusedByName) {
    test::writeTumFolder(folder_ / "recording", slidingRecording(3));
    const auto with = [&](const std::string& file) { return run(folder_ / "recording", {"--mask", file}); };
    expectError(with(folder_ / "none.png"), 1, kName, {"none.png"});
    expectError(with(mask(cv::Mat::ones(480, 640, CV_8UC1))), 1, kName,
                {"mask.png is 640x480", "the colour images are 320x240"});
    expectError(with(mask(cv::Mat::zeros(240, 320, CV_8UC1))), 1, kName, {"mask.png is all black"});
    cv::Mat transparent(240, 320, CV_8UC4, cv::Scalar::all(255));
    transparent(kArm).setTo(cv::Scalar(255, 255, 255, 0));
    for (const cv::Mat& nowhere : {transparent, cv::Mat(240, 320, CV_8UC1, cv::Scalar(255))})
        expectError(with(mask(nowhere)), 1, kName,
                    {"mask.png is black nowhere (transparency does not count), which leaves nothing out"});
    test::writeFile(folder_ / "text.png", "black and white");
    expectError(with(folder_ / "text.png"), 1, kName, {"text.png"});
}

}  // namespace
}  // namespace roevo
