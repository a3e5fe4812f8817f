#include <gtest/gtest.h>
#include <mrpt/io/CMemoryStream.h>
#include <mrpt/serialization/CArchive.h>

#include <cmath>
#include <cstdlib>
#include <opencv2/imgcodecs.hpp>
#include <random>

#include "mrpt/test_helpers.h"
#include "roevo_mrpt/camera_conversions.h"
#include "roevo_mrpt/image_conversions.h"
#include "roevo_mrpt/pose_conversions.h"
#include "roevo_mrpt/simple_map.h"
#include "roevo_mrpt/time_conversions.h"

namespace roevo {
namespace {

using test::errorOf;

Pose randomPose(std::mt19937& rng) {
    std::uniform_real_distribution<double> number(-1, 1);
    Pose pose = Pose::Identity();
    const Eigen::Vector3d axis(number(rng), number(rng), number(rng));
    pose.setRotation(Eigen::AngleAxisd(1.2 * number(rng), axis.normalized()).toRotationMatrix());
    pose.translation() << 3 * number(rng), 3 * number(rng), 3 * number(rng);
    return pose;
}

TEST(TimeConversions, WhatWasPrintedWithSixDecimalsComesBackToTheBit) {
    std::mt19937 rng(1);
    std::uniform_int_distribution<long long> microseconds(0, 2'000'000'000'000'000LL);
    for (int i = 0; i < 20000; i++) {
        const long long us = microseconds(rng);
        char text[40];
        std::snprintf(text, sizeof text, "%lld.%06lld", us / 1000000, us % 1000000);
        const double stamp = std::strtod(text, nullptr);
        ASSERT_EQ(roundToMicroseconds(stamp), stamp) << text;
        ASSERT_EQ(fromMrptTime(toMrptTime(stamp)), stamp) << text;
    }
}

TEST(TimeConversions, WhatIsRoundedIsWhatIsPrinted) {
    std::mt19937 rng(2);
    std::uniform_real_distribution<double> seconds(1.6e9, 1.8e9);
    for (int i = 0; i < 20000; i++) {
        const double stamp = seconds(rng);
        char printed[40], rounded[40];
        std::snprintf(printed, sizeof printed, "%.6f", stamp);
        std::snprintf(rounded, sizeof rounded, "%.6f", roundToMicroseconds(stamp));
        ASSERT_STREQ(rounded, printed);
        ASSERT_EQ(fromMrptTime(toMrptTime(stamp)), roundToMicroseconds(stamp));
    }
    EXPECT_TRUE(std::isnan(roundToMicroseconds(NAN)));
    EXPECT_EQ(roundToMicroseconds(1e300), 1e300);
}

TEST(TimeConversions, AgreesWithMrptsClock) {
    const double stamp = 1305031453.359684;
    EXPECT_NEAR(mrpt::Clock::toDouble(toMrptTime(stamp)), stamp, 3e-7);
    EXPECT_EQ(fromMrptTime(mrpt::Clock::fromDouble(stamp)), stamp);
    EXPECT_EQ(fromMrptTime(toMrptTime(0)), 0);
    EXPECT_THROW(toMrptTime(NAN), std::runtime_error);
    EXPECT_THROW(toMrptTime(1e18), std::runtime_error);
}

TEST(PoseConversions, OpticalAxesAreMrptsDefaultForTheIntensityCamera) {
    const mrpt::poses::CPose3D mrpt_default(0, 0, 0, -M_PI / 2, 0, -M_PI / 2);
    EXPECT_TRUE(sensorFromOptical().isApprox(toEigen(mrpt_default), 1e-12));
    // forward is z in optical axes and x in the sensor's; right is x and -y.
    EXPECT_TRUE((sensorFromOptical() * Eigen::Vector3d(0, 0, 1)).isApprox(Eigen::Vector3d(1, 0, 0)));
    EXPECT_TRUE((sensorFromOptical() * Eigen::Vector3d(1, 0, 0)).isApprox(Eigen::Vector3d(0, -1, 0)));
}

TEST(PoseConversions, RoundTrips) {
    std::mt19937 rng(2);
    for (int i = 0; i < 100; i++) {
        const Pose pose = randomPose(rng);
        EXPECT_TRUE(toEigen(toMrpt(pose)).isApprox(pose, 1e-12));
        EXPECT_TRUE(opticalPoseFromSensor(sensorPoseFromOptical(pose)).isApprox(pose, 1e-12));
    }
}

TEST(PoseConversions, CovarianceFollowsTheNumericJacobian) {
    std::mt19937 rng(3);
    for (int trial = 0; trial < 30; trial++) {
        const Pose T_world_camera = randomPose(rng), T_camera_body = randomPose(rng);
        Matrix6d root = Matrix6d::Random(), J;
        const Matrix6d covariance = 1e-4 * root * root.transpose();
        const double step = 1e-6;
        const auto moved = [&](int axis, double by) {
            Vector6d d = Vector6d::Zero();
            d[axis] = by;
            Pose pose = T_world_camera;
            pose.translation() += d.head<3>();
            if (axis >= 3)
                pose.setRotation(Eigen::AngleAxisd(by, d.tail<3>() / by).toRotationMatrix() * pose.linear());
            const auto p = toMrpt(pose * T_camera_body);
            Vector6d out;
            out << p.x(), p.y(), p.z(), p.yaw(), p.pitch(), p.roll();
            return out;
        };
        for (int axis = 0; axis < 6; axis++) {
            Vector6d difference = moved(axis, step) - moved(axis, -step);
            for (int k = 3; k < 6; k++) difference[k] = std::remainder(difference[k], 2 * M_PI);
            J.col(axis) = difference / (2 * step);
        }
        const Matrix6d expected = J * covariance * J.transpose();
        const auto gaussian = toMrptGaussian(T_world_camera, covariance, T_camera_body);
        for (int r = 0; r < 6; r++)
            for (int c = 0; c < 6; c++)
                EXPECT_NEAR(gaussian.cov(r, c), expected(r, c), 1e-5 * expected.norm());
        EXPECT_TRUE(toEigen(gaussian.mean).isApprox(T_world_camera * T_camera_body, 1e-9));
    }
}

TEST(PoseConversions, TheRobotsMotionFollowsTheCameras) {
    std::mt19937 rng(4);
    for (int trial = 0; trial < 30; trial++) {
        const Pose T_from_to = randomPose(rng), from = randomPose(rng), to = randomPose(rng);
        Matrix6d root = Matrix6d::Random(), J;
        const Matrix6d covariance = 1e-4 * root * root.transpose();
        const double step = 1e-6;
        const auto moved = [&](int axis, double by) {
            Vector6d d = Vector6d::Zero();
            d[axis] = by;
            // Along the axes of the second camera
            const Pose error(
                Eigen::Quaterniond(Eigen::AngleAxisd(d.tail<3>().norm(), d.tail<3>().stableNormalized())),
                d.head<3>());
            const auto p = toMrpt(from * T_from_to * error * to.inverse());
            Vector6d out;
            out << p.x(), p.y(), p.z(), p.yaw(), p.pitch(), p.roll();
            return out;
        };
        for (int axis = 0; axis < 6; axis++) {
            Vector6d difference = moved(axis, step) - moved(axis, -step);
            for (int k = 3; k < 6; k++) difference[k] = std::remainder(difference[k], 2 * M_PI);
            J.col(axis) = difference / (2 * step);
        }
        const Matrix6d expected = J * covariance * J.transpose();
        const auto gaussian = robotMotion(T_from_to, covariance, from, to);
        for (int r = 0; r < 6; r++)
            for (int c = 0; c < 6; c++)
                EXPECT_NEAR(gaussian.cov(r, c), expected(r, c), 1e-5 * expected.norm());
        EXPECT_TRUE(toEigen(gaussian.mean).isApprox(from * T_from_to * to.inverse(), 1e-9));
    }
}

TEST(PoseConversions, ARobotWithoutMountsIsToldOf) {
    EXPECT_THROW((void)RobotContext().mountAt(0), std::logic_error);
    EXPECT_THROW((void)RobotContext().robotPose(0, Pose::Identity()), std::logic_error);
}

TEST(CameraConversions, RoundTripWithAndWithoutDistortion) {
    PinholeCamera camera{640, 480, 517.3, 516.5, 318.6, 255.3, {0.2624, -0.9531, -0.0054, 0.0026, 1.1633}};
    EXPECT_EQ(fromMrptCamera(toMrptCamera(camera, "a"), "colour camera"), camera);
    camera.distortion = {};
    EXPECT_EQ(fromMrptCamera(toMrptCamera(camera, "a"), "colour camera"), camera);
}

TEST(CameraConversions, UntouchedCameraHasNoIntrinsics) {
    const std::string error = errorOf([] { fromMrptCamera(mrpt::img::TCamera(), "colour camera"); });
    EXPECT_NE(error.find("no intrinsics"), std::string::npos) << error;
    EXPECT_NE(error.find("colour camera"), std::string::npos) << error;
}

TEST(CameraConversions, OtherLensesRoundTripThroughAFile) {
    const PinholeCamera rational{
        640, 480, 500, 501, 320, 240, {0.5, -2.6, 6e-4, -2e-4, 1.5}, {0.4, -2.4, 1.4}};
    const PinholeCamera fisheye{
        640, 480, 290, 291, 320, 240, {-0.01, 0.04, -0.03, 0.009, 0}, {}, LensModel::kKannalaBrandt};
    for (const PinholeCamera& camera : {rational, fisheye}) {
        mrpt::io::CMemoryStream stream;
        auto archive = mrpt::serialization::archiveFrom(stream);
        archive << toMrptCamera(camera, "a");
        stream.Seek(0);
        mrpt::img::TCamera read;
        archive >> read;
        EXPECT_EQ(fromMrptCamera(read, "colour camera"), camera);
        EXPECT_NE(fromMrptCamera(read, "colour camera"), camera.undistorted());
    }
}

TEST(ImageConversions, DepthIsTheFloatProduct) {
    cv::Mat depth(1, 65536, CV_16UC1), grey;
    for (int i = 0; i < depth.cols; i++) depth.at<std::uint16_t>(0, i) = static_cast<std::uint16_t>(i);
    const float unit = depthUnit(5000);
    const cv::Mat metres = depthToMetres(depth, unit);
    for (int i = 0; i < depth.cols; i++)
        ASSERT_EQ(metres.at<float>(0, i), static_cast<float>(i) * (1.f / 5000.f));
}

TEST(ImageConversions, GreyOfGreyIsShared) {
    const cv::Mat grey(4, 5, CV_8UC1, cv::Scalar(7)), colour(4, 5, CV_8UC3, cv::Scalar(9, 9, 9));
    EXPECT_EQ(toGrey(grey).data, grey.data);
    EXPECT_EQ(toGrey(colour).at<std::uint8_t>(2, 2), 9);
    EXPECT_THROW(toGrey(cv::Mat(4, 5, CV_16UC1)), std::runtime_error);
}

TEST(ImageConversions, FilesThatAreMissingDamagedOrOfTheWrongKindAreNamed) {
    const test::TemporaryFolder folder;
    const cv::Mat noise(50, 60, CV_8UC1);
    cv::randu(noise, 0, 256);
    cv::imwrite(folder / "eight.png", noise);
    std::filesystem::copy_file(folder / "eight.png", folder / "cut.png");
    std::filesystem::resize_file(folder / "cut.png", std::filesystem::file_size(folder / "cut.png") / 2);
    const auto error = [&](const std::string& name) {
        return errorOf([&] { readDepthFile(folder / name); });
    };
    EXPECT_NE(error("eight.png").find("16-bit"), std::string::npos);
    EXPECT_NE(error("eight.png").find("eight.png"), std::string::npos);
    EXPECT_NE(error("none.png").find("not found"), std::string::npos);
    EXPECT_NE(errorOf([&] { readColourFile(folder / "cut.png"); }).find("cut.png"), std::string::npos);
    EXPECT_EQ(errorOf([&] { writeImageFile(folder / "none", noise); }),
              "cannot write " + folder / "none" + ": the image cannot be encoded");
    EXPECT_THROW(writeImageFile(folder / "a.zzz", noise), std::runtime_error);
    EXPECT_THROW(writeImageFile(folder / "a.png", cv::Mat()), std::runtime_error);
}

}  // namespace
}  // namespace roevo
