#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>
#include <opencv2/imgcodecs.hpp>
#include <sstream>

#include "evaluation/evaluate.h"
#include "evaluation/trajectory_io.h"
#include "odometry_fixture.h"
#include "support/data_folder.h"
#include "support/trajectory_files.h"

namespace roevo {
namespace {

namespace fs = std::filesystem;
using test::expectError;
using test::OdometryProgram;
using test::readFile;
using test::slidingRecording;

TEST_F(OdometryProgram, WritesEverythingThatTheContractNames) {
    const auto result = runFrames(slidingRecording(40));
    ASSERT_EQ(result.exit_code, 0) << result.all();
    for (const char* name :
         {"trajectory.txt", "trajectory_live.txt", "keyframes.txt", "frames.csv", "map.3Dscene", "map.ply",
          "map_semi_dense.ply", "summary.json", "config_used.ini", "trajectory_truth.txt"})
        EXPECT_GT(fs::file_size(output() + "/" + name), 0u) << name;
    EXPECT_EQ(std::distance(fs::directory_iterator(output()), fs::directory_iterator()), 10)
        << "and nothing else";

    const std::string csv = readFile(output() + "/frames.csv");
    EXPECT_EQ(csv.substr(0, csv.find('\n') + 5),
              "timestamp,status,reason,keyframe,edges,points,matched_ratio,inliers,sigma_t_m,sigma_r_deg,"
              "ms_decode,ms_edges,ms_coarse,ms_fine,ms_total,ms_mapping,ms_waiting,"
              "map_correction_m,map_correction_deg,map_reason,segment\n100.");
    ASSERT_EQ(rows().size(), 40u);
    for (const auto& row : rows()) EXPECT_EQ(row.size(), 21u);
    EXPECT_EQ(status(0), "initialised");
    EXPECT_EQ(readTumTrajectory(output() + "/trajectory.txt").size(), 40u);
    EXPECT_EQ(readTumTrajectory(output() + "/trajectory_live.txt").size(), 40u);

    const auto json = summary();
    EXPECT_EQ(json["command"].at(1), "--input");
    EXPECT_EQ(json["mode"], "ba");
    EXPECT_EQ(json["frames"]["total"], 40);
    EXPECT_EQ(json["frames"]["ok"], 39);
    EXPECT_EQ(json["camera"]["width"], 320);
    EXPECT_GT(json["timings_ms"]["total"]["median"].get<double>(), 0);
    EXPECT_GT(json["memory_peak_mb"].get<double>(), 0);
    EXPECT_NEAR(json["path_length_m"].get<double>(), 0.39, 0.05);
    // groundtruth.txt in the folder is found without being named.
    EXPECT_LT(json["ground_truth"]["ate_m"]["rmse"].get<double>(), 0.005);
    EXPECT_LT(json["ground_truth"]["rpe_per_second"]["translation_m"]["rmse"].get<double>(), 0.01);
    // As it was used, for programs that do not know the recording
    const Evaluation again = evaluate(readTumTrajectory(output() + "/trajectory_truth.txt"),
                                      readTumTrajectory(output() + "/trajectory.txt"));
    EXPECT_NEAR(again.ate.translation.rmse, json["ground_truth"]["ate_m"]["rmse"], 1e-8);
    for (const char* words : {"39 ok", "1 initialised", "ATE", "RPE", "ms per frame"})
        EXPECT_NE(result.out.find(words), std::string::npos) << words << " in\n" << result.out;
}

TEST_F(OdometryProgram, GroundTruthMayBeOfEuroc) {
    ASSERT_EQ(runFrames(slidingRecording(10)).exit_code, 0);
    const auto expected = summary()["ground_truth"]["ate_m"];
    test::writeFile(folder_ / "truth.csv",
                    test::eurocText(readTumTrajectory(folder_ / "recording/groundtruth.txt")));
    const auto result = run(folder_ / "recording", {"--ground-truth", folder_ / "truth.csv"});
    ASSERT_EQ(result.exit_code, 0) << result.all();
    EXPECT_NEAR(summary()["ground_truth"]["ate_m"]["rmse"], expected["rmse"], 1e-7);
    EXPECT_EQ(summary()["ground_truth"]["pairs"], 10);
    EXPECT_NE(result.out.find("ground truth: 10 poses from " + (folder_ / "truth.csv") + "\n"),
              std::string::npos)
        << result.out;
    EXPECT_EQ(result.out.find("groundtruth.txt"), std::string::npos) << "it is not used:\n" << result.out;
}

TEST_F(OdometryProgram, GroundTruthMayHaveNanoseconds) {
    auto frames = slidingRecording(10);
    for (test::TumFrame& frame : frames) frame.timestamp += 1.7e9;  // of this century
    ASSERT_EQ(runFrames(frames).exit_code, 0);
    const auto expected = summary()["ground_truth"]["ate_m"];
    auto truth = readTumTrajectory(folder_ / "recording/groundtruth.txt");
    for (int i = 1; i < 60; ++i)  // it lasts much longer than the recording
        truth.push_back({truth.back().timestamp + 1, truth.back().T_world_camera});
    for (StampedPose& pose : truth) pose.timestamp *= 1e9;
    writeTumTrajectory(folder_ / "truth.txt", truth);
    ASSERT_EQ(run(folder_ / "recording", {"--ground-truth", folder_ / "truth.txt"}).exit_code, 0);
    EXPECT_NEAR(summary()["ground_truth"]["ate_m"]["rmse"], expected["rmse"], 1e-7);
    EXPECT_EQ(summary()["ground_truth"]["pairs"], 10);
}

TEST_F(OdometryProgram, ResultsDoNotTakeThePlaceOfTheGroundTruth) {
    ASSERT_EQ(runFrames(slidingRecording(5)).exit_code, 0);
    const std::string truth = output() + "/trajectory_truth.txt", before = readFile(truth);
    expectError(run(folder_ / "recording", {"--ground-truth", truth}), 2, kName, {truth, "--output"});
    EXPECT_EQ(readFile(truth), before);
}

TEST_F(OdometryProgram, ErrorsOfAFewPosesAreSaidToBeSuch) {
    test::writeTumFolder(folder_ / "recording", slidingRecording(10));
    auto truth = readTumTrajectory(folder_ / "recording/groundtruth.txt");
    const auto warnings = [&](std::size_t poses) {
        truth.resize(poses);
        writeTumTrajectory(folder_ / "truth.txt", truth);
        const auto result = run(folder_ / "recording", {"--ground-truth", folder_ / "truth.txt"});
        EXPECT_EQ(result.exit_code, 0) << result.all();
        return result.err;
    };
    EXPECT_EQ(warnings(5).find("only"), std::string::npos);
    EXPECT_NE(warnings(4).find("only 4 of the 10 poses"), std::string::npos);
}

TEST_F(OdometryProgram, TheSummaryNamesTheGroundTruthForReadersInAnyFolder) {
    test::writeTumFolder(folder_ / "recording", slidingRecording(5));
    const fs::path truth = folder_ / "recording/groundtruth.txt";
    const auto result = run(folder_ / "recording", {"--ground-truth", fs::relative(truth).string()});
    ASSERT_EQ(result.exit_code, 0) << result.all();
    const fs::path named = summary()["ground_truth"]["file"].get<std::string>();
    EXPECT_TRUE(named.is_absolute()) << named;
    EXPECT_TRUE(fs::equivalent(named, truth)) << named;
}

TEST_F(OdometryProgram, TheEndNamesEveryFileThatWasWritten) {
    const std::string covariances = folder_ / "covariances.txt";
    const auto result = runFrames(slidingRecording(5), {"--covariances", covariances});
    ASSERT_EQ(result.exit_code, 0) << result.all();
    std::string end = result.out.substr(result.out.find("\nfiles  "));
    std::replace(end.begin(), end.end(), '\n', ' ');
    EXPECT_NE(end.find(" " + covariances + " "), std::string::npos) << end;
    EXPECT_EQ(end.find("trajectory_robot.txt"), std::string::npos) << end;
    for (const auto& file : fs::directory_iterator(output()))
        EXPECT_NE(end.find(" " + file.path().filename().string() + " "), std::string::npos)
            << file.path() << end;
}

TEST_F(OdometryProgram, OneIsNotSaidAsSeveral) {
    const auto result = runFrames(slidingRecording(1));
    ASSERT_EQ(result.exit_code, 0) << result.all();
    for (const char* words : {"1 frame matched", "1 pair of 320x240", "; 1 keyframe\n", "1 pose from"})
        EXPECT_NE(result.out.find(words), std::string::npos) << words << " in\n" << result.out;
}

TEST_F(OdometryProgram, BothModesRunAndSayWhichTheyAre) {
    for (const std::string mode : {"ct", "tr", "ba"}) {
        ASSERT_EQ(runFrames(slidingRecording(5), {"--mode", mode}).exit_code, 0);
        EXPECT_EQ(summary()["mode"], mode);
        EXPECT_NE(readFile(output() + "/config_used.ini").find("mode = " + mode), std::string::npos);
    }
    expectError(run(folder_ / "recording", {"--mode", "dense"}), 2, kName, {"'dense'", "ct, tr, ba"});
}

TEST_F(OdometryProgram, TheSummaryTellsTheReadoutTime) {
    // An even motion shears all images alike and teaches nothing
    std::vector<test::TumFrame> uneven = slidingRecording(20);
    for (std::size_t i = 1; i < uneven.size(); ++i)
        uneven[i].timestamp = uneven[i - 1].timestamp + (i / 3 % 2 == 0 ? 0.015 : 0.06);
    ASSERT_EQ(runFrames(uneven, {}).exit_code, 0);
    EXPECT_EQ(summary()["camera"]["readout_learned"], true);
    EXPECT_EQ(summary()["losses"]["lost"], 0);
    EXPECT_EQ(summary()["losses"]["pieces"], 1);
    const double learned = summary()["camera"]["readout_time_s"];
    EXPECT_NE(learned, 0);
    EXPECT_LT(std::abs(learned), 0.01) << "all rows are drawn at one time";
    ASSERT_EQ(run(folder_ / "recording",
                  {"--set", "sensor.estimate_readout=false", "--set", "sensor.readout_time=0.002"})
                  .exit_code,
              0);
    EXPECT_EQ(summary()["camera"]["readout_learned"], false);
    EXPECT_NEAR(summary()["camera"]["readout_time_s"], 0.002, 1e-9);
}

TEST_F(OdometryProgram, TheSummaryCountsKindsOfReasonsOfMapping) {
    // No two observations agree so well: every edge is rejected, and keyframes stay as they were
    ASSERT_EQ(runFrames(slidingRecording(40),
                        {"--set", "mapping.max_spread=0.01", "--set", "keyframe.max_translation=0.02"})
                  .exit_code,
              0);
    int given = 0, of_one_frame = 0;
    for (const auto& row : rows()) {
        const std::string& reasons = row.at(19);
        int count = reasons.empty() ? 0 : 1;
        for (std::size_t at = reasons.find("; "); at != std::string::npos; at = reasons.find("; ", at + 1))
            ++count;
        given += count;
        of_one_frame = std::max(of_one_frame, count);
    }
    ASSERT_GE(of_one_frame, 2);
    int counted = 0;
    const nlohmann::json summarised = summary();
    for (const auto& [kind, count] : summarised["mapping"]["reasons"].items()) {
        EXPECT_EQ(kind.rfind("left as it was, ", 0), 0U) << kind;
        EXPECT_EQ(kind.find_first_of("0123456789:;"), std::string::npos) << kind;
        counted += count.get<int>();
    }
    EXPECT_EQ(counted, given);
    EXPECT_FALSE(summarised["mapping"]["final_reasons"].empty()) << "nor do they move when all are refined";
}

TEST_F(OdometryProgram, FirstAndSkipChooseFrames) {
    ASSERT_EQ(runFrames(slidingRecording(12), {"--skip", "3", "--first", "4", "--quiet"}).exit_code, 0);
    ASSERT_EQ(rows().size(), 4u);
    EXPECT_EQ(rows()[0][0], "100.100000");
    for (const char* all : {"12", "13"}) {
        const auto result = run(folder_ / "recording", {"--skip", all});
        expectError(result, 1, kName, {std::string("--skip ") + all, "only 12 frames", "no frame is left"});
        EXPECT_EQ(rows().size(), 4u) << "the earlier results stay";
    }
}

TEST_F(OdometryProgram, CovariancesAreOneRowPerPose) {
    std::vector<test::TumFrame> frames = slidingRecording(10);
    frames[4].depth = cv::Mat(7, 7, CV_16UC1, cv::Scalar(5000));  // rejected: no pose, no row
    const std::string file = folder_ / "covariances.txt";
    ASSERT_EQ(runFrames(frames, {"--covariances", file}).exit_code, 0);
    const auto poses = readTumTrajectory(output() + "/trajectory.txt");
    ASSERT_EQ(poses.size(), 9u);
    std::istringstream text(readFile(file));
    std::string line, head;
    std::size_t row = 0, in_csv = 0;
    while (std::getline(text, line)) {
        if (line[0] == '#') {
            EXPECT_EQ(row, 0u);
            head += line;
            continue;
        }
        std::istringstream numbers(line);
        std::vector<double> values;
        for (double value; numbers >> value;) values.push_back(value);
        ASSERT_TRUE(numbers.eof()) << line;
        ASSERT_EQ(values.size(), 37u);
        EXPECT_NEAR(values[0], poses.at(row++).timestamp, 1e-9);
        const Eigen::Map<const Eigen::Matrix<double, 6, 6, Eigen::RowMajor>> covariance(&values[1]);
        EXPECT_EQ(covariance, covariance.transpose());
        if (row > 1) {
            EXPECT_GT(covariance.diagonal().minCoeff(), 0);
        }
        // As frames.csv has it
        while (rows().at(in_csv)[1] == "rejected") ++in_csv;
        EXPECT_NEAR(std::sqrt(covariance.topLeftCorner<3, 3>().trace()), std::stod(rows()[in_csv][8]), 1e-6);
        EXPECT_NEAR(std::sqrt(covariance.bottomRightCorner<3, 3>().trace()) / kDegree,
                    std::stod(rows()[in_csv++][9]), 1e-5);
    }
    EXPECT_EQ(row, poses.size());
    for (const char* words : {"position", "orientation", "axes of the world", "m^2", "rad^2", "timestamp"})
        EXPECT_NE(head.find(words), std::string::npos) << words;
}

TEST_F(OdometryProgram, CovariancesThatCannotBeWrittenCostNoWork) {
    test::writeTumFolder(folder_ / "recording", slidingRecording(3));
    const auto refused = [&](const std::string& file, const std::vector<std::string>& words) {
        expectError(run(folder_ / "recording", {"--covariances", file}),
                    words.front() == "--covariances" ? 2 : 1, kName, words);
        EXPECT_FALSE(fs::exists(output() + "/trajectory.txt"));
    };
    refused(folder_ / "none/c.txt", {"cannot write", "none/c.txt", "No such file"});
    refused(folder_.path().string(), {"cannot write", "it is a folder"});
    refused(output() + "/../out/frames.csv", {"--covariances", "frames.csv", "the run writes itself"});
    refused(folder_ / "recording", {"--covariances", "an input"});
    const std::string list = readFile(folder_ / "recording/rgb.txt");
    EXPECT_FALSE(list.empty());
    refused(folder_ / "recording/rgb.txt", {"--covariances", "rgb.txt", "an input"});
    refused(folder_ / "recording/depth/0000.png", {"--covariances", "0000.png", "an input"});
    EXPECT_EQ(readFile(folder_ / "recording/rgb.txt"), list);
    // In the output folder is as good a place as any, also where that is inside of the recording
    const std::string inside = folder_ / "recording/out";
    for (int again = 0; again < 2; ++again)
        ASSERT_EQ(test::runProgram(kName, {"--input", folder_ / "recording", "--output", inside,
                                           "--covariances", inside + "/c.txt"})
                      .exit_code,
                  0);
    ASSERT_EQ(run(folder_ / "recording", {"--covariances", output() + "/c.txt"}).exit_code, 0);
    const std::string before = readFile(output() + "/c.txt");
    EXPECT_FALSE(before.empty());
    // A run that fails leaves what was there
    for (const char* name : {"0000.png", "0001.png", "0002.png"})
        cv::imwrite(folder_ / ("recording/depth/" + std::string(name)),
                    cv::Mat(7, 7, CV_16UC1, cv::Scalar(5000)));
    ASSERT_EQ(run(folder_ / "recording", {"--covariances", output() + "/c.txt"}).exit_code, 1);
    EXPECT_EQ(readFile(output() + "/c.txt"), before);
    for (const auto& entry : fs::directory_iterator(output()))
        EXPECT_EQ(entry.path().filename().string().find(".partial"), std::string::npos) << entry.path();
}

TEST_F(OdometryProgram, QuietSaysNothing) {
    const auto result = runFrames(slidingRecording(4), {"--quiet"});
    EXPECT_EQ(result.exit_code, 0);
    EXPECT_EQ(result.out + result.err, "");
}

TEST_F(OdometryProgram, TheProfileShowsTheTimesOfTheSummary) {
    const auto result = runFrames(slidingRecording(12), {"--profile", "--quiet"});
    ASSERT_EQ(result.exit_code, 0);
    std::map<std::string, double> medians;
    std::istringstream lines(result.out);
    for (std::string line; std::getline(lines, line);) {
        std::istringstream words(line.substr(std::min<std::size_t>(24, line.size())));
        const std::size_t first = line.find_first_not_of(' ');
        if (double median; words >> median)
            medians[line.substr(first, line.find_last_not_of(' ', 23) + 1 - first)] = median;
    }
    for (const char* stage : {"decode", "edges", "coarse", "fine", "total"}) {
        ASSERT_EQ(medians.count(stage), 1U) << stage << '\n' << result.out;
        EXPECT_NEAR(medians[stage], summary()["timings_ms"][stage]["median"], 0.006) << stage;
    }
    for (const char* row : {"the rest", "waiting", "with a new keyframe", "without"})
        EXPECT_EQ(medians.count(row), 1U) << row << '\n' << result.out;
}

TEST_F(OdometryProgram, SameInputGivesSameBytes) {
    ASSERT_EQ(runFrames(slidingRecording(25)).exit_code, 0);
    const std::string first = readFile(output() + "/trajectory.txt"), map = readFile(output() + "/map.ply");
    ASSERT_EQ(run(folder_ / "recording").exit_code, 0);
    EXPECT_EQ(readFile(output() + "/trajectory.txt"), first);
    EXPECT_TRUE(readFile(output() + "/map.ply") == map);
}

TEST_F(OdometryProgram, FolderAndItsRawlogGiveSameBytes) {
    ASSERT_EQ(runFrames(slidingRecording(25)).exit_code, 0);
    const std::string from_folder = readFile(output() + "/trajectory.txt");
    const auto made = test::runProgram(
        "rgbd2rawlog", {"--input", folder_ / "recording", "--output", folder_ / "r.rawlog", "--verify"});
    ASSERT_EQ(made.exit_code, 0) << made.all();
    ASSERT_EQ(run(folder_ / "r.rawlog").exit_code, 0);
    EXPECT_EQ(readFile(output() + "/trajectory.txt"), from_folder);
    EXPECT_EQ(summary()["ground_truth"]["pairs"], 25) << "<stem>_groundtruth.txt beside the rawlog is found";
}

TEST_F(OdometryProgram, RealFolderAndItsRawlogGiveSameBytes) {
    const std::string clip = test::dataFolder() + "/tum_fr1_desk_9";
    if (!fs::exists(clip)) GTEST_SKIP() << "no " << clip;
    ASSERT_EQ(run(clip).exit_code, 0);
    const std::string from_folder = readFile(output() + "/trajectory.txt");
    EXPECT_EQ(summary()["frames"]["ok"], 8);
    ASSERT_EQ(
        test::runProgram("rgbd2rawlog", {"--input", clip, "--output", folder_ / "desk.rawlog"}).exit_code, 0);
    ASSERT_EQ(run(folder_ / "desk.rawlog").exit_code, 0);
    EXPECT_EQ(readFile(output() + "/trajectory.txt"), from_folder);
}

TEST_F(OdometryProgram, RawlogWithTwoCamerasIsRegisteredAndInitialises) {
    const std::string rawlog = "/usr/share/mrpt/datasets/tests_rgbd.rawlog";
    if (!fs::exists(rawlog)) GTEST_SKIP() << "no " << rawlog << " (package mrpt-common)";
    const auto result = run(rawlog);
    ASSERT_EQ(result.exit_code, 0) << result.all();
    ASSERT_EQ(rows().size(), 1u);
    EXPECT_EQ(status(0), "initialised");
    EXPECT_GT(std::stoi(rows()[0][4]), 50) << "organized edges";
}

TEST_F(OdometryProgram, OptionsComeFromConfigThenSet) {
    test::writeFile(folder_ / "c.ini", "[edges]\nmin_length = 17\nangle_deg = 25\n");
    const auto result = runFrames(slidingRecording(3), {"--config", folder_ / "c.ini", "--set",
                                                        "edges.min_length=19", "--set", "fine.chi2=7"});
    ASSERT_EQ(result.exit_code, 0) << result.all();
    const std::string used = readFile(output() + "/config_used.ini");
    for (const char* words : {"min_length = 19", "angle_deg = 25", "chi2 = 7"})
        EXPECT_NE(used.find(words), std::string::npos) << words;
    // What was used can be used again, and means the same.
    const std::string trajectory = readFile(output() + "/trajectory.txt");
    fs::copy_file(output() + "/config_used.ini", folder_ / "again.ini");
    ASSERT_EQ(run(folder_ / "recording", {"--config", folder_ / "again.ini"}).exit_code, 0);
    EXPECT_EQ(readFile(output() + "/config_used.ini"), used);
    EXPECT_EQ(readFile(output() + "/trajectory.txt"), trajectory);
}

TEST_F(OdometryProgram, WrongOptionsNameTheClosestAndTheRange) {
    test::writeTumFolder(folder_ / "recording", slidingRecording(2));
    const auto set = [&](const std::string& text) { return run(folder_ / "recording", {"--set", text}); };
    expectError(set("edges.min_lenght=12"), 2, kName, {"edges.min_lenght", "'edges.min_length'"});
    expectError(set("edges.min_length=long"), 2, kName, {"edges.min_length", "'long'"});
    expectError(set("edges.angle_deg=1e9"), 2, kName, {"edges.angle_deg", "1 to 90"});
    expectError(set("nonsense"), 2, kName, {"section.key=value"});
    test::writeFile(folder_ / "c.ini", "[edges]\nmin_lenght = 17\n");
    expectError(run(folder_ / "recording", {"--config", folder_ / "c.ini"}), 1, kName,
                {"c.ini:2", "edges.min_length"});
    expectError(run(folder_ / "recording", {"--config", folder_ / "none.ini"}), 1, kName, {"none.ini"});
    EXPECT_FALSE(fs::exists(output())) << "nothing is made before the options are right";
}

TEST(DefaultConfig, TheShippedFileIsWhatIsBuiltIn) {
    const auto result = test::runProgram("roevo-odometry", {"--write-default-config", "-"});
    ASSERT_EQ(result.exit_code, 0) << result.all();
    EXPECT_EQ(result.out, readFile(std::string(ROEVO_SOURCE_DIR) + "/config_ini/roevo.ini"))
        << "after a change of defaults run: roevo-odometry --write-default-config config_ini/roevo.ini";
}

}  // namespace
}  // namespace roevo
