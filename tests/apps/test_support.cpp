#include <gtest/gtest.h>

#include <filesystem>
#include <stdexcept>

#include "support/atomic_file.h"
#include "support/program.h"
#include "support/run_program.h"

namespace roevo {
namespace {

namespace fs = std::filesystem;
using test::TemporaryFolder;

std::size_t filesIn(const TemporaryFolder& folder) {
    return static_cast<std::size_t>(
        std::distance(fs::directory_iterator(folder.path()), fs::directory_iterator()));
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
    testing::internal::CaptureStderr();
    EXPECT_EQ(
        runProgram("p", []() -> int { throw std::runtime_error("\n what happened \nstack\nof calls"); }), 1);
    EXPECT_EQ(testing::internal::GetCapturedStderr(), "p: error: what happened \n");
    testing::internal::CaptureStderr();
    EXPECT_EQ(runProgram("p", []() -> int { throw UsageError("--x is wrong"); }), 2);
    EXPECT_EQ(testing::internal::GetCapturedStderr(), "p: error: --x is wrong (see p --help)\n");
}

}  // namespace
}  // namespace roevo
