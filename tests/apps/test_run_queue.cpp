// Runs in processes of their own: how they end, what is kept of them, and what an interrupt leaves. The
// programs are shell scripts here.
#include <gtest/gtest.h>

#include <algorithm>
#include <csignal>
#include <filesystem>
#include <set>

#include "compare_fakes.h"
#include "roevo-compare/core_contention.h"
#include "roevo-compare/run_queue.h"
#include "support/interrupt.h"
#include "support/run_program.h"

namespace roevo {
namespace {

namespace fs = std::filesystem;
using test::readFile;
using test::TemporaryFolder;
using test::writeFile;

constexpr double kLong = 60;  // s

// Runs until its end. @return how long that took, s
double finish(ChildProcess& process) {
    while (process.update()) ChildProcess::waitForNews({&process}, 0.1);
    return process.seconds();
}

std::vector<std::string> shell(const std::string& script) {
    return {"/bin/sh", "-c", script};
}

bool runs(pid_t id) {
    const std::string status = readFile("/proc/" + std::to_string(id) + "/stat");
    return !status.empty() && status.find(") Z ") == std::string::npos;  // a dead one may not be reaped yet
}

// Waits for what happens soon.
template <class Condition>
bool soon(const Condition& condition) {
    for (int i = 0; i < 500 && !condition(); ++i) usleep(10'000);
    return condition();
}

TEST(Process, SaysHowItEnded) {
    ChildProcess good(shell("echo one; echo; echo two >&2; printf three"), -1, kLong);
    finish(good);
    EXPECT_TRUE(good.end().ok());
    EXPECT_EQ(good.lastOutput(), "three") << "even without an end of line";
    EXPECT_EQ(good.lastError(), "two");

    ChildProcess bad(shell("exit 3"), -1, kLong);
    finish(bad);
    EXPECT_EQ(bad.end().exit_code, 3);
    EXPECT_FALSE(bad.end().ok());

    ChildProcess crashed(shell("kill -SEGV $$"), -1, kLong);
    finish(crashed);
    EXPECT_EQ(crashed.end().signal, SIGSEGV);
    EXPECT_FALSE(crashed.end().ok());
}

TEST(Process, ProgramThatIsNotThere) {
    ChildProcess process({"/no/such/program"}, -1, kLong);
    finish(process);
    EXPECT_FALSE(process.end().ok());
    EXPECT_NE(process.lastError().find("cannot be started: No such file"), std::string::npos)
        << process.lastError();
}

TEST(Process, OutputLongerThanAPipeDoesNotStopIt) {
    ChildProcess process(shell("i=0; while [ $i -lt 40000 ]; do echo line $i; i=$((i+1)); done"), -1, kLong);
    finish(process);
    EXPECT_TRUE(process.end().ok());
    EXPECT_EQ(process.lastOutput(), "line 39999");
}

TEST(Process, IsEndedWithItsOwnChildrenWhenItsTimeIsUp) {
    const TemporaryFolder folder;
    ChildProcess process(shell("sleep 100 & echo $! > " + (folder / "pid") + "; echo ready; wait"), -1, 1);
    EXPECT_LT(finish(process), kLong / 2);
    EXPECT_TRUE(process.end().timed_out);
    EXPECT_FALSE(process.end().ok());
    EXPECT_EQ(process.lastOutput(), "ready");
    const pid_t grandchild = std::stoi(readFile(folder / "pid"));
    EXPECT_TRUE(soon([&] { return !runs(grandchild); }));
}

TEST(Process, EndsWithItsObject) {
    const TemporaryFolder folder;
    pid_t child = 0;
    {
        ChildProcess process(shell("echo ready; sleep 100"), -1, kLong);
        child = process.id();
        ASSERT_TRUE(soon([&] { return process.update() && process.lastOutput() == "ready"; }));
        EXPECT_TRUE(runs(child));
    }
    EXPECT_TRUE(soon([&] { return !runs(child); }));
}

TEST(Process, StaysOnItsCoreAndAwayFromCtrlC) {
    const int core = allowedCores().back();
    ChildProcess process(shell("grep Cpus_allowed_list /proc/self/status; ps -o pgid= -p $$ >&2 || true"),
                         core, kLong);
    finish(process);
    EXPECT_NE(process.lastOutput().find("\t" + std::to_string(core)), std::string::npos)
        << process.lastOutput();
    EXPECT_EQ(process.lastOutput().find_first_of(",-"), std::string::npos) << process.lastOutput();
    ChildProcess sleeper(shell("sleep 100"), -1, kLong);
    EXPECT_EQ(getpgid(sleeper.id()), sleeper.id());
    EXPECT_NE(getpgid(sleeper.id()), getpgid(0));
}

TEST(Contention, WaitingForOtherProgramsIsSeen) {
    if (!fs::exists("/proc/thread-self/schedstat")) GTEST_SKIP() << "the system does not tell";
    const int core = allowedCores().back();
    cpu_set_t before, only;
    ASSERT_EQ(sched_getaffinity(0, sizeof before, &before), 0);
    CPU_ZERO(&only);
    CPU_SET(static_cast<std::size_t>(core), &only);
    ASSERT_EQ(sched_setaffinity(0, sizeof only, &only), 0);
    {
        ChildProcess rival(shell("while :; do :; done"), core, kLong);
        const CoreContention contention;
        test::work(400);
        EXPECT_GT(contention.shareLost(), 0.2) << "two want one core";
        EXPECT_LE(contention.shareLost(), 1);
    }
    sched_setaffinity(0, sizeof before, &before);
}

class Queue : public testing::Test, public QueueObserver {
  protected:
    RunTask task(const std::string& name) const {
        RunTask task;
        task.sequence = "clip";
        task.input = "clip.rawlog";
        task.method.name = name;
        task.method.label = "Label of " + name;
        task.folder = folder / ("runs/clip/" + name);
        task.settings = {{"first", "0"}};
        return task;
    }

    void finished(std::size_t task, const MethodRun& run, double) override { done[task] = run; }
    void going(const std::map<std::size_t, double>& running) override {
        if (while_going) while_going(running);
    }

    // Runs scripts, one for each task; $RUN is the folder for the result.
    void runAll(const std::vector<std::string>& scripts, double timeout = kLong, std::size_t jobs = 1) {
        std::vector<RunTask> tasks;
        for (std::size_t i = 0; i < scripts.size(); ++i) tasks.push_back(task("m" + std::to_string(i)));
        const auto command = [&](const RunTask& task, const std::string& run_folder) {
            const auto index = static_cast<std::size_t>(&task - tasks.data());
            return shell("RUN='" + run_folder + "'; " + scripts[index]);
        };
        runTasks(tasks, command, {std::vector<int>(jobs, -1), timeout}, *this);
    }

    // A script that leaves a good result.
    std::string success() {
        const fs::path made = folder.path() / "made";
        if (!fs::exists(made)) {
            fs::create_directory(made);
            MethodRun run;
            run.method = "whatever";
            run.frames = run.tracked = 3;
            for (int i = 0; i < 3; ++i) run.trajectory.push_back({1.0 + i, Pose::Identity()});
            writeMethodRun(made.string(), run);
        }
        return "cp " + made.string() + "/* \"$RUN\"";
    }

    std::string failure(const std::string& script, double timeout = kLong) {
        done.clear();
        runAll({script}, timeout);
        const MethodRun kept = readMethodRun(task("m0").folder);
        EXPECT_EQ(kept.failure, done.at(0).failure) << "what is kept is what is said";
        return kept.failure;
    }

    const InterruptGuard guard;
    TemporaryFolder folder;
    std::map<std::size_t, MethodRun> done;
    std::function<void(const std::map<std::size_t, double>&)> while_going;
};

TEST_F(Queue, AGoodRunIsKeptWithWhatItWasMadeFrom) {
    runAll({success()});
    const MethodRun kept = readMethodRun(task("m0").folder);
    EXPECT_TRUE(kept.ok());
    EXPECT_EQ(kept.method, "m0");
    EXPECT_EQ(kept.label, "Label of m0");
    EXPECT_EQ(kept.input, "clip.rawlog");
    EXPECT_EQ(kept.settings, task("m0").settings);
    EXPECT_EQ(kept.trajectory.size(), 3u);
    EXPECT_EQ(kept.jobs, 1u);
    EXPECT_EQ(done.at(0).trajectory.size(), 3u);
}

TEST_F(Queue, ANewRunTakesThePlaceOfTheOldOne) {
    failure("exit 1");
    writeFile(task("m0").folder + "/old", "");
    runAll({success()});
    EXPECT_TRUE(readMethodRun(task("m0").folder).ok());
    EXPECT_FALSE(fs::exists(task("m0").folder + "/old"));
    std::size_t entries = 0;
    for ([[maybe_unused]] const auto& entry : fs::directory_iterator(folder / "runs/clip")) ++entries;
    EXPECT_EQ(entries, 1u);
}

TEST_F(Queue, FailuresAreKeptInWords) {
    const auto expect = [](const std::string& text, const std::vector<std::string>& words) {
        for (const std::string& word : words)
            EXPECT_NE(text.find(word), std::string::npos) << word << " in: " << text;
        EXPECT_EQ(text.find('\n'), std::string::npos);
    };
    expect(failure("echo 12 0.5; echo stack smashed >&2; kill -SEGV $$"),
           {"signal 11", "Segmentation fault", "after 12 frames", "stack smashed"});
    EXPECT_EQ(done.at(0).frames, 12u);
    expect(failure("kill -KILL $$"), {"signal 9", "memory", "after 0 frames"});
    expect(failure("echo 1 0.1; echo 34 0.7; sleep 100", 0.5), {"not done within 0.5 s", "after 34 frames"});
    EXPECT_EQ(failure("echo noise >&2; echo 'roevo-compare: error: at frame 3: no depth' >&2; exit 1"),
              "at frame 3: no depth");
    expect(failure("echo 5 0.5; exit 7"), {"exit code 7", "5 frames", "without a word"});
    expect(failure("exit 0"), {"no result", "run.json"});
    expect(failure("echo '{' > \"$RUN\"/run.json"), {"no result", "not whole"});
    expect(failure("rm -rf \"$RUN\"; exit 1"), {"exit code 1"});
}

TEST_F(Queue, NothingOfAFailedRunIsTakenForAResult) {
    failure("echo x > \"$RUN\"/frames.csv; echo y > \"$RUN\"/trajectory.txt; kill -ABRT $$");
    std::set<std::string> files;
    for (const auto& entry : fs::directory_iterator(task("m0").folder))
        files.insert(entry.path().filename().string());
    EXPECT_EQ(files, std::set<std::string>{"run.json"});
}

TEST_F(Queue, AFailureDoesNotKeepTheOthersFromRunning) {
    runAll({success(), "kill -SEGV $$", success(), "exit 1"});
    ASSERT_EQ(done.size(), 4u);
    EXPECT_TRUE(done[0].ok());
    EXPECT_FALSE(done[1].ok());
    EXPECT_TRUE(done[2].ok());
    EXPECT_FALSE(done[3].ok());
}

TEST_F(Queue, JobsRunSideBySide) {
    // Each waits for the other to have come so far; one after the other they would wait in vain
    const auto meet = [&](const std::string& mine, const std::string& other) {
        return "touch " + (folder / mine) + "; while [ ! -e " + (folder / other) +
               " ]; do sleep 0.02; done; " + success();
    };
    const std::vector<std::string> scripts{meet("a", "b"), meet("b", "a"), success()};
    std::size_t most = 0;
    while_going = [&](const std::map<std::size_t, double>& running) {
        most = std::max(most, running.size());
    };
    runAll(scripts, 20, 2);
    ASSERT_EQ(done.size(), 3u);
    for (const auto& [index, run] : done) EXPECT_TRUE(run.ok()) << index << run.failure;
    EXPECT_EQ(most, 2u) << "never more than there are cores for";
    EXPECT_EQ(done[0].jobs, 2u);
}

TEST_F(Queue, TellsHowFarTheRunsAre) {
    std::set<double> shares;
    while_going = [&](const std::map<std::size_t, double>& running) {
        for (const auto& [index, share] : running) shares.insert(share);
    };
    runAll({"echo 1 0.25; while [ ! -e " + (folder / "seen") + " ]; do sleep 0.02; done; " + success()}, 0.6);
    EXPECT_TRUE(shares.count(0.25)) << shares.size();
}

TEST_F(Queue, AnInterruptEndsAllAndLosesNothing) {
    runAll({success()});
    ASSERT_TRUE(readMethodRun(task("m0").folder).ok());
    const auto time = fs::last_write_time(task("m0").folder + "/run.json");

    const std::string script =
        "echo $$ > " + (folder / "pid") + "; echo half > \"$RUN\"/frames.csv; sleep 100";
    while_going = [&](const auto&) {
        if (fs::exists(folder / "pid") && !readFile(folder / "pid").empty()) raise(SIGINT);
    };
    EXPECT_THROW(runAll({script}), Interrupted);
    EXPECT_TRUE(soon([&] { return !runs(std::stoi(readFile(folder / "pid"))); }));
    EXPECT_EQ(fs::last_write_time(task("m0").folder + "/run.json"), time) << "the earlier run is still there";
    std::size_t entries = 0;
    for ([[maybe_unused]] const auto& entry : fs::directory_iterator(folder / "runs/clip")) ++entries;
    EXPECT_EQ(entries, 1u) << "a half-made run was left";
}

TEST_F(Queue, WhatAKilledProgramLeftIsNoHindrance) {
    fs::create_directories(folder / "runs/clip/.m0.partial/deep");
    runAll({"[ ! -e \"$RUN\"/deep ] && " + success()});
    EXPECT_TRUE(done.at(0).ok()) << done.at(0).failure;
}

TEST_F(Queue, FinishedRunsAreFoundAgainByTheirSettings) {
    MethodRun found;
    EXPECT_FALSE(findFinishedRun(task("m0"), kLong, found)) << "there is none yet";
    runAll({success()});
    ASSERT_TRUE(findFinishedRun(task("m0"), kLong, found));
    EXPECT_EQ(found.trajectory.size(), 3u);
    RunTask other = task("m0");
    other.settings["first"] = "9";
    EXPECT_FALSE(findFinishedRun(other, kLong, found));
    other = task("m0");
    other.settings["more"] = "";
    EXPECT_FALSE(findFinishedRun(other, kLong, found));
    fs::remove(task("m0").folder + "/trajectory.txt");
    EXPECT_FALSE(findFinishedRun(task("m0"), kLong, found)) << "it is not whole any more";
}

TEST_F(Queue, FailedRunsAreFoundAgainUnlessTheyAreGivenMoreTime) {
    MethodRun found;
    failure("exit 1");
    EXPECT_TRUE(findFinishedRun(task("m0"), kLong, found));
    EXPECT_FALSE(found.ok());
    failure("sleep 100", 0.3);
    EXPECT_TRUE(findFinishedRun(task("m0"), 0.3, found));
    EXPECT_EQ(found.settings, task("m0").settings);
    EXPECT_TRUE(findFinishedRun(task("m0"), 0.2, found));
    EXPECT_FALSE(findFinishedRun(task("m0"), 0.5, found));
}

TEST_F(Queue, ARunThatCannotBeKeptIsAnError) {
    fs::create_directories(folder / "runs");
    writeFile(folder / "runs/clip", "a file is in the way");
    EXPECT_THROW(runAll({success()}), std::runtime_error);
}

}  // namespace
}  // namespace roevo
