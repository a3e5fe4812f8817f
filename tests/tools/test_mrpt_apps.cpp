// MRPT's own programs and loaders take our rawlogs.
#include <gtest/gtest.h>
#include <mrpt/img/CImage.h>
#include <mrpt/obs/CObservationIMU.h>
#include <mrpt/obs/CRawlog.h>

#include "tools/rawlog_tools_check.h"
#include "tools/small_tum_folder.h"

namespace roevo {
namespace {

namespace fs = std::filesystem;
using test::convert;
using test::countEntries;
using test::expectFrames;
using test::SmallTumFolder;

class RawlogEdit : public ::testing::Test {
  protected:
    static bool rawlogEditIsMissing() { return std::system("command -v rawlog-edit >/dev/null 2>&1") != 0; }

    /// Runs rawlog-edit in the rawlog's own folder: MRPT 2.5 looks for the images in the wrong place when the
    /// path has a folder in it.
    std::string rawlogEdit(const std::string& arguments) const {
        const std::string command =
            "cd '" + output_.path().string() + "' && rawlog-edit " + arguments + " > said.txt 2>&1";
        const int code = std::system(command.c_str());
        const std::string said = test::readFile(output_ / "said.txt");
        EXPECT_EQ(code, 0) << said;
        return said;
    }

    /// What MRPT 2.14 says that it removes from a rawlog of observations it writes all the same, whoever made
    /// the rawlog: such a cut tells nothing about ours.
    bool rawlogEditLeavesOutWhatItCuts() const {
        rawlogEdit("--cut --from-index 1 --to-index 1 -i a.rawlog -o one.rawlog");
        const std::string info = rawlogEdit("--info -i one.rawlog");
        return info.find("Overall number of objects         : 1\n") != std::string::npos;
    }

    test::TemporaryFolder output_;
};

/// Rawlogs of five frames and two inertial samples, depth inside or in files.
class MrptApps : public RawlogEdit, public ::testing::WithParamInterface<bool> {
  protected:
    void SetUp() override {
        input_.write("accelerometer.txt", SmallTumFolder::stamp(0, 0.01) + " 0 0 9.8\n" +
                                              SmallTumFolder::stamp(2, 0.01) + " 0 0 9.8\n");
        const auto outcome = convert(
            input_.path(), output_ / "a.rawlog",
            GetParam() ? std::vector<std::string>{"--externalize-depth"} : std::vector<std::string>{});
        ASSERT_EQ(outcome.exit_code, 0) << outcome.all();
    }

    SmallTumFolder input_{5};
};

TEST_P(MrptApps, InfoCountsFramesAndSamples) {
    if (rawlogEditIsMissing()) GTEST_SKIP() << "rawlog-edit (package mrpt-apps) not installed";
    const std::string info = rawlogEdit("--info -i a.rawlog");
    EXPECT_CONTAINS(info, "a_Images");
    EXPECT_CONTAINS(info, "Overall number of objects         : 7");
    EXPECT_CONTAINS(info, "Observations format               : Yes");
    EXPECT_CONTAINS(info, "RGBD /      5");
    EXPECT_CONTAINS(info, "IMU /      2");
    EXPECT_CONTAINS(info, "Earliest timestamp                : " + SmallTumFolder::stamp(0));
}

TEST_P(MrptApps, ExternalizeKeepsEveryFrame) {
    if (rawlogEditIsMissing()) GTEST_SKIP() << "rawlog-edit (package mrpt-apps) not installed";
    const std::string said = rawlogEdit("--externalize -i a.rawlog -o b.rawlog --image-format png");
    EXPECT_CONTAINS(
        said, GetParam() ? "Entries converted                 : 0" : "Entries converted                 : 5");
    // rawlog-edit leaves alone what is external already, and so its files where they are
    for (const auto& file : fs::directory_iterator(output_ / "a_Images"))
        fs::copy(file.path(), output_ / ("b_Images/" + file.path().filename().string()));
    RawlogReader reader(output_ / "b.rawlog");
    EXPECT_TRUE(reader.next()->rangeImage_isExternallyStored());
    expectFrames(output_ / "b.rawlog", input_.path(), {0, 1, 2, 3, 4});
}

TEST_P(MrptApps, CutKeepsWhatItSays) {
    if (rawlogEditIsMissing()) GTEST_SKIP() << "rawlog-edit (package mrpt-apps) not installed";
    if (!rawlogEditLeavesOutWhatItCuts()) GTEST_SKIP() << "this rawlog-edit keeps what it says it cuts";
    // Entries: frame 0, sample, frame 1, frame 2, sample, frame 3, frame 4
    rawlogEdit("--cut --from-index 2 --to-index 5 -i a.rawlog -o b.rawlog");
    fs::create_directory_symlink("a_Images", output_ / "b_Images");
    expectFrames(output_ / "b.rawlog", input_.path(), {1, 2, 3});
}

TEST_P(MrptApps, TheLoaderOfRawLogViewerTakesThem) {
    mrpt::obs::CRawlog rawlog;
    ASSERT_TRUE(rawlog.loadFromRawLogFile(output_ / "a.rawlog"));
    ASSERT_EQ(rawlog.size(), 7u);
    mrpt::img::CImage::setImagesPathBase(output_ / "a_Images");
    const DatasetReader dataset = openDataset(input_.path());
    std::size_t frames = 0, samples = 0;
    for (std::size_t i = 0; i < rawlog.size(); i++) {
        const auto observation = rawlog.getAsObservation(i);
        samples += std::dynamic_pointer_cast<mrpt::obs::CObservationIMU>(observation) ? 1 : 0;
        const auto scan = std::dynamic_pointer_cast<mrpt::obs::CObservation3DRangeScan>(observation);
        if (!scan) continue;
        scan->load();
        const cv::Mat depth = dataset.readDepth(frames), image = dataset.readImage(frames);
        ASSERT_EQ(scan->rangeImage.rows(), depth.rows);
        for (int v = 0; v < depth.rows; v++)
            for (int u = 0; u < depth.cols; u++)
                ASSERT_EQ(scan->rangeImage(v, u), depth.at<std::uint16_t>(v, u));
        EXPECT_TRUE(test::sameImage(scan->intensityImage.asCvMat<cv::Mat>(mrpt::img::DEEP_COPY), image));
        frames++;
    }
    EXPECT_EQ(frames, 5u);
    EXPECT_EQ(samples, 2u);
}

/// 7-Scenes: depth and colour are of two cameras, in the rawlog as well.
class MrptAppsTwoCameras : public RawlogEdit {
  protected:
    void SetUp() override {
        if (rawlogEditIsMissing()) GTEST_SKIP() << "rawlog-edit (package mrpt-apps) not installed";
        const auto made =
            test::runProgram("rawlog-simulate", {"--scene", "livingroom", "--frames", "3", "--layout",
                                                 "7scenes", "--output", output_ / "seq-01"});
        ASSERT_EQ(made.exit_code, 0) << made.all();
        const auto outcome = convert(output_ / "seq-01", output_ / "a.rawlog");
        ASSERT_EQ(outcome.exit_code, 0) << outcome.all();
    }
};

TEST_F(MrptAppsTwoCameras, InfoAndExternalize) {
    const std::string info = rawlogEdit("--info -i a.rawlog");
    EXPECT_CONTAINS(info, "Overall number of objects         : 3");
    EXPECT_CONTAINS(info, "RGBD /      3");
    rawlogEdit("--externalize -i a.rawlog -o b.rawlog --image-format png");
    for (const auto& file : fs::directory_iterator(output_ / "a_Images"))
        fs::copy(file.path(), output_ / ("b_Images/" + file.path().filename().string()));
    expectFrames(output_ / "b.rawlog", output_ / "seq-01", {0, 1, 2});
}

TEST_F(MrptAppsTwoCameras, Cut) {
    if (!rawlogEditLeavesOutWhatItCuts()) GTEST_SKIP() << "this rawlog-edit keeps what it says it cuts";
    rawlogEdit("--cut --from-index 1 --to-index 2 -i a.rawlog -o c.rawlog");
    fs::create_directory_symlink("a_Images", output_ / "c_Images");
    expectFrames(output_ / "c.rawlog", output_ / "seq-01", {1, 2});
}

INSTANTIATE_TEST_SUITE_P(Depth, MrptApps, ::testing::Bool(),
                         [](const auto& info) { return info.param ? "InFiles" : "Inside"; });

}  // namespace
}  // namespace roevo
