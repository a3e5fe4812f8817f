// roevo-compare that is interrupted, killed, or run again: what stays and what is made anew.
#include <gtest/gtest.h>
#include <sys/file.h>

#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <optional>
#include <set>

#include "compare_program.h"
#include "processes.h"

namespace roevo {
namespace {

namespace fs = std::filesystem;
using test::expectError;
using test::readFile;
using test::slidingRecording;
using test::writeFile;
using test::writeTumFolder;

constexpr char kName[] = "roevo-compare";

using CompareAgain = test::CompareProgram;

TEST_F(CompareAgain, ResumeTakesFinishedRunsAgainUnlessSomethingChanged) {
    const std::string input = clip("clip", 6);
    const std::vector<std::string> methods{"--methods", "roevo-ct,roevo-tr"};
    const auto with = [&](std::vector<std::string> more) {
        more.insert(more.end(), methods.begin(), methods.end());
        const auto result = run({input}, more);
        EXPECT_EQ(result.exit_code, 0) << result.all();
        pretendACalmMachine();
        return result;
    };
    with({});
    auto ct = madeAt("clip", "roevo-ct");
    const std::string rows = table();
    const auto resumed = with({"--resume"});
    EXPECT_EQ(madeAt("clip", "roevo-ct"), ct);
    EXPECT_NE(resumed.err.find("2 of 2 runs are there already"), std::string::npos) << resumed.err;
    EXPECT_EQ(table(), rows);

    const auto expectMadeAgain = [&](const std::vector<std::string>& more, const char* why) {
        with(more);
        EXPECT_NE(madeAt("clip", "roevo-ct"), ct) << why;
        ct = madeAt("clip", "roevo-ct");
    };
    expectMadeAgain({"--resume", "--set", "edges.min_length=15"}, "an option has changed");
    expectMadeAgain({"--resume", "--skip", "1", "--first", "5"}, "other frames");
    writeTumFolder(input, slidingRecording(7));
    expectMadeAgain({"--resume", "--skip", "1", "--first", "5"}, "another recording");

    // One that is not whole is made again, alone
    fs::remove(runFolder("clip", "roevo-tr") + "/trajectory.txt");
    const auto repaired = with({"--resume", "--skip", "1", "--first", "5"});
    EXPECT_EQ(madeAt("clip", "roevo-ct"), ct);
    EXPECT_NE(repaired.err.find("1 of 2 runs are there already"), std::string::npos) << repaired.err;
    EXPECT_TRUE(kept("clip", "roevo-tr").ok());
}

TEST_F(CompareAgain, TwoProgramsDoNotShareAnOutputFolder) {
    const std::string input = clip("clip", 3);
    fs::create_directory(output());
    const int fd = open(output().c_str(), O_RDONLY | O_DIRECTORY);
    ASSERT_EQ(flock(fd, LOCK_EX), 0);
    expectError(run({input}, {"--methods", "roevo-ct"}), 1, kName, {"another roevo-compare", output()});
    close(fd);
    EXPECT_EQ(run({input}, {"--methods", "roevo-ct"}).exit_code, 0);
}

TEST_F(CompareAgain, AMethodThatCrashesIsARowAndTheNextOneRuns) {
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
    EXPECT_NE(readFile(output() + "/table.md").find("signal 11"), std::string::npos);
}

// Interrupts the program as soon as the first run is there. The second takes long enough for that.
TEST_F(CompareAgain, AnInterruptLeavesWhatIsFinishedAndResumeGoesOn) {
    const std::string quick = clip("quick", 3), slow = clip("slow", 80);
    const std::string first = runFolder("quick", "roevo-tr") + "/run.json";
    const auto result = runMeanwhile(arguments({quick, slow}, {"--methods", "roevo-tr"}), [&](pid_t program) {
        for (int i = 0; i < 6000 && !fs::exists(first); ++i) usleep(5'000);
        kill(program, SIGINT);
    });
    expectError(result, 1, kName, {"interrupted", "1 run is still to be made", "--resume"});
    expectRow("quick,roevo-tr,");
    expectRow("slow,roevo-tr,");
    EXPECT_NE(readFile(output() + "/table.csv").find("not run: the comparison was ended before"),
              std::string::npos);
    EXPECT_NE(result.out.find(" not run"), std::string::npos) << result.out;
    EXPECT_NE(readFile(output() + "/table.md").find("interrupted"), std::string::npos);
    EXPECT_FALSE(fs::exists(runFolder("slow", "roevo-tr")));
    for (const auto& entry : fs::recursive_directory_iterator(output()))
        EXPECT_EQ(entry.path().string().find("partial"), std::string::npos) << entry.path();

    pretendACalmMachine();
    const auto time = madeAt("quick", "roevo-tr");
    const auto resumed = run({quick, slow}, {"--methods", "roevo-tr", "--resume"});
    ASSERT_EQ(resumed.exit_code, 0) << resumed.all();
    EXPECT_EQ(madeAt("quick", "roevo-tr"), time);
    expectRow("quick,roevo-tr,");
    expectRow("slow,roevo-tr,");
}

TEST_F(CompareAgain, RunsThatWereDisturbedOrKilledAreMadeAnewAndFailuresStay) {
    const std::string input = clip("clip", 5);
    ASSERT_EQ(run({input}, {"--methods", "roevo-ct,roevo-tr,roevo-ba"}).exit_code, 0);
    pretendACalmMachine();
    changeRun("clip", "roevo-ct", [](MethodRun& run) {
        run.core_lost = 0.5;
        run.memory_peak_mb = 1e6;
    });
    const auto failed = [](int signal) {
        return [signal](MethodRun& run) {
            run.failure = "it died";
            run.trajectory.clear();
            run.signal = signal;
        };
    };
    changeRun("clip", "roevo-tr", failed(SIGKILL));
    changeRun("clip", "roevo-ba", failed(SIGSEGV));
    const auto result = run({input}, {"--methods", "roevo-ct,roevo-tr,roevo-ba", "--resume"});
    ASSERT_EQ(result.exit_code, 0) << result.all();
    EXPECT_NE(result.err.find("clip, roevo-ct: is made anew: other programs had its core for 50 %"),
              std::string::npos)
        << result.err;
    EXPECT_NE(result.err.find("clip, roevo-tr: is made anew: it was killed (signal 9)"), std::string::npos);
    EXPECT_NE(result.err.find("clip, roevo-ba: kept as it is, FAILED: it died"), std::string::npos);
    EXPECT_NE(result.err.find("1 of 3 runs are there already"), std::string::npos) << result.err;
    EXPECT_LT(kept("clip", "roevo-ct").memory_peak_mb, 1e6);
    EXPECT_TRUE(kept("clip", "roevo-tr").ok());
    EXPECT_EQ(kept("clip", "roevo-ba").failure, "it died");
}

TEST_F(CompareAgain, WhatIsToBeMadeAnewIsNotLostByAnInterrupt) {
    const std::string slow = clip("slow", 80), partial = output() + "/runs/slow/.roevo-tr.partial";
    ASSERT_EQ(run({slow}, {"--methods", "roevo-tr"}).exit_code, 0);
    changeRun("slow", "roevo-tr", [](MethodRun& run) { run.core_lost = 0.5; });
    const auto result =
        runMeanwhile(arguments({slow}, {"--methods", "roevo-tr", "--resume"}), [&](pid_t program) {
            for (int i = 0; i < 6000 && !fs::exists(partial); ++i) usleep(2'000);
            kill(program, SIGINT);
        });
    expectError(result, 1, kName, {"interrupted", "1 run is still to be made"});
    expectRow("slow,roevo-tr,ROEVO TR,ok,");
    EXPECT_TRUE(kept("slow", "roevo-tr").ok());
}

// A report that is being written, with a gnuplot that does not come to an end.
class CompareReportIsInterrupted : public CompareAgain, public testing::WithParamInterface<int> {
  protected:
    CompareReportIsInterrupted() {
        for (const char* name : {"bin", "tmp"}) fs::create_directory(folder / name);
        writeFile(folder / "bin/gnuplot", "#!/bin/sh\necho $$ > " + (folder / "drawing") + "\nsleep 100\n");
        fs::permissions(folder / "bin/gnuplot", fs::perms::owner_all);
        setenv("PATH", (folder / "bin:" + path_).c_str(), 1);
        setenv("TMPDIR", (folder / "tmp").c_str(), 1);
    }
    ~CompareReportIsInterrupted() override {
        setenv("PATH", path_.c_str(), 1);
        tmp_ ? setenv("TMPDIR", tmp_->c_str(), 1) : unsetenv("TMPDIR");
    }

    const std::string path_ = std::getenv("PATH");
    const std::optional<std::string> tmp_ =
        std::getenv("TMPDIR") ? std::optional<std::string>(std::getenv("TMPDIR")) : std::nullopt;
};

TEST_P(CompareReportIsInterrupted, AndNothingIsLeftBehind) {
    const std::string input = clip("clip", 4);
    fs::create_directory(output());
    writeFile(output() + "/table.csv", "of an earlier comparison");
    const auto result =
        runMeanwhile(arguments({input}, {"--methods", "roevo-ct", "--quiet"}), [&](pid_t program) {
            for (int i = 0; i < 6000 && readFile(folder / "drawing").empty(); ++i) usleep(5'000);
            kill(program, GetParam());
        });
    expectError(result, 1, kName, {"interrupted while the report", "--resume"});
    EXPECT_TRUE(fs::is_empty(folder / "tmp"));
    std::set<std::string> files;
    for (const auto& entry : fs::directory_iterator(output())) files.insert(entry.path().filename().string());
    EXPECT_EQ(files, (std::set<std::string>{"config_used.ini", "runs", "table.csv"}));
    EXPECT_EQ(table(), "of an earlier comparison") << "all three files or none";
    const pid_t gnuplot = std::stoi(readFile(folder / "drawing"));
    EXPECT_TRUE(test::soon([&] { return !test::runs(gnuplot); }));

    setenv("PATH", path_.c_str(), 1);
    EXPECT_EQ(run({input}, {"--methods", "roevo-ct", "--resume"}).exit_code, 0);
    expectRow("clip,roevo-ct,");
}

INSTANTIATE_TEST_SUITE_P(, CompareReportIsInterrupted, testing::Values(SIGINT, SIGTERM, SIGHUP),
                         [](const auto& info) {
                             return info.param == SIGINT    ? "SIGINT"
                                    : info.param == SIGTERM ? "SIGTERM"
                                                            : "SIGHUP";
                         });

}  // namespace
}  // namespace roevo
