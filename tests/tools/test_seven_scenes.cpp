#include <gtest/gtest.h>
#include <mrpt/obs/CObservation3DRangeScan.h>
#include <sys/stat.h>

#include <cmath>
#include <opencv2/core.hpp>

#include "recordings/dataset_reader.h"
#include "recordings/seven_scenes.h"
#include "roevo_mrpt/image_conversions.h"
#include "roevo_mrpt/observation_converter.h"
#include "roevo_mrpt/rawlog_reader.h"
#include "roevo_simulator/simulator.h"
#include "tools/small_dataset.h"

namespace roevo {
namespace {

namespace fs = std::filesystem;
using test::errorOf;
using test::SmallDataset;

TEST(SevenScenes, SimulatedSequenceIsRegisteredToColour) {
    const test::TemporaryFolder parent;
    const std::string folder = parent / "seq-01";
    const auto made = test::runProgram("rawlog-simulate", {"--scene", "livingroom", "--frames", "2",
                                                           "--layout", "7scenes", "--output", folder});
    ASSERT_EQ(made.exit_code, 0) << made.all();
    const DatasetReader dataset = openDataset(folder);
    ASSERT_EQ(dataset.size(), 2u);
    EXPECT_EQ(dataset.camera(), sevenScenesColourCamera());
    EXPECT_CONTAINS(dataset.summary(), "assumed: the dataset publishes none for colour");
    EXPECT_CONTAINS(dataset.summary(), "f 585 c (320, 240) and registered to colour when a frame is read");

    // What one camera for both would have seen
    simulator::SimulationOptions options;
    options.frames = 2;
    options.intrinsics = {525, 525, 320, 240};
    const simulator::Simulator truth(options);
    const cv::Mat registered = dataset.readFrame(1).depth, exact = truth.frame(1).depth;
    int near = 0, valid = 0;
    for (int v = 0; v < exact.rows; v++)
        for (int u = 0; u < exact.cols; u++) {
            const double got = static_cast<double>(registered.at<float>(v, u));
            if (got == 0) continue;
            valid++;
            if (std::abs(got - static_cast<double>(exact.at<float>(v, u))) < 0.02 * got) near++;
        }
    const double share_seen = (525. / 585) * (525. / 585);  // the depth camera sees less
    EXPECT_GT(valid, 0.98 * share_seen * 640 * 480);
    EXPECT_GT(near, 0.97 * valid) << "all but the borders of objects";

    ASSERT_EQ(dataset.groundTruth().poses.size(), 2u);
    for (int i = 0; i < 2; i++) {
        const StampedPose& pose = dataset.groundTruth().poses[static_cast<std::size_t>(i)];
        EXPECT_LT((pose.T_world_camera.matrix() - truth.poseAt(i / 30.).matrix()).cwiseAbs().maxCoeff(),
                  1e-9);
        EXPECT_EQ(pose.timestamp, dataset.entry(static_cast<std::size_t>(i)).timestamp);
    }
    EXPECT_EQ(dataset.entry(0).timestamp, 1.0);
}

TEST(SevenScenes, ARawlogHoldsTheDatasetsOwnDepth) {
    const test::TemporaryFolder parent;
    const std::string folder = parent / "seq-01", rawlog = parent / "o.rawlog";
    const auto made =
        test::runProgram("rawlog-simulate", {"--scene", "livingroom", "--frames", "2", "--noise", "kinect",
                                             "--layout", "7scenes", "--output", folder});
    ASSERT_EQ(made.exit_code, 0) << made.all();
    const auto there = test::runProgram("rgbd2rawlog", {"--input", folder, "--output", rawlog, "--verify"});
    ASSERT_EQ(there.exit_code, 0) << there.all();
    EXPECT_CONTAINS(there.out, "verified: 2 frames, 614400 depth values");

    const DatasetReader dataset = openDataset(folder);
    RawlogReader reader(rawlog);
    for (std::size_t i = 0; i < 2; i++) {
        const auto scan = reader.next();
        ASSERT_TRUE(scan);
        EXPECT_EQ(depthCameraOf(*scan), sevenScenesRegistration().depth_camera);
        EXPECT_EQ(colourCameraOf(*scan), sevenScenesColourCamera());
        cv::Mat file = cv::imread(dataset.entry(i).depth, cv::IMREAD_UNCHANGED);
        ASSERT_GT(cv::countNonZero(file == 65535), 0) << "or there is no unknown depth to be told";
        file.setTo(0, file == 65535);
        const cv::Mat held(480, 640, CV_16UC1, &scan->rangeImage(0, 0));
        EXPECT_EQ(cv::norm(held, file, cv::NORM_INF), 0);

        const cv::Mat a = toRgbdFrame(*scan).depth, b = dataset.readFrame(i).depth;
        EXPECT_EQ(cv::norm(a, b, cv::NORM_INF), 0) << "registered alike, to the last bit";
        cv::Mat moved = depthToMetres(held, dataset.depthUnit());
        EXPECT_GT(cv::norm(a, moved, cv::NORM_INF), 0.1) << "and registered at all";
    }
    const auto back = test::runProgram("rawlog2rgbd", {"--input", rawlog, "--output", parent / "back"});
    ASSERT_EQ(back.exit_code, 0) << back.all();
    EXPECT_CONTAINS(back.out, "2 frames not as in the rawlog: depth registered to the colour camera");
}

TEST(SevenScenes, TheInvalidValueIsUnknownDepth) {
    const SmallDataset folder("7scenes");
    cv::Mat depth(48, 64, CV_16UC1, cv::Scalar(2000));
    depth.at<std::uint16_t>(5, 6) = 65535;
    depth.rowRange(24, 48).setTo(65535);
    folder.writeDepth(0, depth);
    const DatasetReader dataset = openDataset(folder.path());
    EXPECT_EQ(dataset.readDepth(0).at<std::uint16_t>(5, 6), 0);
    EXPECT_EQ(dataset.readDepth(0).at<std::uint16_t>(5, 7), 2000);
    EXPECT_EQ(dataset.readFrame(0).depth.at<float>(40, 40), 0.f);
}

TEST(SevenScenes, WithACameraFileDepthIsTakenAsRegistered) {
    const SmallDataset folder("7scenes");
    const DatasetReader dataset = openDataset(folder.path());
    EXPECT_FALSE(dataset.description().registration);
    EXPECT_CONTAINS(dataset.summary(), "taken as registered to colour, because there is a camera.txt");
    EXPECT_CONTAINS(dataset.summary(), "poses of the colour camera");
    EXPECT_EQ(dataset.readDepth(1).at<std::uint16_t>(5, 6), 2000);
    folder.remove("camera.txt");
    EXPECT_CONTAINS(errorOf([&] { openDataset(folder.path()); }), "64x48, but the camera is 640x480");
}

TEST(SevenScenes, PosesThatAreNoneAreLeftOut) {
    const SmallDataset folder("7scenes", 4);
    folder.remove(SmallDataset::pose(0));
    folder.write(SmallDataset::pose(1), "1 0 0 0\n0 1 0 0\n0 0 1 0\n");
    folder.write(SmallDataset::pose(2), "2 0 0 0\n0 1 0 0\n0 0 1 0\n0 0 0 1\n");
    const DatasetReader dataset = openDataset(folder.path());
    EXPECT_EQ(dataset.size(), 4u);
    ASSERT_EQ(dataset.groundTruth().poses.size(), 1u);
    EXPECT_EQ(dataset.groundTruth().poses[0].timestamp, SmallDataset::time(3));
    EXPECT_CONTAINS(dataset.summary(), "1 of 4 frames have no frame-N.pose.txt");
    EXPECT_CONTAINS(dataset.groundTruth().note, "2 left out, first: ");
    EXPECT_CONTAINS(dataset.groundTruth().note, "expected a 4x4 matrix, found 12 numbers");
    folder.write(SmallDataset::pose(1), "-1 0 0 0\n0 1 0 0\n0 0 1 0\n0 0 0 1\n");
    EXPECT_CONTAINS(openDataset(folder.path()).groundTruth().note, "is not a rotation and a translation");
}

TEST(SevenScenes, APoseThatIsAPipeIsNotWaitedFor) {
    const SmallDataset folder("7scenes", 3);
    folder.remove(SmallDataset::pose(1));
    ASSERT_EQ(mkfifo((folder / SmallDataset::pose(1)).c_str(), 0600), 0);
    const auto result =
        test::runForSeconds(10, "rgbd2rawlog", {"--input", folder.path(), "--output", folder / "o.rawlog"});
    EXPECT_EQ(result.exit_code, 0) << result.all();
    EXPECT_CONTAINS(result.out, "1 left out, first: cannot read " + (folder / SmallDataset::pose(1)));
    EXPECT_CONTAINS(result.out, "it is a pipe");
}

TEST(SevenScenes, NoPosesAtAll) {
    const SmallDataset folder("7scenes", 3);
    for (int i = 0; i < 3; i++) folder.remove(SmallDataset::pose(i));
    const DatasetReader dataset = openDataset(folder.path());
    EXPECT_CONTAINS(dataset.summary(), "3 of 3 frames have no frame-N.pose.txt: no ground truth for them");
    EXPECT_TRUE(dataset.groundTruth().poses.empty());
}

TEST(SevenScenes, TheSceneFolderPointsToItsSequences) {
    const SmallDataset folder("7scenes", 2, "chess/seq-02");
    fs::copy(folder.path(), fs::path(folder.path()).parent_path() / "seq-01");
    const std::string scene = folder.parent() / "chess";
    EXPECT_CONTAINS(errorOf([&] { openDataset(scene); }), "did you mean " + scene + "/seq-01?");
}

}  // namespace
}  // namespace roevo
