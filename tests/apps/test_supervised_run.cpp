// Runs in processes of their own: how they end, what is kept of them, and what an interrupt leaves. The
// programs are shell scripts here.
#include <gtest/gtest.h>

#include <csignal>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <set>

#include "compare_fakes.h"
#include "processes.h"
#include "programs/interrupt.h"
#include "programs/process.h"
#include "roevo-compare/core_claim.h"
#include "roevo-compare/core_contention.h"
#include "roevo-compare/rows.h"
#include "roevo-compare/supervised_run.h"
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

constexpr double kLongTimeout = 60;  // s

TEST(Contention, WaitingForOtherProgramsIsSeen) {
    if (!fs::exists("/proc/thread-self/schedstat")) GTEST_SKIP() << "the system does not tell";
    const int core = allowedCores().back();
    cpu_set_t before, only;
    ASSERT_EQ(sched_getaffinity(0, sizeof before, &before), 0);
    CPU_ZERO(&only);
    CPU_SET(static_cast<std::size_t>(core), &only);
    ASSERT_EQ(sched_setaffinity(0, sizeof only, &only), 0);
    {
        ChildProcess rival(shell("while :; do :; done"), core, kLongTimeout);
        const CoreContention contention;
        test::work(400);
        EXPECT_GT(contention.shareLost(), 0.2) << "two want one core";
        EXPECT_LE(contention.shareLost(), 1);
    }
    sched_setaffinity(0, sizeof before, &before);
}

// Other tests may have runs at the same time: they only take cores away.
TEST(CoreClaims, NoTwoAreOfOneCoreAndTheyComeFreeAgain) {
    std::set<int> taken;
    std::vector<std::unique_ptr<CoreClaim>> claims;
    for (std::size_t i = 0; i <= allowedCores().size(); ++i) {
        claims.push_back(std::make_unique<CoreClaim>());
        const CoreClaim& claim = *claims.back();
        EXPECT_EQ(claim.fault().empty(), claim.core() >= 0);
        if (claim.core() >= 0) {
            EXPECT_TRUE(taken.insert(claim.core()).second);
        }
    }
    EXPECT_EQ(claims.back()->core(), -1) << "more than there are";
    claims.clear();
    EXPECT_TRUE(soon([] { return CoreClaim().core() >= 0; }));
}

class Supervised : public testing::Test {
  protected:
    RunTask task(double timeout = kLongTimeout) const {
        RunTask task;
        task.sequence = "clip";
        task.input = "clip.rawlog";
        task.method.name = "m";
        task.method.label = "Label of m";
        task.folder = folder / "runs/clip/m";
        task.timeout_s = timeout;
        task.key = "k";
        return task;
    }

    // Runs a script; $RUN is the folder for the result.
    MethodRun make(const std::string& script, double timeout = kLongTimeout) const {
        const auto command = [&](const std::string& partial) {
            return shell("RUN='" + partial + "'; " + script);
        };
        const SequenceComparison row = supervisedRun(task(timeout), command, going);
        EXPECT_EQ(row.name, "clip");
        return row.runs.at(0);
    }
    MethodRun kept() const { return readRow(task().folder).runs[0]; }

    // A script that leaves this run in its folder.
    std::string leave(const std::string& name, const MethodRun& run) const {
        const fs::path made = folder.path() / name;
        fs::create_directory(made);
        SequenceComparison row;
        row.name = "clip";
        row.runs = {run};
        writeRow(made.string(), row);
        return "cp " + made.string() + "/* \"$RUN\"";
    }
    std::string success() const {
        MethodRun run;
        run.method = "whatever";
        run.frames = run.tracked = run.poses = 3;
        for (int i = 0; i < 3; ++i) run.trajectory.push_back({1.0 + i, Pose::Identity()});
        return leave("made", run);
    }
    std::string failure(const std::string& script, double timeout = kLongTimeout) const {
        const MethodRun made = make(script, timeout);
        EXPECT_EQ(kept().failure, made.failure) << "what is kept is what is said";
        EXPECT_EQ(kept().key, "k");
        return made.failure;
    }
    std::size_t entries() const {
        std::size_t count = 0;
        for ([[maybe_unused]] const auto& entry : fs::directory_iterator(folder / "runs/clip")) ++count;
        return count;
    }

    const InterruptGuard guard;
    TemporaryFolder folder;
    std::function<void(const Advance&)> going;
};

TEST_F(Supervised, AGoodRunIsKeptWithWhatItWasMadeFrom) {
    make(success());
    EXPECT_TRUE(kept().ok());
    EXPECT_EQ(kept().method, "m");
    EXPECT_EQ(kept().label, "Label of m");
    EXPECT_EQ(kept().input, "clip.rawlog");
    EXPECT_EQ(kept().key, "k");
    EXPECT_EQ(kept().trajectory.size(), 3u);
}

TEST_F(Supervised, ANewRunTakesThePlaceOfTheOldOne) {
    failure("exit 1");
    writeFile(task().folder + "/old", "");
    make(success());
    EXPECT_TRUE(kept().ok());
    EXPECT_FALSE(fs::exists(task().folder + "/old"));
    EXPECT_EQ(entries(), 1u);
}

TEST_F(Supervised, FailuresAreKeptInWords) {
    const auto expect = [](const std::string& text, const std::vector<std::string>& words) {
        for (const std::string& word : words)
            EXPECT_NE(text.find(word), std::string::npos) << word << " in: " << text;
        EXPECT_EQ(text.find('\n'), std::string::npos);
    };
    expect(failure("echo 12 0.5 > \"$RUN\"/progress.txt; echo stack smashed >&2; kill -SEGV $$"),
           {"signal 11", "Segmentation fault", "after 12 frames", "stack smashed"});
    EXPECT_EQ(kept().frames, 12u);
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

TEST_F(Supervised, WhatARunSaysOfItsOwnFailureCountsAndNotWhatIsPrinted) {
    MethodRun run;
    run.method = "whatever";
    run.failure = "at frame 3: no depth";
    const std::string script = leave("failed", run) + "; echo 2 0.2 > \"$RUN\"/progress.txt; " +
                               "echo 77 0.77; echo library: all is well; echo library: noise >&2; ";
    for (const char* end : {"exit 1", "exit 0"}) {
        EXPECT_EQ(failure(script + end), "at frame 3: no depth") << end;
        EXPECT_EQ(kept().frames, 2u);
    }
    EXPECT_NE(failure(script + "kill -SEGV $$").find("signal 11"), std::string::npos);
    EXPECT_NE(failure(success() + "; exit 3").find("exit code 3"), std::string::npos)
        << "a result of a program that failed is none";
}

TEST_F(Supervised, TellsHowFarItIs) {
    std::set<double> shares;
    going = [&](const Advance& advance) { shares.insert(advance.share); };
    make(
        "echo 1 0.25 > \"$RUN\"/progress.txt; sleep 0.5; echo 1 0.75; echo '  3   -7' > "
        "\"$RUN\"/progress.txt; "
        "sleep 0.5; " +
        success());
    EXPECT_TRUE(shares.count(0.25));
    EXPECT_FALSE(shares.count(0.75)) << "what libraries print is no progress";
    EXPECT_EQ(*shares.begin(), 0);
    EXPECT_FALSE(fs::exists(task().folder + "/progress.txt")) << "it is of no use any more";
}

TEST_F(Supervised, NothingOfAFailedRunIsTakenForAResult) {
    failure("echo x > \"$RUN\"/frames.csv; echo y > \"$RUN\"/trajectory.txt; kill -ABRT $$");
    std::set<std::string> files;
    for (const auto& entry : fs::directory_iterator(task().folder))
        files.insert(entry.path().filename().string());
    EXPECT_EQ(files, std::set<std::string>{"run.json"});
}

TEST_F(Supervised, AnInterruptEndsAllAndLosesNothing) {
    make(success());
    const auto time = fs::last_write_time(task().folder + "/run.json");
    const std::string script =
        "echo $$ > " + (folder / "pid") + "; echo half > \"$RUN\"/frames.csv; sleep 100";
    going = [&](const Advance&) {
        if (fs::exists(folder / "pid") && !readFile(folder / "pid").empty()) raise(SIGINT);
    };
    EXPECT_THROW(make(script), Interrupted);
    EXPECT_TRUE(soon([&] { return !runs(std::stoi(readFile(folder / "pid"))); }));
    EXPECT_EQ(fs::last_write_time(task().folder + "/run.json"), time) << "the earlier run is still there";
    EXPECT_EQ(entries(), 1u) << "a half-made run was left";
}

TEST_F(Supervised, ARunThatCannotBeKeptIsAnError) {
    fs::create_directories(folder / "runs");
    writeFile(folder / "runs/clip", "a file is in the way");
    EXPECT_THROW(make(success()), std::runtime_error);
}

}  // namespace
}  // namespace roevo
