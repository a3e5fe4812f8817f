#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <map>
#include <sstream>

#include "support/csv_lines.h"
#include "support/environment.h"
#include "support/run_program.h"
#include "support/tum_folder.h"

namespace roevo {
namespace {

using test::expectError;
using test::ProgramResult;
using test::readFile;
using test::writeFile;

constexpr char kName[] = "roevo-study";

using Row = std::map<std::string, std::string>;

class StudyProgram : public testing::Test {
  protected:
    void write(int frames) { test::writeTumFolder(folder_ / "recording", test::slidingRecording(frames)); }

    ProgramResult run(const std::string& experiment, const std::vector<std::string>& more = {}) const {
        std::vector<std::string> arguments{"--experiment",        experiment, "--input",
                                           folder_ / "recording", "--output", folder_ / "out"};
        arguments.insert(arguments.end(), more.begin(), more.end());
        return test::runProgram(kName, arguments);
    }

    // Rows by column; no field may be anything but a finite number or a text.
    std::vector<Row> table(const std::string& name) const {
        const auto lines = test::csvLines(readFile(folder_ / ("out/" + name)));
        std::vector<Row> rows;
        for (std::size_t i = 1; i < lines.size(); ++i) {
            EXPECT_EQ(lines[i].size(), lines[0].size()) << name << ", line " << i + 1;
            Row row;
            for (std::size_t k = 0; k < std::min(lines[i].size(), lines[0].size()); ++k) {
                for (const char* bad : {"nan", "-nan", "inf", "-inf"}) EXPECT_NE(lines[i][k], bad) << name;
                row[lines[0][k]] = lines[i][k];
            }
            rows.push_back(row);
        }
        return rows;
    }

    void expectPlot(const std::string& name) const {
        EXPECT_NE(readFile(folder_ / ("out/" + name)).find("</svg>"), std::string::npos) << name;
        EXPECT_NE(index().find("![" + name + "](" + name + ")"), std::string::npos) << index();
    }
    bool exists(const std::string& name) const { return std::filesystem::exists(folder_ / ("out/" + name)); }
    std::string index() const { return readFile(folder_ / "out/study.md"); }

    test::TemporaryFolder folder_;
};

double number(const Row& row, const std::string& column) {
    const std::string& text = row.at(column);
    EXPECT_FALSE(text.empty()) << column;
    return text.empty() ? std::nan("") : std::stod(text);
}

TEST_F(StudyProgram, CannyThreshold) {
    write(6);
    const ProgramResult result = run("canny", {"--set", "edges.canny_factor=0.6", "--mode", "tr"});
    ASSERT_EQ(result.exit_code, 0) << result.all();
    EXPECT_EQ(result.out.find("canny"), 0u) << result.out;
    const auto rows = table("canny.csv");
    ASSERT_EQ(rows.size(), 10u) << "nine factors and the configured one";
    std::vector<double> factors;
    for (const Row& row : rows) {
        factors.push_back(number(row, "factor"));
        EXPECT_EQ(row.at("configured"), factors.back() == 0.6 ? "yes" : "no");
        EXPECT_EQ(row.at("recording"), "recording");
        EXPECT_EQ(row.at("mode"), "tr");
        EXPECT_EQ(row.at("frames"), "6");
        EXPECT_LT(number(row, "ate_m"), 0.02) << factors.back();
        if (factors.back() == 1) {
            EXPECT_EQ(number(row, "ate_ratio"), 1);
        }
        EXPECT_EQ(row.at("rpe_translation_ratio"), "") << "the recording is shorter than a second";
    }
    EXPECT_EQ(factors, (std::vector<double>{0.5, 0.6, 0.7, 1, 1.5, 2, 2.8, 4, 5.6, 8}));
    EXPECT_GT(number(rows.front(), "points_per_frame"), number(rows.back(), "points_per_frame"));
    expectPlot("canny.svg");
    EXPECT_NE(index().find("    roevo-study --experiment canny --input "), std::string::npos) << index();
    EXPECT_NE(index().find("| recording | " + (folder_ / "recording")), std::string::npos) << index();
}

TEST_F(StudyProgram, DepthWeight) {
    write(6);
    const ProgramResult result = run("depth-weight");
    ASSERT_EQ(result.exit_code, 0) << result.all();
    const auto rows = table("depth_weight.csv");
    ASSERT_EQ(rows.size(), 5u);
    EXPECT_EQ(number(rows[0], "k"), 0);
    EXPECT_EQ(number(rows[0], "ate_ratio"), 1);
    const auto curves = table("depth_weight_curves.csv");
    ASSERT_EQ(curves.size(), 81u);
    for (const Row& row : curves) {
        EXPECT_EQ(number(row, "none"), 0.5);
        // Eq. (20) with the paper's parameters for TUM RGB-D
        EXPECT_NEAR(number(row, "TUM RGB-D"), 1 / (1 + std::exp(0.75 * (number(row, "depth_m") - 4.7 / 2))),
                    1e-5);
    }
    expectPlot("depth_weight_curves.svg");
    expectPlot("depth_weight.svg");
}

TEST_F(StudyProgram, Repeatability) {
    write(6);
    const ProgramResult result = run("repeatability", {"--first", "4", "--skip", "1"});
    ASSERT_EQ(result.exit_code, 0) << result.all();
    const auto rows = table("repeatability.csv");
    ASSERT_EQ(rows.size(), 3u);
    EXPECT_EQ(rows[2].at("judged_by"), "ground truth");
    EXPECT_EQ(rows[2].at("reprojected_by"), "ground truth");
    EXPECT_NE(index().find("recording: judged by ground truth; edges reprojected at ground truth"),
              std::string::npos)
        << index();
    EXPECT_NEAR(number(rows[2], "translation_m"), 0.03, 1e-9);
    for (const char* method : {"lk", "nearest", "normals", "keyframe", "disjoint_set"}) {
        EXPECT_GT(number(rows[0], std::string(method) + "_share"), 0.7) << method;
        EXPECT_LE(number(rows[0], std::string(method) + "_share"), 1.0) << method;
        EXPECT_LE(number(rows[0], std::string(method) + "_precision"), 1.0) << method;
    }
    const auto bins = table("repeatability_binned.csv");
    EXPECT_EQ(bins.back().at("recording"), "all");
    expectPlot("repeatability.svg");
    expectPlot("repeatability_recordings.svg");
}

TEST_F(StudyProgram, SigmasAndDistribution) {
    write(6);
    const ProgramResult result =
        run("sigmas", {"--experiment", "distribution", "--mode", "tr", "--truth-sigma", "0.002", "0.2"});
    ASSERT_EQ(result.exit_code, 0) << result.all();
    for (const char* text : {"sigmas  ", "distribution  ", "| recording | tr | "})
        EXPECT_NE(result.out.find(text), std::string::npos) << text << " in\n" << result.out;
    EXPECT_NE(index().find("| recording | mode | over 1 s | over 3 s | from the start |\n|---|"),
              std::string::npos)
        << index();
    const auto sigmas = table("sigmas.csv");
    ASSERT_EQ(sigmas.size(), 3u);
    EXPECT_EQ(number(sigmas[2], "truth_sigma_m"), 0.002);
    EXPECT_EQ(number(sigmas[2], "truth_sigma_deg"), 0.2);
    EXPECT_EQ(table("sigmas_runs.csv").size(), 4u * 3) << "from frames 0 and 3, both ways";
    EXPECT_EQ(table("distribution.csv").size(), 1u);
    EXPECT_EQ(table("distribution_runs.csv").size(), 4u);
    expectPlot("sigmas.svg");
    expectPlot("distribution.svg");
    expectError(run("sigmas", {"--truth-sigma", "-1", "0"}), 2, kName, {"--truth-sigma", "-1"});
    expectError(run("sigmas", {"--truth-sigma", "1"}), 2, kName, {"--truth-sigma", "2"});
    expectError(run("sigmas", {"--truth-sigma", "nan", "0"}), 2, kName, {"--truth-sigma", "finite"});
    expectError(run("sigmas", {"--no-ground-truth"}), 1, kName, {"sigmas: recording", "no ground truth"});
}

TEST_F(StudyProgram, NoGroundTruthIsSaidAndErrorsStayEmpty) {
    write(4);
    std::filesystem::remove(folder_ / "recording/groundtruth.txt");
    const ProgramResult result = run("canny,depth-weight");
    ASSERT_EQ(result.exit_code, 0) << result.all();
    const std::size_t second = result.out.find("depth-weight");
    ASSERT_NE(second, std::string::npos) << result.out;
    for (const std::string& experiment : {result.out.substr(0, second), result.out.substr(second)})
        EXPECT_NE(experiment.find("no ground truth"), std::string::npos) << result.out;
    for (const char* name : {"canny.csv", "depth_weight.csv"})
        for (const Row& row : table(name)) {
            for (const char* column : {"ate_m", "ate_ratio"}) EXPECT_EQ(row.at(column), "") << name;
            EXPECT_EQ(row.at("frames"), "4");
            EXPECT_NE(row.at("note").find("no ground truth"), std::string::npos);
        }
    EXPECT_FALSE(exists("canny.svg"));
    EXPECT_FALSE(exists("depth_weight.svg"));
    ASSERT_EQ(run("repeatability").exit_code, 0);
    EXPECT_EQ(table("repeatability.csv").at(0).at("judged_by"), "roevo-ba");
    const std::string poses =
        "judged by final poses of ROEVO ba; edges reprojected at final poses of ROEVO ba";
    EXPECT_NE(index().find(poses), std::string::npos) << index();
    EXPECT_NE(readFile(folder_ / "out/repeatability.svg").find(poses), std::string::npos);
}

TEST_F(StudyProgram, GroundTruthOfAnotherTimeIsSaid) {
    write(4);
    writeFile(folder_ / "other.txt", "5 0 0 0 0 0 0 1\n5.1 0 0 0 0 0 0 1\n5.2 0 0 0 0 0 0 1\n");
    const ProgramResult result = run("canny", {"--ground-truth", folder_ / "other.txt"});
    EXPECT_EQ(result.exit_code, 0) << result.all();
    EXPECT_NE(result.out.find("recording: errors at Otsu's threshold are not known"), std::string::npos)
        << result.out;
    const auto rows = table("canny.csv");
    ASSERT_EQ(rows.size(), 9u);
    EXPECT_EQ(rows[0].at("ate_m"), "");
    EXPECT_NE(rows[0].at("note").find("100.0"), std::string::npos)
        << "both time ranges: " << rows[0].at("note");
    expectError(run("repeatability", {"--ground-truth", folder_ / "other.txt"}), 1, kName,
                {"repeatability", "no two frames"});
}

TEST_F(StudyProgram, ABadRecordingIsALineAndTheOthersGoOn) {
    write(4);
    // Opened without a fault, but its ground truth is of another time
    test::writeTumFolder(folder_ / "other_time", test::slidingRecording(4));
    writeFile(folder_ / "other_time/groundtruth.txt",
              "5 0 0 0 0 0 0 1\n5.1 0 0 0 0 0 0 1\n5.2 0 0 0 0 0 0 1\n");
    const std::vector<std::string> more{"--input", folder_ / "none", folder_ / "other_time"};
    ProgramResult result = run("repeatability", more);
    ASSERT_EQ(result.exit_code, 0) << result.all();
    const std::string line = "other_time: left out: " + (folder_ / "other_time: no two frames");
    EXPECT_NE(result.out.find(line), std::string::npos) << result.out;
    EXPECT_NE(index().find("- " + line), std::string::npos) << index();
    EXPECT_NE(result.out.find("not used       " + (folder_ / "none") + ": "), std::string::npos)
        << result.out;
    EXPECT_NE(index().find("| not used | " + (folder_ / "none") + " | | "), std::string::npos) << index();
    for (const Row& row : table("repeatability.csv")) EXPECT_EQ(row.at("recording"), "recording");

    result = run("canny", more);
    ASSERT_EQ(result.exit_code, 0) << result.all();
    EXPECT_EQ(table("canny.csv").size(), 18u);
    EXPECT_NE(result.out.find("other_time: errors at Otsu's threshold are not known"), std::string::npos)
        << result.out;

    std::filesystem::remove_all(folder_ / "recording");
    expectError(run("repeatability", more), 1, kName, {"repeatability: other_time: ", "no two frames"});
    std::filesystem::remove_all(folder_ / "other_time");
    expectError(run("canny", more), 1, kName, {"none of the 3 recordings", folder_ / "recording"});
}

TEST_F(StudyProgram, TheReportTellsHowItWasMade) {
    write(3);
    ASSERT_EQ(run("depth-weight", {"--mode", "tr"}).exit_code, 0);
    const std::string text = index();
    EXPECT_NE(text.find("    roevo-study --experiment depth-weight --input " + (folder_ / "recording") +
                        " --output " + (folder_ / "out") + " --mode tr\n"),
              std::string::npos)
        << text;
    for (const char* word : {"Machine: ", " core", "ROEVO ", "MRPT ", "OpenCV ", "Eigen ", "compiler ",
                             "Protocol of errors: ", "0.02 s", "SE(3)", "RPE over 1 s", "UTC"})
        EXPECT_NE(text.find(word), std::string::npos) << word << " in\n" << text;
}

TEST_F(StudyProgram, WithoutGnuplotTheTablesAreWritten) {
    write(4);
    const test::TemporaryFolder empty;
    const test::WithEnvironment with("PATH", empty.path().string());
    const ProgramResult result = run("depth-weight");
    expectError(result, 1, kName,
                {"gnuplot is not installed", "depth_weight_curves.svg", "the tables are in"});
    EXPECT_EQ(table("depth_weight.csv").size(), 5u);
    EXPECT_NE(index().find("gnuplot is not installed"), std::string::npos) << index();
    EXPECT_FALSE(exists("depth_weight.svg"));
}

TEST_F(StudyProgram, FramesThatCannotBeReadAreLeftOutAndSaid) {
    write(6);
    writeFile(folder_ / "recording/rgb/0003.png", "not an image");
    const ProgramResult result = run("repeatability");
    ASSERT_EQ(result.exit_code, 0) << result.all();
    EXPECT_NE(result.out.find("1 frame left out"), std::string::npos) << result.out;
    EXPECT_EQ(table("repeatability.csv").size(), 4u);
    const ProgramResult canny = run("canny");
    ASSERT_EQ(canny.exit_code, 0) << canny.all();
    const std::string line = "recording: 1 of 6 frames could not be read and were left out, the first: ";
    EXPECT_NE(canny.out.find("damaged        " + line), std::string::npos) << canny.out;
    EXPECT_NE(index().find("- " + line), std::string::npos) << index();
}

TEST_F(StudyProgram, WrongUsage) {
    write(3);
    expectError(run("colour"), 2, kName, {"'colour'", "canny", "depth-weight", "repeatability", "all"});
    expectError(run("--input"), 2, kName, {"--experiment", "there is no '--input'", "known are canny"});
    expectError(run("canny", {"--first", "2"}), 2, kName, {"--first 2", "at least 3"});
    expectError(run("canny", {"--set", "edges.canny_factor=100"}), 2, kName, {"canny_factor", "100"});
    expectError(run("canny", {"--mode", "fast"}), 2, kName, {"--mode", "fast"});
    expectError(run("canny", {"--input", folder_ / "recording", "--ground-truth", "x"}), 2, kName,
                {"--ground-truth", "2"});
    expectError(run("canny", {"--no-ground-truth", "--ground-truth", "x"}), 2, kName, {"--no-ground-truth"});
    EXPECT_FALSE(exists("study.md"));
}

TEST_F(StudyProgram, LeavesWhatAnotherExperimentMade) {
    write(4);
    ASSERT_EQ(run("canny").exit_code, 0);
    ASSERT_EQ(run("depth-weight").exit_code, 0);
    EXPECT_TRUE(exists("canny.csv"));
}

TEST_F(StudyProgram, BadInput) {
    write(2);
    expectError(run("all"), 1, kName, {folder_ / "recording", "only 2 frames", "at least 3"});
    expectError(test::runProgram(kName, {"--experiment", "canny", "--input", folder_ / "none", "--output",
                                         folder_ / "out"}),
                1, kName, {folder_ / "none", "no such file"});
    expectError(run("canny", {"--skip", "9"}), 1, kName, {"--skip 9", "only 2"});
    expectError(run("canny", {"--ground-truth", folder_ / "none.txt"}), 1, kName, {folder_ / "none.txt"});
    write(3);
    for (int i = 0; i < 3; ++i)
        writeFile(folder_ / ("recording/rgb/000" + std::to_string(i) + ".png"), "no image");
    expectError(run("canny"), 1, kName, {"no frame can be read"});
    EXPECT_FALSE(exists("study.md"));
}

}  // namespace
}  // namespace roevo
