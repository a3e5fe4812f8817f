// bag2rawlog: what arrives in the rawlog.
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <limits>
#include <opencv2/imgproc.hpp>

#include "recordings/dataset_reader.h"
#include "roevo_mrpt/pose_conversions.h"
#include "support/data_folder.h"
#include "tools/bag_fixture.h"

namespace roevo {
namespace {

using namespace test;

TEST_F(Bag2Rawlog, KeepsMillimetresColourStampsIntrinsicsAndTheFramesName) {
    write([](BagWriter& bag) { bag.frames(3); });
    const auto all = scans();
    ASSERT_EQ(all.size(), 3u);
    for (int i = 0; i < 3; i++) {
        const auto& scan = *all[static_cast<std::size_t>(i)];
        EXPECT_EQ(scan.sensorLabel, "rgb_optical");
        EXPECT_TRUE(scan.range_is_depth);
        EXPECT_EQ(scan.rangeUnits, 1e-3f);
        EXPECT_TRUE(same(rangeImageOf(scan), depthImage(i)));
        const RgbdFrame frame = toRgbdFrame(scan);
        EXPECT_EQ(frame.timestamp, secondsOf(i));
        EXPECT_TRUE(same(frame.colour, colourImage(i)));
        PinholeCamera camera;
        camera.width = kBagWidth, camera.height = kBagHeight;
        camera.fx = 60, camera.fy = 61, camera.cx = 15.5, camera.cy = 11.5;
        camera.distortion = {0.1, -0.2, 0.001, 0.002, 0.3};
        EXPECT_EQ(colourCameraOf(scan), camera);
        EXPECT_TRUE(scan.doDepthAndIntensityCamerasCoincide());
    }
    EXPECT_TRUE(said("3 frames written")) << result_.all();
    EXPECT_TRUE(said("largest time difference 4.0 ms")) << result_.all();
}

TEST_F(Bag2Rawlog, MetresBecomeTheNearestFifthOfAMillimetre) {
    constexpr float kInf = std::numeric_limits<float>::infinity(),
                    kNan = std::numeric_limits<float>::quiet_NaN();
    cv::Mat metres;
    depthImage(0).convertTo(metres, CV_32FC1, 1e-3);
    const std::vector<std::pair<float, int>> special{
        {kNan, 0}, {kInf, 0},  {-kInf, 0},       {-1.f, 0},        {13.107f, 65535}, {13.1072f, 0},
        {20.f, 0}, {1e30f, 0}, {1.00009f, 5000}, {1.00011f, 5001}, {4e-5f, 0}};
    for (std::size_t i = 0; i < special.size(); i++)
        metres.at<float>(3, static_cast<int>(i)) = special[i].first;
    write([&](BagWriter& bag) {
        bag.info(kColourInfo);
        bag.colour(0);
        bag.add(kDepthTopic, imageMessage(metres, "32FC1", "rgb_optical", stampOf(0)));
    });
    const auto all = scans();
    ASSERT_EQ(all.size(), 1u);
    EXPECT_EQ(all[0]->rangeUnits, 1.f / 5000);
    cv::Mat expected = 5 * depthImage(0);
    for (std::size_t i = 0; i < special.size(); i++)
        expected.at<std::uint16_t>(3, static_cast<int>(i)) = static_cast<std::uint16_t>(special[i].second);
    EXPECT_TRUE(same(rangeImageOf(*all[0]), expected));
    EXPECT_TRUE(said("3 depth values beyond 13.107 m")) << result_.all();
}

TEST_F(Bag2Rawlog, ReadsEveryColourOrderGreyAndPaddedRows) {
    struct Case {
        const char* encoding;
        int code, channels;
    };
    for (const auto& [encoding, code, channels] :
         {Case{"rgb8", cv::COLOR_RGB2BGR, 3}, Case{"bgr8", -1, 3}, Case{"mono8", -1, 1},
          Case{"rgba8", cv::COLOR_RGBA2BGR, 4}, Case{"bgra8", cv::COLOR_BGRA2BGR, 4}}) {
        const cv::Mat sent = colourImage(5, channels);
        write([&, name = encoding](BagWriter& bag) {
            bag.info(kColourInfo);
            bag.add(kColourTopic, imageMessage(sent, name, "rgb_optical", stampOf(0), 5));
            bag.add(kDepthTopic, imageMessage(depthImage(0), "16UC1", "rgb_optical", stampOf(0), 6));
        });
        cv::Mat expected = sent;
        if (code >= 0) cv::cvtColor(sent, expected, code);
        const auto all = scans();
        ASSERT_EQ(all.size(), 1u) << encoding;
        const RgbdFrame frame = toRgbdFrame(*all[0]);
        EXPECT_TRUE(same(channels == 1 ? frame.grey : frame.colour, expected)) << encoding;
        EXPECT_TRUE(same(rangeImageOf(*all[0]), depthImage(0))) << encoding;
    }
}

// Header stamps count, not those of the recorder; the order of the messages does not.
TEST_F(Bag2Rawlog, PairsOneToOneByTheStampsOfTheHeaders) {
    write([](BagWriter& bag) {
        bag.info(kColourInfo);
        const auto received = [](int second) {
            return ros::Time(1400000000 + static_cast<std::uint32_t>(second));
        };
        for (const int i : {3, 0, 2, 1}) {
            bag.add(kColourTopic, imageMessage(colourImage(i), "bgr8", "rgb_optical", stampOf(i)),
                    received(i));
            if (i != 2)  // frame 2 has no depth
                bag.add(kDepthTopic, imageMessage(depthImage(i), "16UC1", "rgb_optical", stampOf(i, 4)),
                        received(100 - i));
        }
        // Closer to colour 1 than the one above, and a colour image whose stamp was there already
        bag.add(kDepthTopic, imageMessage(depthImage(7), "16UC1", "rgb_optical", stampOf(1, 1)),
                received(200));
        bag.add(kColourTopic, imageMessage(colourImage(9), "bgr8", "rgb_optical", stampOf(0)), received(201));
    });
    const auto all = scans();
    ASSERT_EQ(all.size(), 3u);
    const int colour[] = {0, 1, 3}, depth[] = {0, 7, 3};
    for (std::size_t k = 0; k < 3; k++) {
        const RgbdFrame frame = toRgbdFrame(*all[k]);
        EXPECT_EQ(frame.timestamp, secondsOf(colour[k]));
        EXPECT_TRUE(same(frame.colour, colourImage(colour[k]))) << k;
        EXPECT_TRUE(same(rangeImageOf(*all[k]), depthImage(depth[k]))) << k;
    }
    EXPECT_TRUE(said("3 frames matched, 1 colour and 1 depth images dropped, 1 repeated")) << result_.all();
    EXPECT_TRUE(said("largest gap 2.000 s")) << result_.all();
}

// A RealSense: infrared beside colour, raw depth beside aligned depth.
TEST_F(Bag2Rawlog, TakesColourBeforeGreyAndAlignedBeforeRawDepth) {
    write([](BagWriter& bag) {
        for (const char* camera : {"infra1", "infra2"})
            bag.add(std::string("/camera/") + camera + "/image_rect_raw",
                    imageMessage(colourImage(8, 1), "mono8", camera, stampOf(0)));
        bag.info("/camera/depth/camera_info", "depth_optical", 33);
        bag.depth(4, "depth_optical", "/camera/depth/image_rect_raw");
        bag.info("/camera/color/camera_info", "/color_optical");
        bag.colour(0, "/color_optical", "/camera/color/image_raw");
        bag.info("/camera/aligned_depth_to_color/camera_info", "color_optical");
        bag.depth(0, "color_optical", "/camera/aligned_depth_to_color/image_raw");
    });
    const auto all = scans();
    ASSERT_EQ(all.size(), 1u);
    EXPECT_EQ(all[0]->sensorLabel, "color_optical");
    EXPECT_EQ(colourCameraOf(*all[0]).fx, 60);
    EXPECT_TRUE(same(rangeImageOf(*all[0]), depthImage(0)));
    EXPECT_TRUE(said("depth is aligned to colour"));
}

Eigen::Isometry3d somePose(double a) {
    return Eigen::Translation3d(0.1 * a, 0.02, -0.3) *
           Eigen::AngleAxisd(a, Eigen::Vector3d(1, 2, 3).normalized());
}

TEST_F(Bag2Rawlog, WritesBothCamerasWhereDepthIsNotAligned) {
    const Eigen::Isometry3d T_base_link = somePose(0.7), T_link_rgb = somePose(-0.4),
                            T_base_depth = somePose(1.1);
    write([&](BagWriter& bag) {
        bag.frames(0);
        bag.info(kDepthInfo, "depth_optical", 44);  // after the one in frames(), and so not used
        bag.colour(0);
        bag.depth(0, "depth_optical", "/camera/raw/image");
        bag.info("/camera/raw/camera_info", "depth_optical", 33);
        bag.staticTransform("base", "link", T_base_link);
        bag.staticTransform("/link", "/rgb_optical", T_link_rgb);
        bag.staticTransform("base", "depth_optical", T_base_depth);
    });
    const auto all = scans();
    ASSERT_EQ(all.size(), 1u);
    EXPECT_EQ(colourCameraOf(*all[0]).fx, 60);
    EXPECT_EQ(all[0]->cameraParams.fx(), 33);
    EXPECT_TRUE(same(rangeImageOf(*all[0]), depthImage(0))) << "depth as it was recorded";
    const Pose T_depth_colour = T_base_depth.inverse() * T_base_link * T_link_rgb;
    const Pose written = sensorFromOptical().inverse() * toEigen(all[0]->relativePoseIntensityWRTDepth);
    EXPECT_LT((written.matrix() - T_depth_colour.matrix()).cwiseAbs().maxCoeff(), 1e-6);
    EXPECT_TRUE(said("both cameras are written")) << result_.all();
}

TEST_F(Bag2Rawlog, DepthInTheSameFrameMayHaveIntrinsicsOfItsOwn) {
    write([](BagWriter& bag) {
        bag.info(kColourInfo);
        bag.info(kDepthInfo, "rgb_optical", 33);
        bag.colour(0);
        bag.depth(0);
    });
    const auto all = scans();
    ASSERT_EQ(all.size(), 1u);
    EXPECT_EQ(all[0]->cameraParams.fx(), 33);
    EXPECT_EQ(colourCameraOf(*all[0]).fx, 60);
    const Pose written = sensorFromOptical().inverse() * toEigen(all[0]->relativePoseIntensityWRTDepth);
    EXPECT_TRUE(written.isApprox(Pose::Identity(), 1e-9));
    EXPECT_TRUE(said("--depth-info-topic " + kColourInfo)) << result_.all();
    const auto aligned = scans({"--depth-info-topic", kColourInfo});
    ASSERT_EQ(aligned.size(), 1u);
    EXPECT_EQ(aligned[0]->cameraParams.fx(), 60);
    EXPECT_TRUE(said("depth is aligned"));
}

TEST_F(Bag2Rawlog, RectifiedImagesHaveTheCameraOfP) {
    write([](BagWriter& bag) {
        bag.info(kColourInfo);
        bag.colour(0, "rgb_optical", "/camera/rgb/image_rect_color");
        bag.depth(0, "rgb_optical", "/camera/rgb/depth_rect");
    });
    const auto all = scans();
    ASSERT_EQ(all.size(), 1u);
    const PinholeCamera camera = colourCameraOf(*all[0]);
    EXPECT_EQ(camera.fx, 50);
    EXPECT_EQ(camera.cy, 11);
    EXPECT_FALSE(camera.isDistorted());
}

TEST_F(Bag2Rawlog, ARationalLensWithoutItsLastTermsIsAPlumbBob) {
    write([](BagWriter& bag) {
        auto info = infoMessage("rgb_optical", stampOf(0));
        info.distortion_model = "rational_polynomial";
        info.D.resize(8, 0);
        bag.add(kColourInfo, info);
        bag.colour(0);
        bag.depth(0);
    });
    const auto all = scans();
    ASSERT_EQ(all.size(), 1u);
    EXPECT_EQ(colourCameraOf(*all[0]).distortion[4], 0.3);
}

TEST_F(Bag2Rawlog, OtherLensesAreKept) {
    const auto cameraWith = [&](const std::string& model, const std::vector<double>& terms) {
        write([&](BagWriter& bag) {
            auto info = infoMessage("rgb_optical", stampOf(0));
            info.distortion_model = model;
            info.D = terms;
            bag.add(kColourInfo, info);
            bag.colour(0);
            bag.depth(0);
        });
        const auto all = scans();
        return all.size() == 1 ? colourCameraOf(*all[0]) : PinholeCamera();
    };
    const PinholeCamera rational =
        cameraWith("rational_polynomial", {0.1, -0.2, 0.001, 0.002, 0.3, 0.01, 0.02, 0.03});
    EXPECT_EQ(rational.distortion, (std::array<double, 5>{0.1, -0.2, 0.001, 0.002, 0.3}));
    EXPECT_EQ(rational.denominator, (std::array<double, 3>{0.01, 0.02, 0.03}));
    const PinholeCamera fisheye = cameraWith("equidistant", {0.01, 0.02, 0.03, 0.04});
    EXPECT_EQ(fisheye.lens, LensModel::kKannalaBrandt);
    EXPECT_EQ(fisheye.distortion, (std::array<double, 5>{0.01, 0.02, 0.03, 0.04, 0}));
}

TEST_F(Bag2Rawlog, ReadsCompressedBags) {
    for (const auto compression : {rosbag::compression::BZ2, rosbag::compression::LZ4}) {
        write([&](BagWriter& bag) {
            bag.bag.setCompression(compression);
            bag.frames(2);
        });
        const auto all = scans();
        ASSERT_EQ(all.size(), 2u);
        EXPECT_TRUE(same(rangeImageOf(*all[1]), depthImage(1)));
    }
}

TEST_F(Bag2Rawlog, PathsMayHaveSpacesAndOtherLetters) {
    const std::string path = folder_ / "Büro außen 2.bag", rawlog = folder_ / "Büro außen 2.rawlog";
    { BagWriter(path).frames(2); }
    const auto result = runProgram(kName, {"--input", path, "--output", rawlog});
    EXPECT_EQ(result.exit_code, 0) << result.all();
    RawlogReader reader(rawlog);
    const auto scan = reader.next();
    ASSERT_TRUE(scan);
    EXPECT_TRUE(same(toRgbdFrame(*scan).colour, colourImage(0)));
}

// The odometry sees the same bytes, whether it reads a folder or a bag made of the same images.
TEST_F(Bag2Rawlog, GivesTheFramesOfTheFolderThatTheBagWasMadeOf) {
    const std::filesystem::path clip = std::filesystem::path(test::dataFolder()) / "tum_fr1_desk_9";
    if (!std::filesystem::is_directory(clip)) GTEST_SKIP() << "no clip " << clip;
    const DatasetReader dataset = openDataset(clip.string());
    const auto stamp = [](double seconds) {
        const auto micro = static_cast<std::uint64_t>(std::llround(seconds * 1e6));
        return ros::Time(static_cast<std::uint32_t>(micro / 1000000),
                         static_cast<std::uint32_t>(micro % 1000000 * 1000));
    };
    write([&](BagWriter& bag) {
        const PinholeCamera& camera = dataset.camera();
        auto info = infoMessage("openni_rgb_optical_frame", stampOf(0));
        info.width = static_cast<std::uint32_t>(camera.width),
        info.height = static_cast<std::uint32_t>(camera.height);
        info.K = {camera.fx, 0, camera.cx, 0, camera.fy, camera.cy, 0, 0, 1};
        info.D.assign(camera.distortion.begin(), camera.distortion.end());
        bag.add(kColourInfo, info);
        for (std::size_t i = 0; i < dataset.size(); i++) {
            cv::Mat metres;
            dataset.readDepth(i).convertTo(metres, CV_32FC1, 1 / dataset.depthScale());
            bag.add(kColourTopic, imageMessage(dataset.readImage(i), "bgr8", info.header.frame_id,
                                               stamp(dataset.entry(i).timestamp)));
            bag.add(kDepthTopic, imageMessage(metres, "32FC1", info.header.frame_id,
                                              stamp(dataset.entry(i).depth_timestamp)));
        }
    });
    const auto all = scans();
    ASSERT_EQ(all.size(), dataset.size());
    for (std::size_t i = 0; i < all.size(); i++) {
        const RgbdFrame original = dataset.readFrame(i), converted = toRgbdFrame(*all[i]);
        EXPECT_EQ(converted.timestamp, original.timestamp);
        EXPECT_TRUE(same(converted.grey, original.grey)) << i;
        EXPECT_TRUE(same(converted.depth, original.depth)) << i;
        EXPECT_EQ(colourCameraOf(*all[i]), dataset.camera());
    }
}

}  // namespace
}  // namespace roevo
