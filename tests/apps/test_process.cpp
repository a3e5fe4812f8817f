// A program that runs beside this one.
#include <gtest/gtest.h>
#include <sched.h>

#include <csignal>

#include "processes.h"
#include "programs/interrupt.h"
#include "programs/process.h"
#include "support/environment.h"

namespace roevo {
namespace {

using test::readFile;
using test::runs;
using test::shell;
using test::soon;
using test::TemporaryFolder;

constexpr double kLong = 60;  // s

TEST(Process, SaysHowItEnded) {
    ChildProcess good(shell("echo one; echo; echo two >&2; printf three"), -1, kLong);
    good.finish();
    EXPECT_TRUE(good.end().ok());
    EXPECT_EQ(good.lastOutput(), "three") << "even without an end of line";
    EXPECT_EQ(good.lastError(), "two");

    ChildProcess bad(shell("exit 3"), -1, kLong);
    bad.finish();
    EXPECT_EQ(bad.end().exit_code, 3);
    EXPECT_FALSE(bad.end().ok());

    ChildProcess crashed(shell("kill -SEGV $$"), -1, kLong);
    crashed.finish();
    EXPECT_EQ(crashed.end().signal, SIGSEGV);
    EXPECT_FALSE(crashed.end().ok());
}

TEST(Process, ProgramThatIsNotThere) {
    ChildProcess process({"/no/such/program"}, -1, kLong);
    process.finish();
    EXPECT_FALSE(process.end().ok());
    EXPECT_NE(process.lastError().find("cannot be started: No such file"), std::string::npos)
        << process.lastError();
}

TEST(Process, OutputLongerThanAPipeDoesNotStopIt) {
    ChildProcess process(shell("i=0; while [ $i -lt 40000 ]; do echo line $i; i=$((i+1)); done"), -1, kLong);
    process.finish();
    EXPECT_TRUE(process.end().ok());
    EXPECT_EQ(process.lastOutput(), "line 39999");
}

TEST(Process, IsEndedWithItsOwnChildrenWhenItsTimeIsUp) {
    const TemporaryFolder folder;
    ChildProcess process(shell("sleep 100 & echo $! > " + (folder / "pid") + "; echo ready; wait"), -1, 1);
    process.finish();
    EXPECT_LT(process.seconds(), kLong / 2);
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
    const std::vector<int> before = allowedCores();
    const int core = before.back();
    ChildProcess process(shell("grep Cpus_allowed_list /proc/self/status; ps -o pgid= -p $$ >&2 || true"),
                         core, kLong);
    process.finish();
    EXPECT_NE(process.lastOutput().find("\t" + std::to_string(core)), std::string::npos)
        << process.lastOutput();
    EXPECT_EQ(process.lastOutput().find_first_of(",-"), std::string::npos) << process.lastOutput();
    EXPECT_EQ(process.bindingFault(), "");
    EXPECT_EQ(allowedCores(), before) << "this process stays where it may be";
    ChildProcess sleeper(shell("sleep 100"), -1, kLong);
    EXPECT_EQ(getpgid(sleeper.id()), sleeper.id());
    EXPECT_NE(getpgid(sleeper.id()), getpgid(0));
}

TEST(Process, ACoreThatItMayNotUseIsToldAndItRunsAllTheSame) {
    const std::vector<int> before = allowedCores();
    ChildProcess process(shell("echo done"), CPU_SETSIZE - 1, kLong);
    EXPECT_NE(process.bindingFault().find("core " + std::to_string(CPU_SETSIZE - 1) + ": "),
              std::string::npos)
        << process.bindingFault();
    EXPECT_TRUE(process.finish().ok());
    EXPECT_EQ(process.lastOutput(), "done");
    EXPECT_EQ(allowedCores(), before);
}

TEST(Process, WaitingForItsEndCanBeInterrupted) {
    const InterruptGuard guard;
    for (const int signal : {SIGINT, SIGTERM, SIGHUP}) {
        const InterruptGuard inner;
        ChildProcess process(shell("sleep 100"), -1, kLong);
        raise(signal);
        EXPECT_THROW(process.finish(), Interrupted) << signal;
        EXPECT_TRUE(process.update()) << "it ends with its object";
    }
}

TEST(Process, AnIgnoredHangupStaysIgnored) {
    const auto before = std::signal(SIGHUP, SIG_IGN);  // as nohup does
    {
        const InterruptGuard guard;
        raise(SIGHUP);
        EXPECT_NO_THROW(InterruptGuard::check());
    }
    EXPECT_EQ(std::signal(SIGHUP, before), SIG_IGN);
}

TEST(FindProgram, GoesByPath) {
    const TemporaryFolder folder, other;
    test::writeFile(folder / "tool", "");
    test::writeFile(other / "tool", "");
    const test::WithEnvironment with("PATH", folder.path().string() + ":" + other.path().string());
    EXPECT_EQ(findProgram("tool"), "") << "it cannot be run";
    std::filesystem::permissions(other / "tool", std::filesystem::perms::owner_all);
    EXPECT_EQ(findProgram("tool"), other / "tool");
    std::filesystem::create_directory(folder / "tools");
    EXPECT_EQ(findProgram("tools"), "") << "a folder";
    with.set(std::nullopt);
    EXPECT_EQ(findProgram("tool"), "");
}

}  // namespace
}  // namespace roevo
