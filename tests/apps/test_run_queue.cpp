// Runs in processes of their own: how they end, what is kept of them, and what an interrupt leaves. The
// programs are shell scripts here.
#include <gtest/gtest.h>

#include <algorithm>
#include <csignal>
#include <filesystem>
#include <set>

#include "compare_fakes.h"
#include "processes.h"
#include "programs/interrupt.h"
#include "roevo-compare/core_contention.h"
#include "roevo-compare/kept_run.h"
#include "roevo-compare/run_queue.h"
#include "support/run_program.h"

namespace roevo {
namespace {

namespace fs = std::filesystem;
using test::readFile;
using test::runs;
using test::shell;
using test::soon;
using test::TemporaryFolder;
using test::writeFile;

constexpr double kLong = 60;  // s

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
    void runAll(const std::vector<std::string>& scripts, double timeout = kLong, std::size_t jobs = 1,
                int core = -1) {
        std::vector<RunTask> tasks;
        for (std::size_t i = 0; i < scripts.size(); ++i) tasks.push_back(task("m" + std::to_string(i)));
        const auto command = [&](const RunTask& task, const std::string& run_folder) {
            const auto index = static_cast<std::size_t>(&task - tasks.data());
            return shell("RUN='" + run_folder + "'; " + scripts[index]);
        };
        runTasks(tasks, command, {std::vector<int>(jobs, core), timeout}, *this);
    }

    // A script that leaves this run in its folder.
    std::string leave(const std::string& name, const MethodRun& run) {
        const fs::path made = folder.path() / name;
        fs::create_directory(made);
        writeMethodRun(made.string(), run);
        return "cp " + made.string() + "/* \"$RUN\"";
    }

    // A script that leaves a good result.
    std::string success(double core_lost = 0) {
        MethodRun run;
        run.method = "whatever";
        run.frames = run.tracked = 3;
        run.core_lost = core_lost;
        for (int i = 0; i < 3; ++i) run.trajectory.push_back({1.0 + i, Pose::Identity()});
        return leave("made", run);
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
    expect(failure("echo 12 0.5 > \"$RUN\"/progress.txt; echo stack smashed >&2; kill -SEGV $$"),
           {"signal 11", "Segmentation fault", "after 12 frames", "stack smashed"});
    EXPECT_EQ(done.at(0).frames, 12u);
    expect(failure("kill -KILL $$"), {"signal 9", "memory", "after 0 frames"});
    expect(failure("echo 34 0.7 > \"$RUN\"/progress.txt; sleep 100", 0.5),
           {"not done within 0.5 s", "after 34 frames"});
    expect(failure("echo 5 0.5 > \"$RUN\"/progress.txt; exit 7"),
           {"exit code 7", "5 frames", "without a word"});
    expect(failure("echo 'roevo-compare: error: no such file' >&2; exit 1"),
           {"exit code 1", "its last words: no such file"});
    expect(failure("exit 0"), {"no result", "run.json"});
    expect(failure("echo '{' > \"$RUN\"/run.json"), {"no result", "not whole"});
    expect(failure("rm -rf \"$RUN\"; exit 1"), {"exit code 1"});
}

TEST_F(Queue, WhatARunSaysOfItsOwnFailureCountsAndNotWhatIsPrinted) {
    MethodRun run;
    run.method = "whatever";
    run.failure = "at frame 3: no depth";
    const std::string script = leave("failed", run) + "; echo 2 0.2 > \"$RUN\"/progress.txt; " +
                               "echo 77 0.77; echo library: all is well; echo library: noise >&2; ";
    for (const char* end : {"exit 1", "exit 0"}) {
        EXPECT_EQ(failure(script + end), "at frame 3: no depth") << end;
        EXPECT_EQ(done.at(0).frames, 2u);
    }
    EXPECT_NE(failure(script + "kill -SEGV $$").find("signal 11"), std::string::npos);
    EXPECT_NE(failure(success() + "; exit 3").find("exit code 3"), std::string::npos)
        << "a result of a program that failed is none";
}

TEST_F(Queue, WhatLibrariesPrintIsNoProgress) {
    std::set<double> shares;
    while_going = [&](const std::map<std::size_t, double>& running) {
        for (const auto& [index, share] : running) shares.insert(share);
    };
    runAll({"echo 1 0.75; echo '  3   -7' > \"$RUN\"/progress.txt; sleep 0.5; " + success()});
    EXPECT_EQ(shares, std::set<double>{0});
    EXPECT_FALSE(fs::exists(task("m0").folder + "/progress.txt")) << "it is of no use any more";
}

TEST_F(Queue, WhetherARunWasBoundToItsCoreIsKept) {
    const auto notPinned = [&](int core) {
        runAll({success()}, kLong, 1, core);
        const MethodRun kept = readMethodRun(task("m0").folder);
        EXPECT_TRUE(kept.ok()) << kept.failure;
        return kept.not_pinned;
    };
    EXPECT_EQ(notPinned(allowedCores().back()), "");
    EXPECT_NE(notPinned(CPU_SETSIZE - 1).find("core 1023"), std::string::npos);
    EXPECT_NE(notPinned(-1), "");
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
    runAll({"echo 1 0.25 > \"$RUN\"/progress.txt; while [ ! -e " + (folder / "seen") +
            " ]; do sleep 0.02; done; " + success()},
           0.6);
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

TEST_F(Queue, KeptRunsAreFoundAgainByTheirSettings) {
    const auto found = [&](const RunTask& task) { return findKeptRun(task, kLong).run.has_value(); };
    EXPECT_FALSE(found(task("m0"))) << "there is none yet";
    runAll({success()});
    const KeptRun kept = findKeptRun(task("m0"), kLong);
    ASSERT_TRUE(kept.run);
    EXPECT_EQ(kept.redo, "");
    EXPECT_EQ(kept.run->trajectory.size(), 3u);
    RunTask other = task("m0");
    other.settings["first"] = "9";
    EXPECT_FALSE(found(other));
    other = task("m0");
    other.settings["more"] = "";
    EXPECT_FALSE(found(other));
    fs::remove(task("m0").folder + "/trajectory.txt");
    EXPECT_FALSE(found(task("m0"))) << "it is not whole any more";
}

TEST_F(Queue, AMethodsOwnFailureIsKeptAndWhatCameFromOutsideIsMadeAnew) {
    const auto redo = [&](double timeout) {
        const KeptRun kept = findKeptRun(task("m0"), timeout);
        EXPECT_TRUE(kept.run) << "it stands until there is another one";
        return kept.redo;
    };
    for (const char* own : {"exit 1", "kill -SEGV $$", "kill -ABRT $$", "kill -FPE $$"}) {
        failure(own);
        EXPECT_EQ(redo(kLong), "") << own;
    }
    for (const auto& [name, number] : {std::pair("HUP", "1"), {"INT", "2"}, {"KILL", "9"}, {"TERM", "15"}}) {
        failure(std::string("kill -") + name + " $$");
        EXPECT_EQ(redo(kLong), "it was killed (signal " + std::string(number) + ")");
    }
    failure("sleep 100", 0.3);
    EXPECT_EQ(redo(0.3), "") << "no more time than it had";
    EXPECT_EQ(redo(0.2), "");
    EXPECT_NE(redo(0.5), "");
}

TEST_F(Queue, RunsWhoseCoreOthersHadAreMadeAnew) {
    runAll({success(0.04)});
    EXPECT_EQ(findKeptRun(task("m0"), kLong).redo, "");
    runAll({success(0.12)});
    EXPECT_EQ(findKeptRun(task("m0"), kLong).redo, "other programs had its core for 12 % of the time");
}

TEST_F(Queue, ARunThatCannotBeKeptIsAnError) {
    fs::create_directories(folder / "runs");
    writeFile(folder / "runs/clip", "a file is in the way");
    EXPECT_THROW(runAll({success()}), std::runtime_error);
}

}  // namespace
}  // namespace roevo
