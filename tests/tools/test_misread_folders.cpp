// Folders that look like something else: a wrong trajectory without a word is worse than an error.
#include <gtest/gtest.h>

#include <limits>
#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>

#include "recordings/dataset_reader.h"
#include "recordings/depth_scale.h"
#include "recordings/lens.h"
#include "tools/small_dataset.h"

namespace roevo {
namespace {

namespace fs = std::filesystem;
using test::errorOf;
using test::SmallDataset;

TEST(MisreadFolders, BundleFusionIsNot7Scenes) {
    for (const char* file : {"info.txt", "../camera-intrinsics.txt", "frame-000100.color.jpg"}) {
        const SmallDataset folder("7scenes");
        folder.remove("camera.txt");
        folder.write(file, "a camera of its own");
        EXPECT_CONTAINS(errorOf([&] { openDataset(folder.path()); }), "is of another dataset") << file;
        DatasetOptions chosen;
        chosen.format = "7scenes";
        EXPECT_CONTAINS(errorOf([&] { openDataset(folder.path(), chosen); }), "but the camera is 640x480");
    }
}

TEST(MisreadFolders, IntrinsicsOfImagesOfAnotherSize) {
    const SmallDataset folder("plain");
    DatasetOptions options;
    options.folder.depth_scale = 5000;
    options.folder.intrinsics = {60, 60, 41, 23.5};  // 64x48 pixels, the middle is 31.5
    EXPECT_EQ(errorOf([&] { openDataset(folder.path(), options); }), "");
    options.folder.intrinsics = {120, 120, 63.5, 47};
    EXPECT_CONTAINS(
        errorOf([&] { openDataset(folder.path(), options); }),
        "the command line says 64x48 fx 120 fy 120 cx 63.5 cy 47, no lens distortion: the principal point "
        "is far from the middle");
    options.folder.intrinsics = {30, 30, 15.5, 11.5};
    EXPECT_CONTAINS(errorOf([&] { openDataset(folder.path(), options); }), "far from the middle");
    folder.write("camera.txt", "width: 64\nheight: 48\nfx: 60\nfy: 60\ncx: 60\ncy: 40\ndepth_scale: 5000\n");
    EXPECT_EQ(errorOf([&] { openDataset(folder.path()); }), "") << "a camera whose size is told";
}

TEST(MisreadFolders, CalibrationsThatDifferInTheLens) {
    const SmallDataset folder("plain");
    folder.remove("camera.txt");
    const std::string camera = R"("width": 64, "height": 48, "fx": 60, "fy": 60, "cx": 31, "cy": 23)";
    folder.write("a.json", "{" + camera + "}");
    folder.write("b.json", "{" + camera + R"(, "coeffs": [0, 0, 0, 0, 0]})");
    EXPECT_EQ(errorOf([&] { openDataset(folder.path()); }), "") << "which says the same";
    folder.write("b.json", "{" + camera + R"(, "coeffs": [0.1, -0.2, 0, 0, 0]})");
    const std::string error = errorOf([&] { openDataset(folder.path()); });
    EXPECT_CONTAINS(error,
                    "two intrinsics that differ: a.json (64x48 fx 60 fy 60 cx 31 cy 23, no lens distortion)");
    EXPECT_CONTAINS(error, "and b.json (64x48 fx 60 fy 60 cx 31 cy 23, lens distortion)");
}

TEST(MisreadFolders, ADepthCameraOfAnotherFocalLengthIsNamed) {
    const SmallDataset folder("plain");
    folder.remove("camera.txt");
    const std::string camera = R"("width": 64, "height": 48, "fy": 60, "ppx": 31, "ppy": 23, "fx": )";
    folder.write("camera.json", "{\"color\": {" + camera + "60}, \"depth\": {" + camera + "60}}");
    EXPECT_EQ(openDataset(folder.path()).summary().find("focal length"), std::string::npos);
    folder.write("camera.json", "{\"color\": {" + camera + "60}, \"depth\": {" + camera + "70}}");
    EXPECT_CONTAINS(openDataset(folder.path()).summary(),
                    "the calibration also has a depth camera of another focal length");
}

TEST(MisreadFolders, GroundTruthThatCountsFramesAsTheImagesDo) {
    const SmallDataset folder("plain", 60);
    std::string numbers, seconds;
    for (int i = 0; i < 60; i++) {
        for (const auto& image : {folder.colour(i), folder.depth(i)})
            fs::rename(folder / image,
                       folder / (image.substr(0, image.find('/') + 1) + std::to_string(i) + ".png"));
        numbers += std::to_string(i) + " 0 0 " + std::to_string(i) + " 0 0 0 1\n";
        if (i < 3) seconds += std::to_string(i) + " 0 0 " + std::to_string(i) + " 0 0 0 1\n";
    }
    for (const char* rate : {"30", "5"}) {
        folder.writeCamera("5000", std::string("frame_rate: ") + rate + "\n");
        folder.write("groundtruth.txt", numbers);
        const DatasetReader counted = openDataset(folder.path());
        EXPECT_CONTAINS(counted.summary(), "the ground truth counts frames, as the images do");
        ASSERT_EQ(counted.groundTruth().poses.size(), 60u);
        EXPECT_EQ(counted.groundTruth().poses[59].timestamp, counted.entry(59).timestamp);
    }
    folder.writeCamera("5000");
    folder.write("groundtruth.txt", seconds);
    EXPECT_EQ(openDataset(folder.path()).groundTruth().poses[2].timestamp, 2) << "one pose a second";
}

TEST(MisreadFolders, ImagesAreNotTurnedAsTheCameraWasHeld) {
    const SmallDataset folder("plain");
    cv::Mat image(48, 64, CV_8UC3, cv::Scalar(0, 0, 0));
    image.rowRange(0, 24).setTo(cv::Scalar(255, 255, 255));
    std::vector<unsigned char> bytes;
    cv::imencode(".jpg", image, bytes);
    // EXIF with one entry: orientation 3, upside down
    const unsigned char exif[] = {0xFF, 0xE1, 0, 34, 'E', 'x', 'i', 'f', 0, 0, 'M', 'M', 0, 42, 0, 0, 0, 8,
                                  0,    1,    1, 18, 0,   3,   0,   0,   0, 1, 0,   3,   0, 0,  0, 0, 0, 0};
    bytes.insert(bytes.begin() + 2, std::begin(exif), std::end(exif));
    const std::string file = folder / folder.colour(0);
    folder.remove(folder.colour(0));
    test::writeFile(file.substr(0, file.size() - 3) + "jpg", std::string(bytes.begin(), bytes.end()));
    ASSERT_EQ(cv::imread(file.substr(0, file.size() - 3) + "jpg").at<cv::Vec3b>(5, 5)[0], 0)
        << "is turned by others";
    EXPECT_EQ(openDataset(folder.path()).readImage(0).at<cv::Vec3b>(5, 5)[0], 255);
}

TEST(MisreadFolders, ACameraFilesRateCountsInEveryLayout) {
    for (const char* layout : {"icl", "7scenes"}) {
        const SmallDataset folder(layout);
        folder.writeCamera(std::to_string(folder.unitsPerMetre()), "frame_rate: 15\n");
        const DatasetReader dataset = openDataset(folder.path());
        EXPECT_EQ(dataset.entry(2).timestamp, 6.8) << layout;
        EXPECT_CONTAINS(dataset.summary(), "times are frame numbers at 15 Hz");
        EXPECT_EQ(dataset.groundTruth().poses[2].timestamp, 6.8) << layout;
    }
}

TEST(MisreadFolders, DepthWithoutEndIsNone) {
    cv::Mat depth(48, 64, CV_32FC1, cv::Scalar(2));
    depth.rowRange(0, 30).setTo(std::numeric_limits<float>::infinity());
    EXPECT_EQ(medianDepth(depth, 0), 2);
}

TEST(MisreadFolders, LensNamesOfPyrealsense) {
    PinholeCamera camera;
    setLens("distortion.brown_conrady", {0.1, 0.2}, camera);
    EXPECT_EQ(camera.distortion[1], 0.2);
    setLens("distortion.kannala_brandt4", {0.1, 0.2}, camera);
    EXPECT_EQ(camera.lens, LensModel::kKannalaBrandt);
}

TEST(MisreadFolders, IclWithTimesForNumbersIsRefused) {
    const SmallDataset folder("icl");
    folder.remove("associations.txt");
    for (int i = 0; i < 3; i++)
        for (const auto& image : {folder.colour(i), folder.depth(i)})
            fs::rename(folder / image, folder / (image.substr(0, image.find('/') + 1) + "1305031453." +
                                                 std::to_string(i) + ".png"));
    EXPECT_CONTAINS(errorOf([&] { openDataset(folder.path()); }), "its images are named by times");
}

}  // namespace
}  // namespace roevo
