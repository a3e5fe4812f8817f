#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cmath>
#include <csignal>
#include <filesystem>
#include <random>
#include <stdexcept>
#include <utility>

#include "input/edit_distance.h"
#include "programs/atomic_file.h"
#include "programs/output_folder.h"
#include "programs/program.h"
#include "programs/text.h"
#include "support/run_program.h"

namespace roevo {
namespace {

namespace fs = std::filesystem;
using test::TemporaryFolder;

std::size_t filesIn(const TemporaryFolder& folder) {
    return static_cast<std::size_t>(
        std::distance(fs::directory_iterator(folder.path()), fs::directory_iterator()));
}

TEST(Text, OneIsCountedInTheSingular) {
    EXPECT_EQ(counted(0, "frame"), "0 frames");
    EXPECT_EQ(counted(1, "frame"), "1 frame");
    EXPECT_EQ(counted(2, "frame"), "2 frames");
}

TEST(Text, EditDistanceIsThatOfLevenshtein) {
    EXPECT_EQ(editDistance("", ""), 0u);
    EXPECT_EQ(editDistance("", "abc"), 3u);
    EXPECT_EQ(editDistance("kitten", "sitting"), 3u);
    EXPECT_EQ(editDistance("width", "widht"), 2u);
}

TEST(AtomicFile, AppearsWholeAtCommit) {
    const TemporaryFolder folder;
    AtomicFile file(folder / "a.txt");
    file.stream() << "whole";
    EXPECT_FALSE(fs::exists(folder / "a.txt"));
    file.commit();
    EXPECT_EQ(test::readFile(folder / "a.txt"), "whole");
    EXPECT_EQ(filesIn(folder), 1u);
}

TEST(AtomicFile, LeavesNothingWithoutCommitAndKeepsTheOldFile) {
    const TemporaryFolder folder;
    test::writeFile(folder / "a.txt", "old");
    EXPECT_THROW(writeAtomically(folder / "a.txt",
                                 [](const std::string& path) {
                                     test::writeFile(path, "half");
                                     throw std::runtime_error("stop");
                                 }),
                 std::runtime_error);
    EXPECT_EQ(test::readFile(folder / "a.txt"), "old");
    EXPECT_EQ(filesIn(folder), 1u);
}

TEST(AtomicFile, TemporaryNameKeepsFolderAndExtension) {
    const AtomicFile file("some/where/map.3Dscene");
    EXPECT_EQ(fs::path(file.temporaryPath()).extension(), ".3Dscene");
    EXPECT_EQ(fs::path(file.temporaryPath()).parent_path(), "some/where");
}

TEST(AtomicFile, SaysWhyItCannotBeWritten) {
    const TemporaryFolder folder;
    for (const std::string& path : {folder / "no/such/folder.txt", folder.path().string()}) {
        try {
            writeTextAtomically(path, "text");
            FAIL() << path;
        } catch (const std::runtime_error& e) {
            EXPECT_NE(std::string(e.what()).find("cannot write " + path), std::string::npos) << e.what();
        }
    }
    // A writer that writes nothing has failed, too.
    EXPECT_THROW(writeAtomically(folder / "b.txt", [](const std::string&) {}), std::runtime_error);
}

TEST(Program, TurnsExceptionsIntoExitCodes) {
    EXPECT_EQ(runProgram("p", [] { return 0; }), 0);
    ::testing::internal::CaptureStderr();
    EXPECT_EQ(
        runProgram("p", []() -> int { throw std::runtime_error("\n what happened \nstack\nof calls"); }), 1);
    EXPECT_EQ(::testing::internal::GetCapturedStderr(), "p: error: what happened \n");
    ::testing::internal::CaptureStderr();
    EXPECT_EQ(runProgram("p", []() -> int { throw UsageError("--x is wrong"); }), 2);
    EXPECT_EQ(::testing::internal::GetCapturedStderr(), "p: error: --x is wrong (see p --help)\n");
}

// In a process of its own, which the signal ends.
int exitCodeAfter(int signal, const std::string& file, const std::string& whole = "") {
    const pid_t child = fork();
    if (child == 0)
        _exit(runProgram("p", [&] {
            const std::filesystem::path outputs = std::filesystem::path(file).parent_path();
            prepareOutputFolder(outputs.string());
            if (!whole.empty()) writeTextAtomically((outputs / whole).string(), "whole");
            AtomicFile half(file);
            half.stream() << "half" << std::flush;
            raise(signal);
            return 0;
        }));
    int status = 0;
    waitpid(child, &status, 0);
    return WIFEXITED(status) ? WEXITSTATUS(status) : -WTERMSIG(status);
}

TEST(Program, LeavesNothingHalfWrittenWhenASignalEndsIt) {
    const TemporaryFolder folder;
    for (const int signal : {SIGINT, SIGTERM, SIGHUP}) {
        EXPECT_EQ(exitCodeAfter(signal, folder / "a.txt"), 128 + signal);
        EXPECT_EQ(filesIn(folder), 0u) << signal;
    }
}

TEST(Program, LeavesNoEmptyFolderWhenItFailsOrIsInterrupted) {
    const TemporaryFolder folder;
    const std::string outputs = folder / "new", failed = folder / "failed";
    ::testing::internal::CaptureStderr();
    EXPECT_EQ(runProgram("p",
                         [&]() -> int {
                             prepareOutputFolder(failed);
                             throw std::runtime_error("what happened");
                         }),
              1);
    ::testing::internal::GetCapturedStderr();
    EXPECT_FALSE(std::filesystem::exists(failed));
    EXPECT_EQ(exitCodeAfter(SIGINT, outputs + "/a.txt"), 128 + SIGINT);
    EXPECT_FALSE(std::filesystem::exists(outputs));
    EXPECT_EQ(exitCodeAfter(SIGINT, folder / "outer/inner/a.txt"), 128 + SIGINT);
    EXPECT_FALSE(std::filesystem::exists(folder / "outer"));
    // What was there before stays, and so does what was written
    std::filesystem::create_directory(outputs);
    EXPECT_EQ(exitCodeAfter(SIGINT, outputs + "/a.txt"), 128 + SIGINT);
    EXPECT_TRUE(std::filesystem::exists(outputs));
    EXPECT_EQ(exitCodeAfter(SIGTERM, folder / "other/a.txt", "whole.txt"), 128 + SIGTERM);
    EXPECT_TRUE(std::filesystem::exists(folder / "other/whole.txt"));
}

TEST(Program, OutlivesItsTerminalUnderNohup) {
    const TemporaryFolder folder;
    const auto before = std::signal(SIGHUP, SIG_IGN);
    EXPECT_EQ(exitCodeAfter(SIGHUP, folder / "a.txt"), 0);
    std::signal(SIGHUP, before);
}

TEST(Text, PlainNumbersHaveTheFewestDigitsThatReadBack) {
    const std::pair<double, const char*> cases[] = {{0, "0"},
                                                    {5000, "5000"},
                                                    {100000, "100000"},
                                                    {517.3, "517.3"},
                                                    {-0.0001, "-0.0001"},
                                                    {0.00001, "1e-05"},
                                                    {-0.9531, "-0.9531"},
                                                    {1.0 / 3, "0.3333333333333333"}};
    for (const auto& [number, text] : cases) EXPECT_EQ(plainNumber(number), text);
    std::mt19937 rng(3);
    std::uniform_real_distribution<double> exponent(-12, 6);
    for (int i = 0; i < 1000; ++i) {
        const double number = std::pow(10, exponent(rng));
        EXPECT_EQ(std::stod(plainNumber(number)), number);
    }
}

TEST(Text, StampsHaveMicroseconds) {
    EXPECT_EQ(stampText(0), "0.000000");
    EXPECT_EQ(stampText(1305031102.1753039), "1305031102.175304");
    EXPECT_EQ(stampText(-0.5), "-0.500000");
}

}  // namespace
}  // namespace roevo
