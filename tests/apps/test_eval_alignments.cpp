#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <sstream>

#include "evaluation/alignment.h"
#include "evaluation/evaluate.h"
#include "evaluation/trajectory_io.h"
#include "support/run_program.h"

namespace roevo {
namespace {

using test::expectError;

constexpr char kEvalProgram[] = "roevo-eval";

// A curve that uses all axes, 10 Hz, 4 s.
std::vector<StampedPose> curve() {
    std::vector<StampedPose> poses;
    for (int i = 0; i <= 40; ++i) {
        const double t = 0.1 * i;
        poses.push_back({100 + t, Pose(Eigen::Translation3d(std::sin(t), 0.3 * t, std::cos(2 * t)) *
                                       Eigen::AngleAxisd(0.4 * t, Eigen::Vector3d(1, 2, -1).normalized()))});
    }
    return poses;
}

std::vector<StampedPose> moved(const Pose& T, double scale, std::vector<StampedPose> poses) {
    for (StampedPose& pose : poses) {
        pose.T_world_camera.translation() *= scale;
        pose.T_world_camera = T * pose.T_world_camera;
    }
    return poses;
}

std::vector<Eigen::Vector3d> centres(const std::vector<StampedPose>& poses) {
    std::vector<Eigen::Vector3d> points;
    for (const StampedPose& pose : poses) points.push_back(pose.T_world_camera.translation());
    return points;
}

const Pose kTurned(Eigen::Translation3d(3, -1, 2) * Eigen::AngleAxisd(2.3, Eigen::Vector3d::UnitZ()));
const Pose kTilted(Eigen::Translation3d(3, -1, 2) *
                   Eigen::AngleAxisd(1.1, Eigen::Vector3d(1, -2, 0.5).normalized()));

TEST(EvalAlignment, AKnownYawIsFound) {
    const Pose found = alignYaw(centres(curve()), centres(moved(kTurned, 1, curve())));
    EXPECT_LT((found.matrix() - kTurned.matrix()).norm(), 1e-12);
}

TEST(EvalAlignment, NoOtherYawIsBetter) {
    const auto source = centres(curve()), target = centres(moved(kTilted, 1.2, curve()));
    const auto cost = [&](const Pose& T) {
        double sum = 0;
        for (std::size_t i = 0; i < source.size(); ++i) sum += (target[i] - T * source[i]).squaredNorm();
        return sum;
    };
    const Pose found = alignYaw(source, target);
    EXPECT_NEAR(found.linear()(2, 2), 1, 1e-12) << "a turn about z and nothing else";
    for (const double step : {-0.01, 0.01}) {
        EXPECT_GT(cost(Pose(found.isometry() * Eigen::AngleAxisd(step, Eigen::Vector3d::UnitZ()))),
                  cost(found));
        for (int axis = 0; axis < 3; ++axis)
            EXPECT_GT(cost(Pose(Eigen::Translation3d(step * Eigen::Vector3d::Unit(axis)) * found.isometry())),
                      cost(found));
    }
}

TEST(EvalAlignment, EachTakesOffWhatItShould) {
    const auto ate = [](const Pose& T, double scale, Alignment alignment) {
        return evaluate(moved(T, scale, curve()), curve(), kDefaultMaxDt, alignment).ate.translation.rmse;
    };
    const Pose shifted(Eigen::Translation3d(0.3, 0, 0.4));
    EXPECT_LT(ate(Pose(), 1, Alignment::kNone), 1e-12);
    EXPECT_NEAR(ate(shifted, 1, Alignment::kNone), 0.5, 1e-12);
    EXPECT_LT(ate(kTurned, 1, Alignment::kYaw), 1e-12);
    EXPECT_GT(ate(kTilted, 1, Alignment::kYaw), 0.1);
    EXPECT_LT(ate(kTilted, 1, Alignment::kSe3), 1e-12);
    EXPECT_GT(ate(kTilted, 2.5, Alignment::kSe3), 0.1);
    EXPECT_LT(ate(kTilted, 2.5, Alignment::kSim3), 1e-12);
}

TEST(EvalAlignment, AKnownScaleIsFoundAndTakenOffTheRelativeErrorsToo) {
    const auto e = evaluate(moved(kTilted, 2.5, curve()), curve(), kDefaultMaxDt, Alignment::kSim3);
    EXPECT_NEAR(e.scale, 2.5, 1e-12);
    EXPECT_LT(e.rpe_second.translation.max, 1e-12);
    EXPECT_LT(e.rpe_frame.translation.max, 1e-12);
    EXPECT_EQ(evaluate(curve(), curve()).scale, 1);
}

TEST(EvalAlignment, WhoNeverMovesHasNoScale) {
    auto still = curve();
    for (StampedPose& pose : still) pose.T_world_camera.translation().setConstant(0.7);
    for (const bool estimate_moves : {false, true}) {
        try {
            evaluate(estimate_moves ? still : curve(), estimate_moves ? curve() : still, kDefaultMaxDt,
                     Alignment::kSim3);
            FAIL() << estimate_moves;
        } catch (const std::runtime_error& e) {
            EXPECT_EQ(std::string(e.what()), std::string("the ") +
                                                 (estimate_moves ? "reference" : "estimate") +
                                                 " never moves: no scale can be told");
        }
    }
}

/// A reference, an estimate that is it at 2/5 of the size, and one that is all right.
class EvalSeveral : public ::testing::Test {
  protected:
    EvalSeveral() {
        writeTumTrajectory(folder_ / "truth.txt", moved(kTilted, 2.5, curve()));
        writeTumTrajectory(folder_ / "small.txt", curve());
        writeTumTrajectory(folder_ / "right.txt", moved(kTurned, 2.5, curve()));
        test::writeFile(folder_ / "late.txt", "900 0 0 0 0 0 0 1\n901 0 0 0 0 0 0 1\n902 0 0 1 0 0 0 1\n");
    }
    test::ProgramResult eval(const std::vector<std::string>& estimates,
                             const std::vector<std::string>& more = {}) const {
        std::vector<std::string> arguments{"--reference", folder_ / "truth.txt", "--estimate"};
        arguments.insert(arguments.end(), estimates.begin(), estimates.end());
        arguments.insert(arguments.end(), more.begin(), more.end());
        return test::runProgram(kEvalProgram, arguments);
    }
    std::string named(const std::string& name, const std::string& file) const {
        return name + "=" + (folder_ / file);
    }

    test::TemporaryFolder folder_;
};

TEST_F(EvalSeveral, StandSideBySide) {
    const auto run = eval({named("a, small_one", "small.txt"), folder_ / "right.txt"},
                          {"--align", "sim3", "--table", folder_ / "t.csv", "--json", folder_ / "t.json"});
    ASSERT_EQ(run.exit_code, 0) << run.all();
    for (const char* word : {"Sim(3)", "a, small_one", "right.txt", "2.5000", "1.0000", "0.000"})
        EXPECT_NE(run.out.find(word), std::string::npos) << word << '\n' << run.out;

    std::istringstream csv(test::readFile(folder_ / "t.csv"));
    std::string head, row;
    std::getline(csv, head);
    EXPECT_EQ(head.rfind("name,file,alignment,scale,poses,pairs,ate_rmse_m,ate_mean_m", 0), 0u) << head;
    std::getline(csv, row);
    EXPECT_EQ(row.rfind("\"a, small_one\"," + (folder_ / "small.txt") + ",sim3,2.", 0), 0u) << row;
    EXPECT_EQ(std::count(head.begin(), head.end(), ',') + 1, std::count(row.begin(), row.end(), ','));

    const auto json = nlohmann::json::parse(test::readFile(folder_ / "t.json"));
    EXPECT_EQ(json["alignment"], "sim3");
    ASSERT_EQ(json["estimates"].size(), 2u);
    EXPECT_NEAR(json["estimates"][0]["scale"].get<double>(), 2.5, 1e-7);
    EXPECT_LT(json["estimates"][1]["ate_m"]["max"].get<double>(), 1e-7);
}

TEST_F(EvalSeveral, ATableForAPaperHasTheBestInBoldAndNamesAsTheyAre) {
    const auto run = eval({named("50% of_it & $x^2~\\", "small.txt"), named("right", "right.txt")},
                          {"--table", folder_ / "t.tex"});
    ASSERT_EQ(run.exit_code, 0) << run.all();
    const std::string tex = test::readFile(folder_ / "t.tex");
    EXPECT_NE(tex.find("\n50\\% of\\_it \\& \\$x\\^{}2\\~{}\\textbackslash{} & "), std::string::npos) << tex;
    EXPECT_NE(tex.find("\nright & \\textbf{0.000} & \\textbf{0.000} & \\textbf{0.000}"), std::string::npos)
        << tex;
    const std::string small = tex.substr(tex.find("\n50"), tex.find("\nright") - tex.find("\n50"));
    EXPECT_EQ(small.find("textbf{", 0), small.rfind("textbf{")) << "best in the turn only, as the other is:\n"
                                                                << tex;
}

TEST_F(EvalSeveral, OneThatHasPartOfThePosesOnlyIsNamed) {
    const std::string whole = test::readFile(folder_ / "right.txt");
    test::writeFile(folder_ / "part.txt", whole.substr(0, whole.find('\n', whole.size() / 2) + 1));
    const auto run =
        eval({named("whole", "right.txt"), named("half", "part.txt")}, {"--table", folder_ / "t.tex"});
    EXPECT_EQ(run.exit_code, 0);
    const std::string tex = test::readFile(folder_ / "t.tex");
    EXPECT_EQ(tex.find("textbf", tex.find("\nhalf")), std::string::npos) << "a part is not the best:\n"
                                                                         << tex;
    EXPECT_NE(tex.find("textbf", tex.find("\nwhole")), std::string::npos) << tex;
    const auto alike = eval({named("a", "right.txt"), named("a", "part.txt")});
    EXPECT_NE(alike.err.find("part.txt is judged by "), std::string::npos) << alike.err;
    for (const char* file : {"/right.txt ", "/part.txt "})
        EXPECT_NE(alike.out.find(file), std::string::npos) << "a name of both tells neither: " << alike.out;
    EXPECT_NE(alike.out.find(" pairs "), std::string::npos) << "as in the CSV: " << alike.out;
    EXPECT_NE(run.err.find("warning: half is judged by "), std::string::npos) << run.err;
    EXPECT_NE(run.err.find(", whole by "), std::string::npos) << run.err;
    EXPECT_EQ(eval({named("whole", "right.txt"), named("too", "right.txt")}).err, "");
}

TEST_F(EvalSeveral, AScaleThatExplainsTheErrorIsNamed) {
    const auto run = eval({folder_ / "small.txt"});
    EXPECT_EQ(run.exit_code, 0);
    EXPECT_NE(run.err.find("small.txt: the ground truth's path is 2.5 times as long"), std::string::npos)
        << run.err;
    EXPECT_NE(run.err.find("--align sim3"), std::string::npos) << run.err;
    EXPECT_EQ(eval({folder_ / "small.txt"}, {"--align", "sim3"}).err, "");
}

TEST_F(EvalSeveral, FailuresAreOneLine) {
    expectError(eval({folder_ / "right.txt"}, {"--align", "affine"}), 2, kEvalProgram, {"--align", "sim3"});
    expectError(eval({folder_ / "right.txt"}, {"--table", folder_ / "t.txt"}), 2, kEvalProgram,
                {"--table", ".tex"});
    expectError(eval({folder_ / "right.txt"}, {"--table", folder_ / "no/t.csv"}), 1, kEvalProgram,
                {"cannot write", "t.csv"});
    expectError(eval({folder_ / "right.txt", folder_ / "late.txt"}, {"--table", folder_ / "t.csv"}), 1,
                kEvalProgram, {"late.txt: no pose", "902.000000"});
    test::writeFile(folder_ / "far.txt", "100 0 0 0 0 0 0 1\n101 1e200 0 0 0 0 0 1\n102 0 1e200 0 0 0 0 1\n");
    expectError(eval({folder_ / "far.txt"}), 1, kEvalProgram,
                {"far.txt: its errors are too large to be computed"});
    expectError(eval({"=" + (folder_ / "right.txt")}), 2, kEvalProgram, {"is not NAME=FILE"});
    EXPECT_FALSE(std::filesystem::exists(folder_ / "t.csv"));
}

}  // namespace
}  // namespace roevo
