#include <gtest/gtest.h>

#include <cmath>
#include <opencv2/core.hpp>

#include "evaluation/trajectory_io.h"
#include "recordings/dataset_reader.h"
#include "recordings/handedness.h"
#include "roevo_simulator/simulator.h"
#include "support/data_folder.h"
#include "tools/small_dataset.h"

namespace roevo {
namespace {

namespace fs = std::filesystem;
using test::errorOf;
using test::SmallDataset;

simulator::SimulationOptions smallRoom() {
    simulator::SimulationOptions options;
    options.width = 128, options.height = 96;
    options.frames = 20;
    options.speed = 2;
    return options;
}

/// The simulated frames in the dataset's form, with the ground truth mirrored or not.
class IclFolder {
  public:
    explicit IclFolder(bool left_handed, double depth_noise = 0) {
        simulator::SimulationOptions options = smallRoom();
        options.depth_noise = depth_noise;
        const simulator::Simulator simulator(options);
        fs::create_directories(folder_.path() / "rgb");
        fs::create_directories(folder_.path() / "depth");
        std::string pairs, truth;
        for (int i = 0; i < options.frames; i += 2) {
            const simulator::SimulatedFrame frame = simulator.frame(i);
            const std::string number = std::to_string(i), rgb = "rgb/" + number + ".png",
                              depth = "depth/" + number + ".png";
            cv::imwrite(folder_ / rgb, frame.colour);
            cv::imwrite(folder_ / depth, simulator::quantiseDepth(frame.depth_noisy));
            pairs += number + " " + depth + " " + number + " " + rgb + "\n";
            poses_.push_back(frame.T_world_camera);
            StampedPose line{static_cast<double>(i), frame.T_world_camera};
            const Eigen::Vector3d mirror(1, left_handed ? -1 : 1, 1);
            line.T_world_camera.translation() = mirror.asDiagonal() * line.T_world_camera.translation();
            line.T_world_camera.setRotation(mirror.asDiagonal() * line.T_world_camera.linear() *
                                            mirror.asDiagonal());
            truth += toTumLine(line) + "\n";
        }
        const PinholeCamera& c = simulator.camera();
        write("associations.txt", pairs);
        write("livingRoom2.gt.freiburg", truth);
        char camera[256];
        std::snprintf(
            camera, sizeof camera,
            "width: %d\nheight: %d\nfx: %.17g\nfy: %.17g\ncx: %.17g\ncy: %.17g\ndepth_scale: 5000\n", c.width,
            c.height, c.fx, c.fy, c.cx, c.cy);
        write("camera.txt", camera);
    }
    void write(const std::string& name, const std::string& text) const {
        test::writeFile(folder_ / name, text);
    }

    test::TemporaryFolder folder_;
    std::vector<Pose> poses_;
};

TEST(Icl, HandednessIsToldByTheDepthImages) {
    for (const bool left_handed : {true, false}) {
        const IclFolder folder(left_handed, 1);
        const DatasetReader dataset = openDataset(folder.folder_.path().string());
        EXPECT_EQ(dataset.description().format, "icl");
        const GroundTruth& truth = dataset.groundTruth();
        EXPECT_CONTAINS(truth.note, "told by the depth images");
        EXPECT_CONTAINS(truth.note,
                        left_handed ? "left-handed, mirrored in y" : "right-handed, taken as it is");
        EXPECT_FALSE(truth.copyable) << "its stamps are numbers";
        ASSERT_EQ(truth.poses.size(), folder.poses_.size());
        for (std::size_t i = 0; i < truth.poses.size(); i++) {
            EXPECT_LT(
                (truth.poses[i].T_world_camera.matrix() - folder.poses_[i].matrix()).cwiseAbs().maxCoeff(),
                3e-9);
            EXPECT_EQ(truth.poses[i].timestamp, dataset.entry(i).timestamp);
        }
    }
}

TEST(Icl, AGroundTruthThatIsNamedIsConvertedAsOneThatIsFound) {
    const IclFolder folder(true, 1);
    const test::TemporaryFolder elsewhere;
    fs::rename(folder.folder_ / "livingRoom2.gt.freiburg", elsewhere / "truth.txt");
    DatasetOptions options;
    options.ground_truth = elsewhere / "truth.txt";
    const GroundTruth truth = openDataset(folder.folder_.path().string(), options).groundTruth();
    EXPECT_EQ(truth.file, elsewhere / "truth.txt");
    ASSERT_EQ(truth.poses.size(), folder.poses_.size());
    for (std::size_t i = 0; i < truth.poses.size(); i++) {
        EXPECT_TRUE(truth.poses[i].T_world_camera.isApprox(folder.poses_[i], 1e-7));
        EXPECT_NEAR(truth.poses[i].timestamp, 2 * static_cast<double>(i) / 30, 1e-6);
    }
}

TEST(Icl, WithoutMotionThePublishedHandednessIsAssumedAndThatIsSaid) {
    const SmallDataset folder("icl");  // moves along x only: both versions agree
    const GroundTruth truth = openDataset(folder.path()).groundTruth();
    EXPECT_CONTAINS(truth.note, "left-handed, mirrored in y");
    EXPECT_CONTAINS(truth.note, "assumed as published");
}

TEST(Icl, WithoutMotionOnlyThePublishedNumbersAreTakenForLeftHanded) {
    const SmallDataset folder("icl");
    const test::TemporaryFolder elsewhere;
    const std::vector<StampedPose> found = openDataset(folder.path()).groundTruth().poses;
    std::vector<StampedPose> right = found;
    right[1].T_world_camera.translation().y() = 0.2;
    DatasetOptions options;
    options.ground_truth = elsewhere / "truth.txt";
    for (const double unit : {1.0, 1e3}) {
        auto written = right;
        for (StampedPose& pose : written) pose.timestamp *= unit;
        writeTumTrajectory(options.ground_truth, written);
        const GroundTruth truth = openDataset(folder.path(), options).groundTruth();
        EXPECT_CONTAINS(truth.note, "right-handed, taken as it is");
        EXPECT_CONTAINS(truth.note, "not the published numbers");
        ASSERT_EQ(truth.poses.size(), right.size());
        EXPECT_NEAR(truth.poses[1].T_world_camera.translation().y(), 0.2, 1e-9);
        EXPECT_NEAR(truth.poses[1].timestamp, right[1].timestamp, 1e-6);
    }
}

TEST(Icl, MirroringTwiceIsNothing) {
    StampedPose pose;
    pose.T_world_camera =
        Eigen::Translation3d(1, 2, 3) * Eigen::AngleAxisd(0.7, Eigen::Vector3d(1, 2, -1).normalized());
    std::vector<StampedPose> poses = {pose};
    mirrorY(poses);
    EXPECT_EQ(poses[0].T_world_camera.translation(), Eigen::Vector3d(1, -2, 3));
    EXPECT_NEAR(poses[0].T_world_camera.linear().determinant(), 1, 1e-12);
    const Eigen::Quaterniond q(pose.T_world_camera.linear()), m(poses[0].T_world_camera.linear());
    EXPECT_LT((m.coeffs() - Eigen::Vector4d(-q.x(), q.y(), -q.z(), q.w())).norm(), 1e-12);
    mirrorY(poses);
    EXPECT_EQ(poses[0].T_world_camera.matrix(), pose.T_world_camera.matrix());
}

TEST(Icl, ThePublishedCameraServesWithoutACameraFileAndItsSignIsSaid) {
    const SmallDataset folder("icl", 1);
    folder.remove("camera.txt");
    EXPECT_CONTAINS(errorOf([&] { openDataset(folder.path()); }), "64x48, but the camera is 640x480");
    folder.writeColour(0, cv::Mat(480, 640, CV_8UC3, cv::Scalar(1)));
    folder.writeDepth(0, cv::Mat(480, 640, CV_16UC1, cv::Scalar(9000)));
    const DatasetReader dataset = openDataset(folder.path());
    EXPECT_EQ(dataset.camera(), (PinholeCamera{640, 480, 481.2, 480, 319.5, 239.5, {}}));
    EXPECT_CONTAINS(dataset.summary(), "fy = -480");
    EXPECT_CONTAINS(dataset.summary(), "frame numbers at 30 Hz");
}

TEST(Icl, ItsCameraIsNotGivenToWhateverIsNumbered) {
    const SmallDataset folder("icl", 1, "mine");
    folder.remove("camera.txt");
    folder.remove("traj0.gt.freiburg");
    folder.write("associations.txt", "100 rgb/100.png 100 depth/100.png\n");
    EXPECT_CONTAINS(errorOf([&] { openDataset(folder.path()); }), "no intrinsics");
    EXPECT_CONTAINS(errorOf([&] { openDataset(folder.path()); }), "write camera.txt (or give --format icl");
    // What follows gets as far as the size of these images
    EXPECT_CONTAINS(errorOf([&] { openDataset(folder.path(), {"icl", 0.02}); }), "the camera is 640x480");
    folder.write("associations.txt", "100 depth/100.png 100 rgb/100.png\n");
    EXPECT_CONTAINS(errorOf([&] { openDataset(folder.path()); }), "the camera is 640x480");
    folder.writeCamera("5000");
    EXPECT_EQ(openDataset(folder.path()).camera().fx, 60);
}

TEST(Icl, NamesMayBePaddedAndAssociationsMissing) {
    const SmallDataset folder("icl");
    for (int i = 0; i < 3; i++) {
        const std::string padded = "0" + folder.stamp(i) + ".png";
        fs::rename(folder / folder.colour(i), folder / ("rgb/" + padded));
        fs::rename(folder / folder.depth(i), folder / ("depth/" + padded));
    }
    folder.remove("associations.txt");
    const DatasetReader dataset = openDataset(folder.path());
    EXPECT_EQ(dataset.description().format, "icl");
    ASSERT_EQ(dataset.size(), 3u);
    EXPECT_EQ(dataset.entry(2).timestamp, 3.4);
    EXPECT_CONTAINS(dataset.summary(), "paired by file name");
    folder.write("associations.txt", "100 depth/0100.png 100 rgb/0100.png\n");
    EXPECT_EQ(openDataset(folder.path()).description().format, "icl");
}

TEST(Icl, AFolderWithTimesIsTum) {
    const SmallDataset folder("icl", 1);
    folder.write("associations.txt", "3.5 depth/100.png 3.5 rgb/100.png\n");
    EXPECT_EQ(openDataset(folder.path()).description().format, "tum");
    EXPECT_CONTAINS(errorOf([&] {
                        openDataset(folder.path(), {"icl", 0.02});
                    }),
                    "counts frames in whole numbers");
}

TEST(Icl, NumbersCountAsTheyAreAndFramesWithoutAPoseAreSaid) {
    const SmallDataset folder("icl");
    folder.write("traj0.gt.freiburg", "101 5 0 0 0 0 0 1\n102 6 0 0 0 0 0 1\n103 7 0 0 0 0 0 1\n");
    const DatasetReader dataset = openDataset(folder.path());
    EXPECT_CONTAINS(dataset.summary(), "entries 101 to 103, for 2 of 3 frames");
    EXPECT_EQ(dataset.groundTruth().poses[0].timestamp, dataset.entry(1).timestamp);
    EXPECT_EQ(dataset.groundTruth().poses[0].T_world_camera.translation().x(), 5);
}

TEST(Icl, CountingFromZeroIsATimeLikeAnyOther) {
    const SmallDataset folder("icl", 2);
    folder.write("associations.txt", "0 depth/0.png 0 rgb/0.png\n1 depth/1.png 1 rgb/1.png\n");
    for (int i = 0; i < 2; i++) {
        fs::rename(folder / folder.colour(i), folder / ("rgb/" + std::to_string(i) + ".png"));
        fs::rename(folder / folder.depth(i), folder / ("depth/" + std::to_string(i) + ".png"));
    }
    const std::string rawlog = folder.parent() / "made.rawlog";
    const auto made =
        test::runProgram("rgbd2rawlog", {"--input", folder.path(), "--output", rawlog, "--verify"});
    EXPECT_EQ(made.exit_code, 0) << made.all();
    EXPECT_EQ(openDataset(folder.path()).entry(0).timestamp, 0.0);
}

TEST(Icl, OfSeveralTrajectoriesNoneIsTaken) {
    const SmallDataset folder("icl");
    folder.write("traj1.gt.freiburg", folder.read("traj0.gt.freiburg"));
    const DatasetReader dataset = openDataset(folder.path());
    EXPECT_TRUE(dataset.groundTruth().poses.empty());
    EXPECT_CONTAINS(dataset.summary(), "2 trajectories (traj0.gt.freiburg, traj1.gt.freiburg …), none taken");
}

/// The real clip, put back into the dataset's own form.
TEST(Icl, HandednessOfTheRealClip) {
    const fs::path clip = fs::path(test::dataFolder()) / "icl_office_kt0_50";
    if (!fs::exists(clip)) GTEST_SKIP() << clip << " is not there";
    const auto published = readTumTrajectory((clip / "groundtruth.txt").string());
    const auto number = [](double time) { return std::lround((time - 1000) * 30); };
    for (const bool left_handed : {true, false}) {
        const test::TemporaryFolder folder;
        fs::create_directories(folder.path() / "rgb");
        fs::create_directories(folder.path() / "depth");
        std::string pairs, truth;
        for (const auto& entry : fs::directory_iterator(clip / "rgb")) {
            const std::string n = std::to_string(number(std::stod(entry.path().stem().string())));
            for (const std::string kind : {"rgb", "depth"})
                fs::create_symlink(clip / kind / entry.path().filename(),
                                   folder.path() / kind / (n + ".png"));
            pairs += n + " depth/" + n + ".png " + n + " rgb/" + n + ".png\n";
        }
        auto poses = published;
        if (left_handed) mirrorY(poses);
        for (StampedPose& pose : poses) {
            pose.timestamp = static_cast<double>(number(pose.timestamp));
            truth += toTumLine(pose) + "\n";
        }
        test::writeFile(folder / "associations.txt", pairs);
        test::writeFile(folder / "office.gt.freiburg", truth);
        const DatasetReader dataset = openDataset(folder.path().string());
        EXPECT_EQ(dataset.size(), 50u);
        EXPECT_CONTAINS(dataset.groundTruth().note, "told by the depth images");
        EXPECT_CONTAINS(dataset.groundTruth().note,
                        left_handed ? "left-handed, mirrored" : "right-handed, taken");
        for (std::size_t i = 0; i < published.size(); i++)
            EXPECT_LT((dataset.groundTruth().poses[i].T_world_camera.matrix() -
                       published[i].T_world_camera.matrix())
                          .cwiseAbs()
                          .maxCoeff(),
                      3e-9);
    }
}

}  // namespace
}  // namespace roevo
