#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <nlohmann/json.hpp>

#include "evaluation/trajectory_io.h"
#include "support/run_program.h"
#include "support/trajectory_files.h"

namespace roevo {
namespace {

using test::expectError;
using test::TemporaryFolder;
using test::writeFile;

constexpr char kEval[] = "roevo-eval";
constexpr double kStart = 1403636579.75;  // s

// A helix with turns about an odd axis, 20 Hz.
std::vector<StampedPose> helix(int count = 60) {
    std::vector<StampedPose> poses;
    for (int i = 0; i < count; ++i) {
        const double t = 0.05 * i;
        poses.push_back(
            {kStart + t, Pose(Eigen::Translation3d(std::cos(t), std::sin(t), 0.2 * t) *
                              Eigen::AngleAxisd(0.7 * t, Eigen::Vector3d(2, -1, 1).normalized()))});
    }
    return poses;
}

std::string kitti(const std::vector<StampedPose>& poses) {
    std::string text;
    for (const StampedPose& pose : poses) {
        char number[40];
        for (int i = 0; i < 12; ++i) {
            std::snprintf(number, sizeof number, "%.12e", pose.T_world_camera.matrix()(i / 4, i % 4));
            text += number + std::string(i == 11 ? "\n" : " ");
        }
    }
    return text;
}

void expectSame(const std::vector<StampedPose>& found, const std::vector<StampedPose>& expected) {
    ASSERT_EQ(found.size(), expected.size());
    for (std::size_t i = 0; i < found.size(); ++i) {
        EXPECT_NEAR(found[i].timestamp, expected[i].timestamp, 1e-6);
        EXPECT_LT((found[i].T_world_camera.matrix() - expected[i].T_world_camera.matrix()).norm(), 1e-8) << i;
    }
}

class TrajectoryFormats : public ::testing::Test {
  protected:
    std::string file(const std::string& name, const std::string& text) const {
        writeFile(folder_ / name, text);
        return folder_ / name;
    }
    std::string truth() const {
        writeTumTrajectory(folder_ / "truth.txt", helix());
        return folder_ / "truth.txt";
    }
    // What reading a file with this text complains of.
    std::string complaint(const std::string& text, const RowTimes& times = {}) const {
        try {
            readTrajectory(file("t", text), {}, times);
        } catch (const std::runtime_error& e) {
            return e.what();
        }
        return {};
    }
    test::ProgramResult eval(const std::string& reference, const std::vector<std::string>& rest) const {
        std::vector<std::string> arguments{"--reference", reference, "--estimate"};
        arguments.insert(arguments.end(), rest.begin(), rest.end());
        return test::runProgram(kEval, arguments);
    }

    TemporaryFolder folder_;
};

TEST_F(TrajectoryFormats, StampsOfThisCenturyTellTheirUnit) {
    for (const double unit : {1e3, 1e6, 1e9}) {
        auto poses = helix();
        const std::string rows = file("kitti.txt", kitti(poses));
        for (StampedPose& pose : poses) pose.timestamp *= unit;
        writeTumTrajectory(folder_ / "other.txt", poses);
        expectSame(readTrajectory(folder_ / "other.txt"), helix());
        EXPECT_EQ(readTumTrajectory(folder_ / "other.txt").front().timestamp, kStart * unit)
            << "who asks for TUM's format gets what the file has";
        for (const std::vector<std::string>& more : {std::vector<std::string>{rows},
                                                     {rows, "--times", folder_ / "other.txt"},
                                                     {folder_ / "other.txt", "--format", "tum"}}) {
            const auto run = eval(folder_ / "other.txt", more);
            EXPECT_EQ(run.exit_code, 0) << run.all();
        }
    }
    writeTumTrajectory(folder_ / "other.txt", {{1e6, Pose::Identity()}});
    EXPECT_EQ(readTrajectory(folder_ / "other.txt").front().timestamp, 1e6) << "s, or ms since the start";
    auto since_boot = helix();  // ns, for 20 minutes: as many as ms since 2008
    for (StampedPose& pose : since_boot) pose.timestamp = 1e9 * (pose.timestamp - kStart + 1200);
    writeTumTrajectory(folder_ / "other.txt", since_boot);
    EXPECT_EQ(readTrajectory(folder_ / "other.txt").front().timestamp, since_boot.front().timestamp);
}

TEST_F(TrajectoryFormats, AreRecognisedByTheirContent) {
    expectSame(readTrajectory(truth()), helix());
    expectSame(readTrajectory(file("e", test::eurocText(helix()))), helix());
    RowTimes times;
    for (const StampedPose& pose : helix()) times.stamps.push_back(pose.timestamp);
    expectSame(readTrajectory(file("k", kitti(helix())), {}, times), helix());
}

TEST_F(TrajectoryFormats, TimesOfRowsAreInTheOrderOfTheFile) {
    EXPECT_EQ(readRowTimes(file("a", "# s\n3.5e+00\n1.25\n")).stamps, (std::vector<double>{3.5, 1.25}));
    EXPECT_EQ(readRowTimes(file("b", "7 0 0 0 0 0 0 1\n7 1 0 0 0 0 0 1\n")).stamps,
              (std::vector<double>{7, 7}));
    EXPECT_EQ(readRowTimes(file("c", "2000000500,0,0,0,1,0,0,0\n")).stamps,
              (std::vector<double>{2 + 500e-9}));
    EXPECT_TRUE(readRowTimes(file("d", kitti(helix(3)))).stamps.empty());
    // The first row of the file is at 3 s, not the earliest one
    const auto poses = readTrajectory(file("k", kitti(helix(2))), {}, {{3, 1}, "times"});
    EXPECT_EQ(poses[0].timestamp, 1);
    EXPECT_LT((poses[0].T_world_camera.matrix() - helix(2)[1].T_world_camera.matrix()).norm(), 1e-10);
}

TEST_F(TrajectoryFormats, ErrorsNameFileAndLineAndWhatWasExpected) {
    const auto expect = [&](const std::string& text, const std::string& words, const RowTimes& times = {}) {
        EXPECT_NE(complaint(text, times).find(words), std::string::npos) << words << "\n"
                                                                         << complaint(text, times);
    };
    const std::string k = "1 0 0 0 0 1 0 0 0 0 1 0\n", e = "5,0,0,0,1,0,0,0\n";
    expect("1 2 3\n", "t:1: expected 8 numbers (timestamp tx ty tz qx qy qz qw), 12 numbers (KITTI");
    expect("hello\n",
           "t:1: 'hello' is not a number; expected 8 numbers (timestamp tx ty tz qx qy qz qw), 12");
    expect(k + "1 0 0 0 0 1 0 0 0 0 1\n",
           "t:2: expected 12 numbers (KITTI: rows r r r t of a 3 x 4 matrix), found 11");
    expect(k + "1 0 0 0 0 1 0 nan 0 0 1 0\n", "t:2: 'nan' is not finite");
    expect(k + "1 0 0 0 0 1 0 0 0 0 -1 0\n", "t:2: the first three of each four numbers are no rotation");
    expect(k + "0 0 0 0 0 0 0 0 0 0 0 0\n", "t:2: the first three of each four numbers are no rotation");
    expect(k, "t: a KITTI file has no times, and neither has other", {{}, "other"});
    expect(k + k, "t:2: the last of 2 rows, which have no times (KITTI); expected 3, one for each in truth",
           {{1, 2, 3}, "truth"});
    expect(e + "6,0,0\n", "t:2: expected 8 or more numbers with commas between (EuRoC");
    expect("5,0,0,0,1,0,0,0,9,9\n6,0,0,0,1,0,0,0,9\n",
           "t:2: expected 10 numbers, as in the first row, found 9");
    expect(e + "6,0,0,0,0,0,0,0\n", "t:2: the quaternion has length 0");
    expect(e + "6,inf,0,0,1,0,0,0\n", "t:2: 'inf' is not finite");
    expect(e + "6,,0,0,1,0,0,0\n", "t:2: '' is not a number");
    expect("1403636579.75,0,0,0,1,0,0,0\n", "t:1: '1403636579.75' is not a time stamp in whole nanoseconds");
    expect("", "no pose in it; expected lines of 8 numbers");
    EXPECT_THROW(readRowTimes(file("t", "# none\n")), std::runtime_error);
}

TEST_F(TrajectoryFormats, GiveTheSameErrorsToThePrograms) {
    std::vector<StampedPose> estimate = helix();
    for (std::size_t i = 0; i < estimate.size(); ++i)
        estimate[i].T_world_camera.translation().z() += i % 2 ? 0.01 : -0.01;
    writeTumTrajectory(folder_ / "tum.txt", estimate);
    const auto run =
        eval(truth(), {folder_ / "tum.txt", file("kitti.txt", kitti(estimate)),
                       file("euroc.csv", test::eurocText(estimate)), "--json", folder_ / "e.json"});
    ASSERT_EQ(run.exit_code, 0) << run.all();
    const auto json = nlohmann::json::parse(test::readFile(folder_ / "e.json"))["estimates"];
    ASSERT_EQ(json.size(), 3u);
    for (const auto& each : json) {
        EXPECT_EQ(each["pairs"], 60);
        EXPECT_NEAR(each["ate_m"]["rmse"].get<double>(), 0.01, 1e-4);
        EXPECT_NEAR(each["ate_m"]["rmse"].get<double>(), json[0]["ate_m"]["rmse"].get<double>(), 1e-8);
    }
}

TEST_F(TrajectoryFormats, AGroundTruthOfKittiNeedsItsListOfTimes) {
    const std::string truth = file("00.txt", kitti(helix())), estimate = file("mine.txt", kitti(helix()));
    std::string times;
    for (int i = 0; i < 60; ++i) times += std::to_string(0.1 * i) + "\n";
    expectError(eval(truth, {estimate}), 1, kEval, {"00.txt: a KITTI file has no times", "--times"});
    const auto run = eval(truth, {estimate, "--times", file("times.txt", times)});
    EXPECT_EQ(run.exit_code, 0) << run.all();
    EXPECT_NE(run.out.find("60 of 60"), std::string::npos) << run.out;
    expectError(eval(truth, {estimate, "--times", file("times.txt", times + "7\n")}), 1, kEval,
                {"00.txt:60: the last of 60 rows", "expected 61", "times.txt"});
}

TEST_F(TrajectoryFormats, FailuresOfThePrograms) {
    const std::string bad = file("bad.csv", test::eurocText(helix(5)) + "1403636580000000000,0,0\r\n");
    expectError(eval(truth(), {bad}), 1, kEval, {"bad.csv:7: expected 8 or more numbers", "found 3"});
    expectError(eval(truth(), {file("k.txt", kitti(helix(59)))}), 1, kEval,
                {"k.txt:59:", "expected 60", "truth.txt"});
    expectError(eval(truth(), {truth(), "--format", "kitti"}), 1, kEval,
                {"truth.txt:2: expected 12 numbers", "found 8"});
    expectError(eval(truth(), {truth(), "--format", "bag"}), 2, kEval, {"--format", "euroc"});
    expectError(eval(truth(), {truth(), "--times", folder_ / "none"}), 1, kEval, {"cannot read", "none"});
    auto late = helix();
    for (StampedPose& pose : late) pose.timestamp += 500;
    expectError(eval(truth(), {file("late.csv", test::eurocText(late))}), 1, kEval,
                {"no pose has a reference", "--offset"});
}

TEST_F(TrajectoryFormats, CommasMayStandBetweenTumsColumns) {
    std::string text = test::readFile(truth());
    std::replace(text.begin(), text.end(), ' ', ',');
    const std::string commas = file("commas.txt", text);
    expectSame(readTrajectory(commas, TrajectoryFormat::kTum), helix());
    EXPECT_THROW(readTrajectory(commas), std::runtime_error) << "EuRoC's, were it not told otherwise";
}

std::string csv(const std::string& head, bool w_first, double unit, int decimals) {
    std::string text = head;
    for (const StampedPose& pose : helix()) {
        const Eigen::Vector3d p = pose.T_world_camera.translation();
        const Eigen::Quaterniond q = pose.T_world_camera.rotation();
        char row[300];
        std::snprintf(row, sizeof row, "%.*f,%.9f,%.9f,%.9f,%.12f,%.12f,%.12f,%.12f\n", decimals,
                      unit * pose.timestamp, p.x(), p.y(), p.z(), w_first ? q.w() : q.x(),
                      w_first ? q.x() : q.y(), w_first ? q.y() : q.z(), w_first ? q.z() : q.w());
        text += row;
    }
    return text;
}

TEST_F(TrajectoryFormats, NamesOfTheColumnsTellTheirOrder) {
    const std::string p = "timestamp,px,py,pz,", t = "\"t\",\"tx (m)\",\"ty (m)\",\"tz (m)\",";
    for (const std::string mark : {"", "#", "# made by hand\n# "})
        for (const auto& [unit, decimals] : {std::make_pair(1.0, 6), std::make_pair(1e9, 0)}) {
            for (const std::string& head : {p + "qx,qy,qz,qw\n", t + "q_x,q_y,q_z,q_w\n",
                                            p + "orientation.x,orientation.y,orientation.z,orientation.w\n"})
                expectSame(readTrajectory(file("t.csv", csv(mark + head, false, unit, decimals))), helix());
            for (const std::string& head :
                 {p + "qw,qx,qy,qz\n", t + "q_RS_w [],q_RS_x [],q_RS_y [],q_RS_z []\n"})
                expectSame(readTrajectory(file("e.csv", csv(mark + head, true, unit, decimals))), helix());
        }
    std::string blanks = csv("t,x,y,z,w,x,y,z\n", true, 1, 6);
    std::replace(blanks.begin(), blanks.end(), ',', ' ');
    expectSame(readTrajectory(file("b.txt", blanks)), helix());
    expectSame(readTrajectory(file("more.csv", "t,x,y,z,qw,qx,qy,qz,vx,vy\n" + test::eurocText(helix()))),
               helix());
    const std::string named = csv(p + "qx,qy,qz,qw\n", false, 1, 6);
    expectSame(readTumTrajectory(file("groundtruth.txt", named)), helix());
    EXPECT_EQ(readRowTimes(file("times.csv", named)).stamps.size(), 60u);
    EXPECT_NEAR(readRowTimes(file("times.csv", named)).stamps[1], kStart + 0.05, 1e-6);
    const auto run = eval(truth(), {folder_ / "t.csv", folder_ / "e.csv"});
    EXPECT_EQ(run.exit_code, 0) << run.all();
}

TEST_F(TrajectoryFormats, HeadsAreOneLineOfNames) {
    const std::string head = "timestamp,px,py,pz,qx,qy,qz,qw\n";
    EXPECT_NE(complaint(head + head + "5,0,0,0,0,0,0,1\n").find("t:2: 'timestamp' is not a"),
              std::string::npos);
    EXPECT_NE(complaint("nan nan nan nan nan nan nan nan\n").find("t:1: 'nan' is not finite"),
              std::string::npos);
    EXPECT_NE(complaint("5,0,0,0,1,0,0,0\n" + head).find("t:2: "), std::string::npos);
    EXPECT_NE(complaint(head).find("no pose in it"), std::string::npos);
}

TEST_F(TrajectoryFormats, CommasWithoutNamesThatBeginUnturnedInTumsOrderAreRefused) {
    const std::string nanoseconds = csv("", false, 1e9, 0);
    const std::string words = complaint(nanoseconds);
    EXPECT_NE(words.find("t:1: qw,qx,qy,qz (EuRoC) or qx,qy,qz,qw (TUM)? "), std::string::npos) << words;
    EXPECT_NE(words.find("name the columns in a first line: timestamp,tx,ty,tz,qx,qy,qz,qw"),
              std::string::npos)
        << words;
    expectSame(readTrajectory(folder_ / "t", TrajectoryFormat::kTum), [] {
        auto poses = helix();
        for (StampedPose& pose : poses) pose.timestamp = std::round(1e6 * pose.timestamp) / 1e6;
        return poses;
    }());
    EXPECT_NO_THROW(readTrajectory(file("t", nanoseconds), TrajectoryFormat::kEuroc)) << "as it was told";
    expectSame(readTrajectory(file("t", csv("", true, 1e9, 0))), helix());
    EXPECT_EQ(complaint("5,0,0,0,0,0,0,1,9,9\n"), "") << "TUM has no more columns";
}

TEST_F(TrajectoryFormats, WhatToDoCanBeDoneInEveryProgram) {
    const std::string commas = complaint(csv("", false, 1, 6));
    EXPECT_NE(commas.find("name the columns in a first line"), std::string::npos) << commas;
    EXPECT_EQ(commas.find("--format"), std::string::npos) << commas;
    const std::string times = complaint(kitti(helix()));
    EXPECT_NE(times.find("or write it with times: timestamp tx ty tz qx qy qz qw"), std::string::npos)
        << times;
}

}  // namespace
}  // namespace roevo
