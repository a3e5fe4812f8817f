// The verification of rgbd2rawlog must find what it is there to find.
#include <gtest/gtest.h>

#include "rgbd2rawlog/verify.h"
#include "roevo_mrpt/rawlog_writer.h"
#include "tools/rawlog_tools_check.h"
#include "tools/small_tum_folder.h"

namespace roevo {
namespace {

using test::errorOf;
using test::SmallTumFolder;

class Verify : public ::testing::Test {
  protected:
    Verify() { input_.write("accelerometer.txt", SmallTumFolder::stamp(1, 0.01) + " 0.5 -0.25 9.75\n"); }

    /// What is found when the dataset, or what is said of the rawlog, changes after the conversion.
    template <class Spoil>
    std::string fault(const Spoil& spoil, ConvertOptions options = {}) {
        ConvertResult converted = convertToRawlog(openDataset(input_.path()), input_ / "o.rawlog", options,
                                                  [](const auto&, const auto&) {});
        spoil(options, converted);
        return errorOf([&] {
            const VerifyResult result =
                verifyRawlog(openDataset(input_.path()), options, converted, input_ / "o.rawlog");
            EXPECT_EQ(result.frames, 3u);
            EXPECT_EQ(result.imu_samples, 1u);
        });
    }

    SmallTumFolder input_;
};

TEST_F(Verify, NothingToFind) {
    EXPECT_EQ(fault([](auto&, auto&) {}), "");
    ConvertOptions options;
    options.jpeg_quality = 70;
    options.externalize_depth = true;
    EXPECT_EQ(fault([](auto&, auto&) {}, options), "");
}

TEST_F(Verify, OneUnitOfDepth) {
    EXPECT_CONTAINS(fault([&](auto&, auto&) {
                        cv::Mat depth =
                            cv::imread(input_ / SmallTumFolder::depthName(1), cv::IMREAD_UNCHANGED);
                        depth.at<std::uint16_t>(47, 63)++;
                        cv::imwrite(input_ / SmallTumFolder::depthName(1), depth);
                    }),
                    "frame 1 differs in depth values");
}

TEST_F(Verify, OnePixelOfColour) {
    // The grey image does not show so small a change of blue
    const auto spoil = [&](auto&, auto&) {
        // Not in place: the rawlog's image may be a hard link to this file
        cv::Mat image = cv::imread(input_ / SmallTumFolder::rgbName(2), cv::IMREAD_UNCHANGED);
        image.at<cv::Vec3b>(10, 10)[0]++;
        input_.remove(SmallTumFolder::rgbName(2));
        cv::imwrite(input_ / SmallTumFolder::rgbName(2), image);
    };
    EXPECT_CONTAINS(fault(spoil), "frame 2 differs in colour image");
}

TEST_F(Verify, AnotherJpegQuality) {
    cv::Mat noise(48, 64, CV_8UC3);
    cv::RNG(7).fill(noise, cv::RNG::UNIFORM, 0, 256);
    cv::imwrite(input_ / SmallTumFolder::rgbName(1), noise);
    ConvertOptions options;
    options.jpeg_quality = 70;
    EXPECT_CONTAINS(fault([](ConvertOptions& o, auto&) { o.jpeg_quality = 80; }, options),
                    "frame 1 differs in");
}

TEST_F(Verify, WhereTheDepthIs) {
    EXPECT_CONTAINS(fault([](ConvertOptions& o, auto&) { o.externalize_depth = true; }),
                    "where its depth is");
}

TEST_F(Verify, Intrinsics) {
    EXPECT_CONTAINS(fault([&](auto&, auto&) {
                        input_.write(
                            "camera.txt",
                            "width: 64\nheight: 48\nfx: 60\nfy: 61\ncx: 31.5\ncy: 23.500001\n"
                            "distortion_k1_k2_p1_p2_k3: 0.1 -0.2 0.001 0.002 0.3\ndepth_scale: 5000\n");
                    }),
                    "intrinsics");
}

TEST_F(Verify, TheDepthCamera) {
    DatasetDescription description = openDataset(input_.path()).description();
    description.registration.emplace();
    description.registration->depth_camera = description.camera;
    description.registration->depth_camera.fx += 10;
    description.registration->T_colour_depth.translation().x() = 0.1;
    const DatasetReader dataset(description);
    const ConvertResult converted =
        convertToRawlog(dataset, input_ / "o.rawlog", {}, [](const auto&, const auto&) {});
    const auto faultAgainst = [&](const DatasetReader& other) {
        return errorOf([&] { verifyRawlog(other, {}, converted, input_ / "o.rawlog"); });
    };
    EXPECT_EQ(faultAgainst(dataset), "");
    description.registration->depth_camera.cy += 1e-6;
    EXPECT_CONTAINS(faultAgainst(DatasetReader(description)), "differs in intrinsics of the depth camera");
    description.registration->depth_camera.cy -= 1e-6;
    description.registration->T_colour_depth.translation().z() = 1e-3;
    EXPECT_CONTAINS(faultAgainst(DatasetReader(description)), "differs in depth in metres");
}

TEST_F(Verify, DepthScale) {
    EXPECT_CONTAINS(fault([&](auto&, auto&) { input_.writeCamera("5000.01"); }), "depth in metres");
}

TEST_F(Verify, FramesThatAreMissingOrTooMany) {
    EXPECT_CONTAINS(fault([](auto&, ConvertResult& c) { c.written.push_back(2); }), "3 of 4 frames");
    EXPECT_CONTAINS(fault([](auto&, ConvertResult& c) { c.written.pop_back(); }), "more frames than written");
    EXPECT_CONTAINS(fault([](auto&, ConvertResult& c) { std::swap(c.written[0], c.written[1]); }),
                    "time stamp");
}

TEST_F(Verify, InertialSamples) {
    EXPECT_CONTAINS(fault([](auto&, ConvertResult& c) { c.imu[0].acceleration.x() += 1e-12; }),
                    "acceleration");
    EXPECT_CONTAINS(fault([](auto&, ConvertResult& c) { c.imu[0].timestamp += 1e-6; }), "time stamp");
    EXPECT_CONTAINS(fault([](auto&, ConvertResult& c) { c.imu[0].angular_velocity.emplace(0, 0, 0); }),
                    "angular velocity");
    EXPECT_CONTAINS(fault([](auto&, ConvertResult& c) { c.imu.clear(); }), "more inertial samples");
    EXPECT_CONTAINS(fault([](auto&, ConvertResult& c) { c.imu.push_back(c.imu[0]); }),
                    "1 of 2 inertial samples");
}

TEST_F(Verify, TheOrderOfTime) {
    // Written by another hand: the sample comes after a frame that is later
    const DatasetReader dataset = openDataset(input_.path());
    ConvertResult converted;
    converted.written = {0, 1, 2};
    converted.imu = dataset.imu();
    RawlogWriterOptions options;
    options.range_units = dataset.depthUnit();
    RawlogWriter writer(input_ / "late.rawlog", dataset.camera(), options);
    for (std::size_t i = 0; i < 3; i++)
        writer.addFile(dataset.entry(i).timestamp, dataset.readDepth(i), dataset.entry(i).image);
    writer.addImu(converted.imu[0].timestamp, converted.imu[0].acceleration);
    writer.finish();
    EXPECT_CONTAINS(errorOf([&] { verifyRawlog(dataset, {}, converted, input_ / "late.rawlog"); }),
                    "order of time");
}

TEST_F(Verify, ATruncatedRawlog) {
    for (int i = 0; i < 3; i++)  // noise, or the file would be too small to be cut
        cv::imwrite(input_ / SmallTumFolder::depthName(i), test::patternDepth(test::smallCamera(), i));
    const auto cut = [&](auto&, auto&) {
        std::filesystem::resize_file(input_ / "o.rawlog",
                                     std::filesystem::file_size(input_ / "o.rawlog") / 2);
    };
    EXPECT_CONTAINS(fault(cut), "truncated");
}

}  // namespace
}  // namespace roevo
