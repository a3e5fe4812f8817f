#include <gtest/gtest.h>

#include <opencv2/core.hpp>

#include "recordings/camera_file.h"
#include "recordings/dataset_reader.h"
#include "tools/small_tum_folder.h"

namespace roevo {
namespace {

namespace fs = std::filesystem;
using test::errorOf;
using test::SmallTumFolder;

std::string openError(const SmallTumFolder& folder, const DatasetOptions& options = {}) {
    const std::string error = errorOf([&] { openDataset(folder.path(), options); });
    EXPECT_EQ(error.find('\n'), std::string::npos) << error;
    return error;
}

#define EXPECT_CONTAINS(text, part) EXPECT_NE((text).find(part), std::string::npos) << (text)

TEST(Tum, ReadsFramesWithTheColourImagesTime) {
    const SmallTumFolder folder;
    const DatasetReader dataset = openDataset(folder.path());
    ASSERT_EQ(dataset.size(), 3u);
    for (std::size_t i = 0; i < 3; i++) {
        const int n = static_cast<int>(i);
        const RgbdFrame frame = dataset.readFrame(i);
        EXPECT_EQ(frame.timestamp, std::stod(SmallTumFolder::stamp(n)));
        EXPECT_EQ(dataset.entry(i).depth_timestamp, std::stod(SmallTumFolder::stamp(n, 0.004)));
        EXPECT_EQ(frame.depth.at<float>(40, 40), 10000.f * (1.f / 5000.f));
        EXPECT_EQ(frame.depth.at<float>(n, 2), 0.f);
        EXPECT_EQ(frame.colour.at<cv::Vec3b>(1, 1), cv::Vec3b(static_cast<std::uint8_t>(10 * n), 50, 90));
        EXPECT_EQ(dataset.readDepth(i).at<std::uint16_t>(40, 40), 10000);
    }
    const PinholeCamera expected{64, 48, 60, 61, 31.5, 23.5, {0.1, -0.2, 0.001, 0.002, 0.3}};
    EXPECT_EQ(dataset.camera(), expected);
    EXPECT_EQ(dataset.description().association.dropped_colour, 0u);
    EXPECT_NEAR(dataset.description().association.largest_difference, 0.004, 1e-6);
    EXPECT_NEAR(dataset.description().association.largest_gap, 0.1, 1e-5);
    EXPECT_CONTAINS(dataset.summary(), "camera.txt");
    EXPECT_EQ(dataset.groundTruthPath(), "");
}

TEST(Tum, ListsMayBeUnsortedRepeatCarryBlanksAndWindowsLineEnds) {
    const SmallTumFolder folder;
    folder.write("rgb.txt", "\xEF\xBB\xBF# c\r\n\r\n" + SmallTumFolder::stamp(2) + "\t" +
                                SmallTumFolder::rgbName(2) + "  \r\n" + SmallTumFolder::stamp(0) + " " +
                                SmallTumFolder::rgbName(0) + "\r\n   " + SmallTumFolder::stamp(0) + " " +
                                SmallTumFolder::rgbName(1) + "\r\n");
    const DatasetReader dataset = openDataset(folder.path());
    ASSERT_EQ(dataset.size(), 2u);
    EXPECT_EQ(dataset.entry(0).image, folder / SmallTumFolder::rgbName(0));
    EXPECT_EQ(dataset.entry(1).image, folder / SmallTumFolder::rgbName(2));
    EXPECT_EQ(dataset.description().association.duplicates, 1u);
    EXPECT_EQ(dataset.description().association.dropped_depth, 1u);
    EXPECT_CONTAINS(dataset.summary(), "2 frames matched, 0 colour and 1 depth images dropped, 1 repeated");
}

TEST(Tum, AssociationsFileServesWhenItIsAllThereIs) {
    for (const bool depth_first : {false, true}) {
        const SmallTumFolder folder;
        std::string text = "# comment\n";
        for (const int i : {1, 0}) {
            const std::string rgb = SmallTumFolder::stamp(i) + " " + SmallTumFolder::rgbName(i);
            const std::string depth = SmallTumFolder::stamp(i, 0.004) + " " + SmallTumFolder::depthName(i);
            text += depth_first ? depth + " " + rgb + "\n" : rgb + " " + depth + "\n";
        }
        folder.write("associations.txt", text);
        folder.remove("rgb.txt");
        folder.remove("depth.txt");
        const DatasetReader dataset = openDataset(folder.path());
        ASSERT_EQ(dataset.size(), 2u);
        EXPECT_EQ(dataset.entry(0).timestamp, std::stod(SmallTumFolder::stamp(0)));
        EXPECT_EQ(dataset.entry(0).depth, folder / SmallTumFolder::depthName(0));
    }
}

TEST(Tum, PublishedCamerasAreRecognisedAndSaid) {
    EXPECT_EQ(tumCameraNamedIn("rgbd_dataset_freiburg1_desk")->camera.fx, 517.3);
    EXPECT_EQ(tumCameraNamedIn("# file: 'rgbd_dataset_freiburg2_desk.bag'")->camera.distortion[4], 0.9172);
    EXPECT_FALSE(tumCameraNamedIn("rgbd_dataset_freiburg3_office")->camera.isDistorted());
    EXPECT_FALSE(tumCameraNamedIn("my_dataset"));

    // As the benchmark's page on file formats prints them
    EXPECT_EQ(
        tumCameraNamedIn("freiburg1")->camera,
        (PinholeCamera{640, 480, 517.3, 516.5, 318.6, 255.3, {0.2624, -0.9531, -0.0054, 0.0026, 1.1633}}));
    EXPECT_EQ(
        tumCameraNamedIn("freiburg2")->camera,
        (PinholeCamera{640, 480, 520.9, 521.0, 325.1, 249.7, {0.2312, -0.7849, -0.0033, -0.0001, 0.9172}}));
    EXPECT_EQ(tumCameraNamedIn("freiburg3")->camera,
              (PinholeCamera{640, 480, 535.4, 539.2, 320.1, 247.6, {}}));

    const SmallTumFolder folder;
    folder.remove("camera.txt");
    EXPECT_CONTAINS(openError(folder), "no intrinsics");
    folder.write("groundtruth.txt", "# ground truth trajectory\n# file: 'rgbd_dataset_freiburg2_desk.bag'\n");
    EXPECT_CONTAINS(openError(folder),
                    "64x48, but the camera is 640x480");  // recognised; these images are another camera's
    const fs::path named = fs::path(folder.path()) / "rgbd_dataset_freiburg1_x";
    fs::create_directories(named / "rgb");
    fs::create_directories(named / "depth");
    std::ofstream(named / "rgb.txt") << "1.0 rgb/1.png\n";
    std::ofstream(named / "depth.txt") << "1.0 depth/1.png\n";
    cv::imwrite((named / "rgb/1.png").string(), cv::Mat(480, 640, CV_8UC3, cv::Scalar(1)));
    cv::imwrite((named / "depth/1.png").string(), cv::Mat(480, 640, CV_16UC1, cv::Scalar(6000)));
    EXPECT_CONTAINS(openDataset(named.string()).summary(),
                    "freiburg1 camera of the TUM benchmark (named by the folder)");
    EXPECT_CONTAINS(openDataset(named.string() + "/").summary(), "freiburg1");
}

TEST(Tum, CameraFileErrorsNameTheKey) {
    const SmallTumFolder folder;
    folder.write("camera.txt", "width: 64\nheight: 48\nfx: 60\ncx: 31.5\ncy: 23.5\n");
    EXPECT_CONTAINS(openError(folder), "lacks fy, depth_scale");
    EXPECT_EQ(openError(folder).find("no intrinsics"), std::string::npos) << "it may be the scale only";
    folder.write("camera.txt", "width: 64\nfx: sixty\n");
    EXPECT_CONTAINS(openError(folder), "camera.txt:2: 'sixty' is not a number");
    folder.write("camera.txt",
                 "width: 64\nheight: 48\nfx: 60\nfy: 60\ncx: 31.5\ncy: 23.5\ndepth_scale: 5000\n"
                 "distortion_k1_k2_p1_p2_k3: 0 0 0\n");
    EXPECT_CONTAINS(openError(folder), "needs 5 number(s), found 3");
}

TEST(Tum, CameraFileLinesThatAreNotReadAreSaid) {
    const SmallTumFolder folder;
    const std::string good = "width: 64\nheight: 48\nfx: 60\nfy: 60\ncx: 31.5\ncy: 23.5\ndepth_scale: 5000\n";
    const auto errorWith = [&](const std::string& text) {
        folder.write("camera.txt", text);
        return openError(folder);
    };
    EXPECT_CONTAINS(errorWith("# a camera\n\nfx 517 # px\n" + good),
                    "camera.txt:3: expected 'key: value', found 'fx 517 '");
    EXPECT_CONTAINS(
        errorWith("widht: 64\n" + good.substr(good.find("height"))),
        "lacks width; " + (folder / "camera.txt") + ":1: unknown key 'widht', the closest is 'width'");
    EXPECT_CONTAINS(errorWith(good + "depth_to_color: 0 0 0 0 0 0 1\n"),
                    "camera.txt:8: unknown key 'depth_to_color', the closest is 'depth_to_colour'");
    EXPECT_CONTAINS(errorWith(good + "distortion_k1_k2_p1_p2: 0.1 0 0 0\n"),
                    "the closest is 'distortion_k1_k2_p1_p2_k3'");
    EXPECT_EQ(errorWith("  \r\n# note\n" + good +
                        "note: of a desk\nframe: 3\ninvalid_depth: 0\ndepth_max: 4\ndistortion_model: none\n"
                        "sensor_on_robot_x_y_z_yaw_pitch_roll_deg: 0 0 1 0 0 0\n"),
              "")
        << "keys of the user's own";
}

TEST(Tum, PairsThatSomebodyElseMatchedMustBeCloseToo) {
    SmallTumFolder folder(3);
    folder.remove("rgb.txt");
    std::string text;
    for (const int i : {0, 1, 2}) {
        const int other = i == 1 ? 2 : i;  // 104 ms apart
        text += SmallTumFolder::stamp(i) + " " + SmallTumFolder::rgbName(i) + " " +
                SmallTumFolder::stamp(other, 0.004) + " " + SmallTumFolder::depthName(other) + "\n";
    }
    folder.write("associations.txt", text);
    const DatasetReader dataset = openDataset(folder.path());
    EXPECT_EQ(dataset.size(), 2U);
    EXPECT_EQ(dataset.description().association.dropped_colour, 1U);
    EXPECT_EQ(dataset.description().association.dropped_depth, 1U);
    DatasetOptions strict;
    strict.max_time_difference = 0.001;
    EXPECT_CONTAINS(errorOf([&] { openDataset(folder.path(), strict); }), "the closest is 0.004 s apart");
}

TEST(Tum, MissingImagesCostOnlyTheirFramesWhereThatIsWanted) {
    SmallTumFolder folder(3);
    folder.remove(SmallTumFolder::rgbName(1));
    DatasetOptions options;
    options.tolerate_missing = true;
    const DatasetReader dataset = openDataset(folder.path(), options);
    EXPECT_CONTAINS(dataset.summary(), "warning: 1 listed image(s) missing");
    EXPECT_NO_THROW(dataset.readFrame(0));
    EXPECT_CONTAINS(errorOf([&] { dataset.readFrame(1); }), SmallTumFolder::rgbName(1));
    EXPECT_NO_THROW(dataset.readFrame(2));
    for (const int i : {0, 2}) folder.remove(SmallTumFolder::rgbName(i));
    for (const int i : {0, 1, 2}) folder.remove(SmallTumFolder::depthName(i));
    EXPECT_CONTAINS(errorOf([&] { openDataset(folder.path(), options); }), "6 listed image(s) missing");
}

TEST(Tum, AllScalesThatMakeSenseAreNamed) {
    SmallTumFolder folder(2, 20500);  // 4.1 m at TUM's 5000, which looks as likely as 2.05 m
    folder.writeCamera("1000");
    EXPECT_CONTAINS(openError(folder), "depth_scale 10000 would give 2.05 m, 5000 would give 4.1 m");
}

TEST(Tum, DepthImagesWithoutDepthAreSaid) {
    SmallTumFolder folder(3, 0);
    folder.writeCamera("5000");
    EXPECT_CONTAINS(openDataset(folder.path()).summary(), "the first 3 depth images hold no depth at all");
}

TEST(Tum, ADepthScaleThatMakesNoSenseIsNamedWithTheLikelyOne) {
    SmallTumFolder folder(2, 1500);  // 1.5 m in millimetres
    folder.writeCamera("50");
    const std::string too_far = openError(folder);
    EXPECT_CONTAINS(too_far, "median depth 30 m");
    EXPECT_CONTAINS(too_far, "depth_scale 1000 would give 1.5 m");
    folder.writeCamera("50000");
    EXPECT_CONTAINS(openError(folder), "median depth 0.03 m");
    folder.writeCamera("1000");
    EXPECT_EQ(openError(folder), "");
    const SmallTumFolder blind(2, 0);  // no depth at all says nothing about the scale
    EXPECT_EQ(openError(blind), "");
}

TEST(Tum, WrongFoldersAndLists) {
    const SmallTumFolder folder;
    EXPECT_CONTAINS(errorOf([&] { openDataset(folder / "none"); }), "not found");
    EXPECT_CONTAINS(errorOf([&] { openDataset(folder / "rgb.txt"); }), "not a folder");
    EXPECT_CONTAINS(errorOf([&] { openDataset(folder / "rgb"); }), "no dataset recognised");
    const fs::path parent = fs::path(folder.path()) / "parent";
    fs::create_directories(parent / "child");
    fs::copy(folder / "rgb.txt", parent / "child" / "rgb.txt");
    EXPECT_CONTAINS(errorOf([&] { openDataset(parent.string()); }),
                    "did you mean " + (parent / "child").string());
    EXPECT_CONTAINS(errorOf([&] { openDataset((parent / "child").string()); }), "has no depth.txt");
    EXPECT_CONTAINS(openError(folder, {"oni", 0.02}),
                    "unknown dataset format 'oni' (known: auto, 7scenes, eth3d, scannet, stray, record3d, "
                    "icl, tum, plain, bag)");
    EXPECT_CONTAINS(openError(folder, {"tum", 0.001}), "closest pair 0.004 s apart");
    folder.write("rgb.txt", "# nothing\n");
    EXPECT_CONTAINS(openError(folder), (folder / "rgb.txt") + " lists no images");
    const std::string depths = test::readFile(folder / "depth.txt");
    folder.write("rgb.txt", depths);
    folder.write("depth.txt", "");
    EXPECT_CONTAINS(openError(folder), (folder / "depth.txt") + " lists no images");
    folder.write("depth.txt", depths);
    folder.write("rgb.txt", "soon rgb/x.png\n");
    EXPECT_CONTAINS(openError(folder), "rgb.txt:1: 'soon' is not a number");
    folder.write("rgb.txt", "# c\n1.0\n");
    EXPECT_CONTAINS(openError(folder), "rgb.txt:2: expected 'timestamp filename'");
}

TEST(Tum, AMissingImageIsNamed) {
    const SmallTumFolder folder;
    folder.remove(SmallTumFolder::depthName(1));
    const std::string error = openError(folder);
    EXPECT_CONTAINS(error, "1 listed image(s) missing");
    EXPECT_CONTAINS(error, SmallTumFolder::depthName(1));
}

TEST(Tum, EightBitDepthIsRefusedAtOnce) {
    const SmallTumFolder folder;
    for (int i = 0; i < 3; i++)
        cv::imwrite(folder / SmallTumFolder::depthName(i), cv::Mat(48, 64, CV_8UC1, cv::Scalar(9)));
    EXPECT_CONTAINS(openError(folder), "must be 16-bit");
}

TEST(Tum, OneUnusableImageSpoilsOneFrameOnly) {
    for (const int bad : {0, 1}) {
        const SmallTumFolder folder;
        fs::resize_file(folder / SmallTumFolder::rgbName(bad), 60);
        const DatasetReader dataset = openDataset(folder.path());
        for (std::size_t i = 0; i < 3; i++) {
            const std::string error = errorOf([&] { dataset.readFrame(i); });
            EXPECT_EQ(error.find(SmallTumFolder::rgbName(bad)) != std::string::npos,
                      static_cast<int>(i) == bad)
                << error;
        }
    }
    const SmallTumFolder folder;
    fs::resize_file(folder / SmallTumFolder::depthName(0), 60);
    cv::imwrite(folder / SmallTumFolder::rgbName(2), cv::Mat(24, 32, CV_8UC3, cv::Scalar(1)));
    const DatasetReader dataset = openDataset(folder.path());
    EXPECT_CONTAINS(errorOf([&] { dataset.readFrame(0); }), SmallTumFolder::depthName(0));
    EXPECT_EQ(errorOf([&] { dataset.readFrame(1); }), "");
    EXPECT_CONTAINS(errorOf([&] { dataset.readFrame(2); }), "32x24, but the camera is 64x48");
}

}  // namespace
}  // namespace roevo
