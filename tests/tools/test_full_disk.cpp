// A disk that is full: one line that says so, and nothing left behind.
#include <gtest/gtest.h>
#include <sys/mount.h>

#include "tools/rawlog_tools_check.h"
#include "tools/small_tum_folder.h"

namespace roevo {
namespace {

namespace fs = std::filesystem;

/// A disk of 64 kB, where the system lets us have one.
class FullDisk : public ::testing::Test {
  protected:
    void SetUp() override {
        fs::create_directory(folder_ / "disk");
        mounted_ = mount("tmpfs", (folder_ / "disk").c_str(), "tmpfs", 0, "size=64k") == 0;
        if (!mounted_) GTEST_SKIP() << "only root may mount a disk, and not everywhere";
        cv::Mat noise(480, 640, CV_8UC3);  // does not fit
        cv::RNG(7).fill(noise, cv::RNG::UNIFORM, 0, 256);
        input_.write("camera.txt",
                     "width: 640\nheight: 480\nfx: 500\nfy: 500\ncx: 320\ncy: 240\n"
                     "depth_scale: 5000\n");
        for (int i = 0; i < 3; i++) {
            cv::imwrite(input_ / SmallTumFolder::rgbName(i), noise);
            cv::imwrite(input_ / SmallTumFolder::depthName(i), cv::Mat(480, 640, CV_16UC1, cv::Scalar(9000)));
        }
    }
    void TearDown() override {
        if (mounted_) umount((folder_ / "disk").c_str());
    }

    using SmallTumFolder = test::SmallTumFolder;
    SmallTumFolder input_;
    test::TemporaryFolder folder_;
    bool mounted_ = false;
};

TEST_F(FullDisk, BothDirections) {
    test::expectError(test::convert(input_.path(), folder_ / "disk/o.rawlog"), 1, "rgbd2rawlog",
                      {"cannot copy", SmallTumFolder::rgbName(0), "No space left on device"});
    EXPECT_EQ(test::countEntries(folder_ / "disk"), 0);
    ASSERT_EQ(test::convert(input_.path(), folder_ / "o.rawlog").exit_code, 0);
    test::expectError(test::convertBack(folder_ / "o.rawlog", folder_ / "disk/back"), 1, "rawlog2rgbd",
                      {"cannot copy", "No space left on device"});
    EXPECT_EQ(test::countEntries(folder_ / "disk"), 0);
}

TEST_F(FullDisk, TheGroundTruthIsWhatDoesNotFit) {
    std::string truth;
    for (int i = 0; i < 3000; i++) truth += std::to_string(i) + " 0 0 0 0 0 0 1\n";
    input_.write("groundtruth.txt", truth + std::string(70000, '#') + "\n");
    test::expectError(test::convert(input_.path(), folder_ / "disk/o.rawlog"), 1, "rgbd2rawlog",
                      {"cannot copy", "groundtruth.txt", "No space left on device"});
    EXPECT_EQ(test::countEntries(folder_ / "disk"), 0);
}

TEST_F(FullDisk, TheRawlogItself) {
    cv::Mat noise(480, 640, CV_16UC1);
    cv::RNG(7).fill(noise, cv::RNG::UNIFORM, 5000, 15000);
    for (int i = 0; i < 3; i++) {
        cv::imwrite(input_ / SmallTumFolder::rgbName(i), cv::Mat(480, 640, CV_8UC3, cv::Scalar(9, 9, 9)));
        cv::imwrite(input_ / SmallTumFolder::depthName(i), noise);
    }
    for (const auto& options : {std::vector<std::string>{}, {"--externalize-depth"}}) {
        test::expectError(test::convert(input_.path(), folder_ / "disk/o.rawlog", options), 1, "rgbd2rawlog",
                          {"cannot write", "disk full?"});
        EXPECT_EQ(test::countEntries(folder_ / "disk"), 0);
    }
}

}  // namespace
}  // namespace roevo
