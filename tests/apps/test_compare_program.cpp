// roevo-compare over recordings that are given one by one.
#include <gtest/gtest.h>
#include <sys/file.h>

#include <algorithm>
#include <csignal>
#include <cstdlib>
#include <filesystem>

#include "compare_program.h"
#include "roevo-compare/compare.h"
#include "roevo-compare/terminal_table.h"

namespace roevo {
namespace {

namespace fs = std::filesystem;
using test::expectError;
using test::readFile;
using test::slidingRecording;
using test::TemporaryFolder;
using test::writeFile;
using test::writeTumFolder;

constexpr char kName[] = "roevo-compare";

using Compare = test::CompareProgram;

TEST_F(Compare, RunsEveryMethodAsRoevoOdometryWould) {
    const std::string input = clip("clip", 8);
    const auto result = run({input}, {"--methods", "roevo-ba,roevo-tr,roevo-ct"});
    ASSERT_EQ(result.exit_code, 0) << result.all();
    for (const char* mode : {"ct", "tr", "ba"}) {
        const std::string method = std::string("roevo-") + mode;
        expectRow("clip," + method + ",");
        const MethodRun made = kept("clip", method);
        EXPECT_TRUE(made.ok()) << made.failure;
        EXPECT_EQ(made.frames, 8u);
        EXPECT_EQ(made.tracked, 8u);
        EXPECT_GT(made.total.median, 0);
        EXPECT_GT(made.decode.median, 0);
        EXPECT_GT(made.cpu_ms_per_frame, 0);
        EXPECT_GT(made.memory_peak_mb, 1);
        EXPECT_TRUE(fs::exists(runFolder("clip", method) + "/map.3Dscene"));
        EXPECT_TRUE(fs::exists(runFolder("clip", method) + "/frames.csv"));
        const auto alone = test::runProgram(
            "roevo-odometry", {"--input", input, "--output", folder / "alone", "--mode", mode, "--quiet"});
        ASSERT_EQ(alone.exit_code, 0) << alone.all();
        EXPECT_EQ(readFile(runFolder("clip", method) + "/trajectory.txt"),
                  readFile(folder / "alone/trajectory.txt"))
            << method;
        EXPECT_EQ(readFile(runFolder("clip", method) + "/config_used.ini"),
                  readFile(folder / "alone/config_used.ini"));
        EXPECT_NE(result.err.find("clip, " + method + ": 8 frames"), std::string::npos) << result.err;
    }
    EXPECT_NE(readFile(output() + "/table.md").find("One configuration for all"), std::string::npos);
    EXPECT_LT(table().find("\nclip,roevo-ba,"), table().find("\nclip,roevo-ct,")) << "in the order asked for";
    EXPECT_NE(result.out.find("ATE cm"), std::string::npos) << result.out;
    for (const char* file : {"table.md", "report.html", "config_used.ini"})
        EXPECT_TRUE(fs::exists(output() + "/" + file)) << file;
    EXPECT_NE(readFile(output() + "/table.md").find("--methods roevo-ba,roevo-tr,roevo-ct"),
              std::string::npos)
        << "the exact command";
}

TEST_F(Compare, OptionsAndFramesReachTheMethods) {
    const std::string input = clip("clip", 8);
    const std::vector<std::string> more{"--methods", "roevo-tr", "--skip",   "2",
                                        "--first",   "4",        "--set",    "edges.min_length=15",
                                        "--timeout", "100",      "--memory", "3000"};
    ASSERT_EQ(run({input}, more).exit_code, 0);
    const auto alone = test::runProgram(
        "roevo-odometry", {"--input", input, "--output", folder / "alone", "--mode", "tr", "--skip", "2",
                           "--first", "4", "--set", "edges.min_length=15", "--quiet"});
    ASSERT_EQ(alone.exit_code, 0) << alone.all();
    EXPECT_EQ(kept("clip", "roevo-tr").frames, 4u);
    EXPECT_EQ(readFile(runFolder("clip", "roevo-tr") + "/trajectory.txt"),
              readFile(folder / "alone/trajectory.txt"));
    EXPECT_NE(readFile(output() + "/config_used.ini").find("min_length = 15"), std::string::npos);
}

TEST_F(Compare, APartOfARecordingIsSaidAsItWasRun) {
    const std::string input = clip("clip", 6);  // and a rawlog, which does not tell its length before its end
    const auto converted =
        test::runProgram("rgbd2rawlog", {"--input", input, "--output", folder / "my.rawlog"});
    ASSERT_EQ(converted.exit_code, 0) << converted.all();
    ASSERT_EQ(
        run({input, folder / "my.rawlog"}, {"--methods", "distance-field", "--skip", "2", "--first", "100"})
            .exit_code,
        0);
    EXPECT_NE(readFile(output() + "/table.md").find("clip: frames 2 to 5; my: frames 2 to 5."),
              std::string::npos)
        << readFile(output() + "/table.md");
}

TEST_F(Compare, AModeInTheConfigIsSaidToHaveNoEffect) {
    const std::string input = clip("clip", 4);
    writeFile(folder / "ct.ini", "[odometry]\nmode = ct\n");
    writeFile(folder / "ba.ini", "[odometry]\nmode = ba\n");
    const auto with = [&](const std::string& config, const std::string& method,
                          const std::vector<std::string>& more = {}) {
        std::vector<std::string> all{"--methods", method, "--config", folder / config, "--rows-only"};
        all.insert(all.end(), more.begin(), more.end());
        const auto result = run({input}, all);
        EXPECT_EQ(result.exit_code, 0) << result.all();
        return result.err;
    };
    const std::string warned = with("ct.ini", "roevo-tr");
    EXPECT_NE(warned.find("warning: mode = ct in " + (folder / "ct.ini")), std::string::npos) << warned;
    EXPECT_NE(warned.find("--methods"), std::string::npos) << warned;
    EXPECT_NE(readFile(runFolder("clip", "roevo-tr") + "/frames.csv").find("ms_fine"), std::string::npos);
    EXPECT_EQ(with("ba.ini", "distance-field").find("warning"), std::string::npos)
        << "as it is in config_ini/roevo.ini";
    EXPECT_EQ(with("ct.ini", "distance-field", {"--quiet"}), "");
}

TEST_F(Compare, QuietSaysNothing) {
    const auto result = run({clip("clip", 4)}, {"--methods", "roevo-ct", "--quiet"});
    EXPECT_EQ(result.exit_code, 0);
    EXPECT_EQ(result.out, "");
    EXPECT_EQ(result.err, "");
}

TEST_F(Compare, ListsItsMethods) {
    const auto result = test::runProgram(kName, {"--list-methods"});
    EXPECT_EQ(result.exit_code, 0);
    for (const char* name : {"roevo-ct", "roevo-tr", "roevo-ba"})
        EXPECT_NE(result.out.find(name), std::string::npos) << result.out;
}

TEST_F(Compare, SeveralRecordingsOneOfThemBroken) {
    fs::create_directories(folder / "b");
    fs::create_directories(folder / "broken");
    const std::string first = clip("a/clip", 4), second = clip("b/clip", 5);
    const auto result = run({first, folder / "broken", second}, {"--methods", "roevo-ct"});
    ASSERT_EQ(result.exit_code, 0) << result.all();
    EXPECT_EQ(kept("a_clip", "roevo-ct").frames, 4u);
    EXPECT_EQ(kept("b_clip", "roevo-ct").frames, 5u);
    expectRow("a_clip,roevo-ct,");
    expectRow("broken,");
    expectRow("b_clip,roevo-ct,");
    EXPECT_NE(table().find("rgb.txt"), std::string::npos) << "the reason:\n" << table();
}

TEST_F(Compare, RawlogsAreRecordingsToo) {
    const std::string input = clip("clip", 5);
    const auto converted =
        test::runProgram("rgbd2rawlog", {"--input", input, "--output", folder / "my.rawlog"});
    ASSERT_EQ(converted.exit_code, 0) << converted.all();
    const auto result = run({folder / "my.rawlog", input}, {"--methods", "roevo-tr"});
    ASSERT_EQ(result.exit_code, 0) << result.all();
    EXPECT_EQ(readFile(runFolder("my", "roevo-tr") + "/trajectory.txt"),
              readFile(runFolder("clip", "roevo-tr") + "/trajectory.txt"));
    expectError(run({folder / "my.rawlog"}, {"--sensor-label", "nose"}), 1, kName, {"nose"});
    expectError(run({input}, {"--sensor-label", "nose"}), 2, kName, {"--sensor-label"});
}

TEST_F(Compare, UnreadableFramesAreForNoMethod) {
    const std::string input = clip("clip", 6);
    writeFile(input + "/rgb/0002.png", "no image");
    ASSERT_EQ(run({input}, {"--methods", "roevo-ct,roevo-tr"}).exit_code, 0);
    for (const char* method : {"roevo-ct", "roevo-tr"}) {
        EXPECT_EQ(kept("clip", method).frames, 6u);
        EXPECT_EQ(kept("clip", method).rejected, 1u);
        EXPECT_EQ(kept("clip", method).trajectory.size(), 5u);
        EXPECT_NE(readFile(runFolder("clip", method) + "/frames.csv").find("0002.png"), std::string::npos);
    }
}

TEST_F(Compare, NoGroundTruthLeavesEverythingButErrors) {
    const std::string input = clip("clip", 5);
    fs::remove(input + "/groundtruth.txt");
    const auto result = run({input}, {"--methods", "roevo-ct"});
    ASSERT_EQ(result.exit_code, 0) << result.all();
    expectRow("clip,roevo-ct,");
    EXPECT_NE(result.out.find("no errors: no ground truth"), std::string::npos) << result.out;
    EXPECT_EQ(result.out.find("nan"), std::string::npos);
    EXPECT_TRUE(kept("clip", "roevo-ct").ok());
}

TEST_F(Compare, GroundTruthThatWasAskedForMustBeGood) {
    const std::string input = clip("clip", 5);
    const auto with = [&](const std::string& file, std::vector<std::string> inputs = {}) {
        inputs.push_back(input);
        return run(inputs, {"--methods", "roevo-ct", "--ground-truth", file});
    };
    expectError(with(folder / "none.txt"), 1, kName, {"none.txt", "No such file"});
    writeFile(folder / "bad.txt", "1 2 3\n");
    expectError(with(folder / "bad.txt"), 1, kName, {"bad.txt:1:", "found 3"});
    expectError(with(input + "/groundtruth.txt", {input}), 2, kName, {"--ground-truth", "single"});
    EXPECT_FALSE(fs::exists(output())) << "no run was made for it";

    // Another clock: said with both ranges, and the runs are not lost
    std::string shifted;
    for (int i = 0; i < 5; ++i) shifted += std::to_string(9000 + i) + " 0 0 0 0 0 0 1\n";
    writeFile(folder / "shifted.txt", shifted);
    expectError(with(folder / "shifted.txt"), 1, kName, {"shifted.txt", "9000", "100."});
    expectRow("clip,roevo-ct,");
    EXPECT_NE(readFile(output() + "/table.md").find("9000"), std::string::npos);
    ASSERT_EQ(with(input + "/groundtruth.txt").exit_code, 0);
}

TEST_F(Compare, RecordingsThatCannotBeUsedAtAll) {
    expectError(run({folder / "none.rawlog"}), 1, kName, {"none.rawlog", "no such file"});
    const std::string input = clip("clip", 3);
    expectError(run({input, folder / "none.rawlog"}), 1, kName, {"none.rawlog", "no such file"});
    expectError(run({input}, {"--skip", "3"}), 1, kName, {"clip", "only 3 frames", "no frame"});
    expectError(run({input}, {"--skip", "4"}), 1, kName, {"clip", "only 3 frames"});
    writeFile(input + "/camera.txt", test::cameraText(5));
    expectError(run({input}), 1, kName, {"clip", "depth", "5000"});
    for (int i = 0; i < 3; ++i) writeFile(input + "/rgb/000" + std::to_string(i) + ".png", "no image");
    writeFile(input + "/camera.txt", test::cameraText());
    expectError(run({input}), 1, kName, {"clip", "none of its 3 frames", "0000.png"});
    EXPECT_FALSE(fs::exists(output()));
}

TEST_F(Compare, WrongUsage) {
    const std::string input = clip("clip", 3);
    expectError(test::runProgram(kName, {"--input", input}), 2, kName, {"--output is required"});
    expectError(test::runProgram(kName, {"--output", output()}), 2, kName, {"required"});
    expectError(run({input}, {"--methods", "roevo-xy"}), 2, kName, {"roevo-xy", "roevo-ba"});
    expectError(run({input}, {"--methods", "roevo-ba,roevo-ba"}), 2, kName, {"twice"});
    expectError(run({input}, {"--memory", "-1"}), 2, kName, {"--memory"});
    for (const char* of_one : {"--name", "--note", "--ground-truth"})
        expectError(run({input, input}, {of_one, "x"}), 2, kName, {of_one, "single --input"});
    expectError(run({input}, {"--name", "../x"}), 2, kName, {"--name ../x"});
    expectError(run({input}, {"--variant", "a/b"}), 2, kName, {"--variant a/b"});
    expectError(run({input}, {"--baseline", input}), 2, kName, {"--baseline is for --report"});
    expectError(run({input}, {"--report", input}), 2, kName, {"--input and --report"});
    expectError(run({input}, {"--timeout", "0"}), 2, kName, {"--timeout"});
    expectError(run({input}, {"--timeout", "nan"}), 2, kName, {"--timeout"});
    expectError(run({input}, {"--first", "-3"}), 2, kName, {"--first"});
    expectError(run({input}, {"--skip", "-3"}), 2, kName, {"--skip"});
    expectError(run({input}, {"--first", "many"}), 2, kName, {"--first"});
    expectError(run({input}, {"--set", "edges.nonsense=1"}), 2, kName, {"edges.nonsense"});
    expectError(run({input}, {"--set", "odometry.mode=ct"}), 2, kName, {"--methods"});
    for (const std::vector<std::string>& words : {std::vector<std::string>{"--run-method", "roevo-ct"},
                                                  {"--run-method", "roevo-ct", "--input", input},
                                                  {"--run-method", "roevo-ct", "--run-folder", output()}})
        expectError(test::runProgram(kName, words), 2, kName, {"--run-method", "use --methods"});
    expectError(run({input}, {"--config", folder / "none.ini"}), 1, kName, {"none.ini"});
    EXPECT_FALSE(fs::exists(output()));
    writeFile(output(), "a file");
    expectError(run({input}, {"--methods", "roevo-ct"}), 1, kName, {"output folder", output()});
}

TEST_F(Compare, AMethodThatFailsSaysWhyInItsOwnWords) {
    const std::string input = folder / "clip";
    auto frames = slidingRecording(4);
    for (auto& frame : frames) frame.depth = 0;
    writeTumFolder(input, frames);
    expectError(run({input}, {"--methods", "icp-frame,roevo-ct"}), 1, kName,
                {"no method gave a result; the first: none of the 4 frames has a pose"});
    for (const char* method : {"icp-frame", "roevo-ct"}) {
        EXPECT_EQ(kept("clip", method).failure.rfind("none of the 4 frames has a pose; the first says: ", 0),
                  0u)
            << kept("clip", method).failure;
        EXPECT_EQ(kept("clip", method).frames, 4u);
    }
}

TEST_F(Compare, RunsThatTakeTooLongAreFailuresInTheTable) {
    const std::string input = clip("clip", 30);
    const auto result = run({input}, {"--methods", "roevo-tr", "--timeout", "0.05"});
    expectError(result, 1, kName, {"no method gave a result", "0.05 s"});
    expectRow("clip,roevo-tr,");
    EXPECT_NE(table().find("not done within 0.05 s"), std::string::npos) << table();
}

TEST_F(Compare, MethodsThatAreNotAvailableAreSkippedWithTheReason) {
    CompareSettings settings;
    SequenceInput sequence;
    sequence.name = "clip";
    sequence.input = clip("clip", 3);
    settings.sequences = {sequence};
    MethodInfo method;
    method.name = "lacking";
    method.label = "Lacking";
    method.unavailable = "this build has no such library";
    settings.methods = {method};
    settings.output = output();
    settings.timeout_s = 10;
    settings.quiet = true;
    const ComparisonReport result = compare(settings);
    ASSERT_EQ(result.sequences.size(), 1u);
    ASSERT_EQ(result.sequences[0].runs.size(), 1u);
    EXPECT_EQ(result.sequences[0].runs[0].skipped, method.unavailable);
    EXPECT_FALSE(result.sequences[0].runs[0].ok());
    expectRow("clip,lacking,");
    EXPECT_NE(table().find(method.unavailable), std::string::npos) << table();
    EXPECT_NE(terminalTable(result.sequences).find("skipped: " + method.unavailable), std::string::npos)
        << terminalTable(result.sequences);
    EXPECT_FALSE(fs::exists(runFolder("clip", "lacking")));
}

TEST_F(Compare, RunsThatTakeTooMuchMemoryAreFailures) {
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
    GTEST_SKIP() << "sanitizers map terabytes: memory is not limited with them";
#endif
    const std::string input = clip("clip", 4);
    expectError(run({input}, {"--methods", "roevo-tr", "--memory", "20"}), 1, kName,
                {"no method gave a result"});
    EXPECT_NE(kept("clip", "roevo-tr").failure.find("memory"), std::string::npos)
        << kept("clip", "roevo-tr").failure;
}

TEST_F(Compare, AMethodThatCrashesIsARowAndTheNextOneRuns) {
    const std::string input = clip("clip", 80), myself = std::to_string(getpid());
    const std::string children = "/proc/" + myself + "/task/" + myself + "/children";
    if (!fs::exists(children)) GTEST_SKIP() << "no " << children;
    const auto result =
        runMeanwhile(arguments({input}, {"--methods", "roevo-tr,roevo-ct"}), [&](pid_t program) {
            const std::string id = std::to_string(program);
            std::string child;
            for (int i = 0; i < 6000 && child.empty(); ++i) {
                usleep(5'000);
                child = readFile("/proc/" + id + "/task/" + id + "/children");
                if (readFile("/proc/" + std::to_string(std::atoi(child.c_str())) + "/cmdline")
                        .find("--run-method") == std::string::npos)
                    child.clear();  // before its exec it still is this program
            }
            ASSERT_FALSE(child.empty());
            kill(std::stoi(child), SIGSEGV);
        });
    ASSERT_EQ(result.exit_code, 0) << result.all();
    expectRow("clip,roevo-tr,");
    expectRow("clip,roevo-ct,");
    EXPECT_NE(kept("clip", "roevo-tr").failure.find("signal 11"), std::string::npos)
        << kept("clip", "roevo-tr").failure;
    EXPECT_TRUE(kept("clip", "roevo-ct").ok());
    EXPECT_NE(result.out.find("failed: it died of signal 11"), std::string::npos) << result.out;
}

// Interrupts the program as soon as the first run is there. The second takes long enough for that.
TEST_F(Compare, AnInterruptKeepsWhatIsFinished) {
    const std::string quick = clip("quick", 3), slow = clip("slow", 80);
    fs::create_directories(output() + "/runs/quick/.roevo-tr.host.1.partial/deep");  // of one that was killed
    const std::string first = runFolder("quick", "roevo-tr") + "/run.json";
    const auto result = runMeanwhile(arguments({quick, slow}, {"--methods", "roevo-tr"}), [&](pid_t program) {
        for (int i = 0; i < 6000 && !fs::exists(first); ++i) usleep(5'000);
        kill(program, SIGINT);
    });
    expectError(result, 1, kName, {"interrupted", "runs that were done are kept", "--report"});
    EXPECT_TRUE(kept("quick", "roevo-tr").ok());
    EXPECT_FALSE(fs::exists(runFolder("slow", "roevo-tr")));
    for (const auto& entry : fs::recursive_directory_iterator(output()))
        EXPECT_EQ(entry.path().string().find("partial"), std::string::npos) << entry.path();
}

TEST_F(Compare, TwoProgramsDoNotShareAnOutputFolder) {
    const std::string input = clip("clip", 3);
    fs::create_directory(output());
    const int fd = open(output().c_str(), O_RDONLY | O_DIRECTORY);
    ASSERT_EQ(flock(fd, LOCK_EX), 0);
    expectError(run({input}, {"--methods", "roevo-ct"}), 1, kName, {"another roevo-compare", output()});
    EXPECT_EQ(run({input}, {"--methods", "roevo-ct", "--rows-only"}).exit_code, 0) << "they may make rows";
    close(fd);
}

TEST_F(Compare, AReportOfRowsIsThatOfTheirRuns) {
    const std::string input = clip("clip", 5);
    const auto whole = run({input}, {"--methods", "roevo-ct,distance-field"});
    ASSERT_EQ(whole.exit_code, 0) << whole.all();
    const std::string report = folder / "report";
    const auto again = test::runProgram(kName, {"--report", output() + "/runs", "--output", report});
    ASSERT_EQ(again.exit_code, 0) << again.all();
    EXPECT_EQ(readFile(report + "/table.csv"), table());
    const std::string one = readFile(output() + "/report.html"), other = readFile(report + "/report.html");
    EXPECT_EQ(std::count(one.begin(), one.end(), '<'), std::count(other.begin(), other.end(), '<'));
    EXPECT_NE(other.find("<svg class=\"plot\""), std::string::npos);
    const auto compared = test::runProgram(kName, {"--report", output() + "/runs", "--baseline",
                                                   output() + "/runs", "--output", report, "--quiet"});
    ASSERT_EQ(compared.exit_code, 0) << compared.all();
    EXPECT_NE(readFile(report + "/report.html").find("Against the earlier comparison"), std::string::npos);
}

TEST_F(Compare, RowsAreMadeEvenOfARecordingThatCannotBeUsed) {
    fs::create_directories(folder / "broken");
    const std::vector<std::string> more{"--methods", "roevo-ct", "--rows-only", "--variant", "thin",
                                        "--key",     "k1",       "--name",      "other",     "--paper-ate",
                                        "1.5",       "--note",   "mind this",   "--quiet"};
    for (const std::string& input : {folder / "broken", folder / "none.rawlog"}) {
        const auto result = run({input}, more);
        ASSERT_EQ(result.exit_code, 0) << result.all();
        EXPECT_NE(kept("other", "roevo-ct@thin").failure, "");
        EXPECT_EQ(kept("other", "roevo-ct@thin").key, "k1");
        EXPECT_FALSE(fs::exists(output() + "/table.csv"));
    }
    const auto good = run({clip("clip", 4)}, more);
    ASSERT_EQ(good.exit_code, 0) << good.all();
    const SequenceComparison row = readRow(runFolder("other", "roevo-ct@thin"));
    EXPECT_EQ(row.runs[0].label.find("ROEVO CT"), 0u);
    EXPECT_NE(row.runs[0].label.find("(thin)"), std::string::npos);
    EXPECT_EQ(row.paper_ate_cm, 1.5);
    EXPECT_EQ(row.notes.at(0), "mind this");
}

}  // namespace
}  // namespace roevo
