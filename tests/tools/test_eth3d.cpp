#include <gtest/gtest.h>

#include "recordings/dataset_reader.h"
#include "tools/small_dataset.h"

namespace roevo {
namespace {

using test::errorOf;
using test::SmallDataset;

std::string errorOfOpening(const SmallDataset& folder) {
    return errorOf([&] { openDataset(folder.path()); });
}

TEST(Eth3d, CalibrationIsOneLineOfFourNumbersAndTheSizeIsThatOfTheImages) {
    const SmallDataset folder("eth3d");
    EXPECT_CONTAINS(openDataset(folder.path()).summary(), "from calibration.txt, size from the images");
    folder.write("calibration.txt", "60 61 31.5\n");
    EXPECT_CONTAINS(errorOfOpening(folder), "calibration.txt must have one line 'fx fy cx cy'");
    folder.write("calibration.txt", "");
    EXPECT_CONTAINS(errorOfOpening(folder), "no intrinsics");
    folder.write("calibration.txt", "60 61 x 23.5\n");
    EXPECT_CONTAINS(errorOfOpening(folder), "calibration.txt:1: 'x' is not a number");
    folder.write("calibration.txt", "60 61 310.5 230.5\n");  // of a larger image
    EXPECT_CONTAINS(errorOfOpening(folder), "principal point (310.5, 230.5) is outside the 64x48 image");
    folder.write("calibration.txt", "0 61 31.5 23.5\n");
    EXPECT_CONTAINS(errorOfOpening(folder), "no intrinsics");
}

TEST(Eth3d, WithoutCalibrationItIsStillRecognised) {
    const SmallDataset folder("eth3d");
    folder.remove("calibration.txt");
    EXPECT_CONTAINS(errorOfOpening(folder), "calibration.txt is missing");
    EXPECT_CONTAINS(errorOfOpening(folder), "one line 'fx fy cx cy'");
    folder.remove("rgb.txt");
    folder.remove("depth.txt");
    EXPECT_CONTAINS(errorOfOpening(folder), "calibration.txt is missing");
    folder.writeCamera("5000");  // the user's word
    EXPECT_EQ(openDataset(folder.path()).description().format, "eth3d");
}

TEST(Eth3d, AUsersAssociatedListDoesNotTakeASequenceFromTum) {
    const SmallDataset named("eth3d", 3, "rgbd_dataset_freiburg1_desk"), described("eth3d");
    named.remove("calibration.txt");
    EXPECT_CONTAINS(errorOfOpening(named), "64x48, but the camera is 640x480") << "that of freiburg1";
    described.remove("calibration.txt");
    described.writeCamera("5000");
    EXPECT_EQ(openDataset(described.path()).description().format, "tum");
}

TEST(Eth3d, SizeIsTakenFromTheFirstImageThatCanBeRead) {
    const SmallDataset folder("eth3d");
    std::filesystem::resize_file(folder / folder.colour(0), 40);
    EXPECT_EQ(openDataset(folder.path()).camera().width, 64);
    for (int i = 0; i < 3; i++) std::filesystem::resize_file(folder / folder.colour(i), 40);
    EXPECT_CONTAINS(errorOfOpening(folder), folder.colour(0));
}

TEST(Eth3d, InertialSamplesInEitherOrderOfColumns) {
    const SmallDataset folder("eth3d");
    EXPECT_TRUE(openDataset(folder.path()).imu().empty());
    const std::string turn = " 0.1 -0.2 0.3", gravity = " 0.5 9.7 -1";
    for (const bool turn_first : {true, false}) {
        const std::string values = turn_first ? turn + gravity : gravity + turn;
        folder.write("imu.txt",
                     "# head\n2.5" + values + "\n1.5" + values + "\n1.5" + values + "\nbad line\n");
        const DatasetReader dataset = openDataset(folder.path());
        ASSERT_EQ(dataset.imu().size(), 2u);
        EXPECT_EQ(dataset.imu()[0].timestamp, 1.5);
        EXPECT_EQ(dataset.imu()[1].acceleration, Eigen::Vector3d(0.5, 9.7, -1));
        ASSERT_TRUE(dataset.imu()[1].angular_velocity);
        EXPECT_EQ(*dataset.imu()[1].angular_velocity, Eigen::Vector3d(0.1, -0.2, 0.3));
        EXPECT_CONTAINS(dataset.summary(), "2 samples of imu.txt, 1 line(s) left out, first: ");
        EXPECT_CONTAINS(dataset.summary(), "imu.txt:5: expected 7 numbers, found 2");
        EXPECT_CONTAINS(dataset.summary(),
                        turn_first ? "angular velocity, then acceleration" : "(acceleration, then");
    }
}

TEST(Tum, AccelerometerSamples) {
    const SmallDataset folder("tum");
    folder.write("accelerometer.txt",
                 "# timestamp ax ay az\r\n1.25 0.1 9.8 -0.3 \r\n\r\n1.5 0.2 9.7 -0.4\r\n");
    const DatasetReader dataset = openDataset(folder.path());
    ASSERT_EQ(dataset.imu().size(), 2u);
    EXPECT_EQ(dataset.imu()[0].timestamp, 1.25);
    EXPECT_EQ(dataset.imu()[0].acceleration, Eigen::Vector3d(0.1, 9.8, -0.3));
    EXPECT_FALSE(dataset.imu()[0].angular_velocity);
    EXPECT_CONTAINS(dataset.summary(), "2 samples of accelerometer.txt");
}

}  // namespace
}  // namespace roevo
