// Copies and hard links, and the reason when there are none.
#include <gtest/gtest.h>

#include "mrpt/test_helpers.h"
#include "roevo_mrpt/file_copy.h"

namespace roevo {
namespace {

namespace fs = std::filesystem;
using test::errorOf;

class FileCopy : public ::testing::Test {
  protected:
    FileCopy() { test::writeFile(folder_ / "a", std::string("some\0bytes\n", 11)); }
    void expectCopy(const std::string& name) const {
        EXPECT_EQ(test::readFile(folder_ / name), test::readFile(folder_ / "a"));
    }
    test::TemporaryFolder folder_;
};

TEST_F(FileCopy, CopiesAndReplaces) {
    test::writeFile(folder_ / "b", "something longer than the file that replaces it");
    copyFile(folder_ / "a", folder_ / "b");
    expectCopy("b");
    EXPECT_EQ(fs::hard_link_count(folder_ / "a"), 1u);
    test::writeFile(folder_ / "empty", "");
    copyFile(folder_ / "empty", folder_ / "b");
    EXPECT_EQ(fs::file_size(folder_ / "b"), 0u);
}

TEST_F(FileCopy, LinksToTheFileAndNotToALink) {
    fs::create_symlink("a", folder_ / "link");
    linkOrCopyFile(folder_ / "link", folder_ / "b");
    EXPECT_EQ(fs::hard_link_count(folder_ / "a"), 2u);
    EXPECT_FALSE(fs::is_symlink(folder_ / "b"));
}

TEST_F(FileCopy, NeverWritesIntoAFileThatIsThere) {
    linkOrCopyFile(folder_ / "a", folder_ / "b");
    const std::string before = test::readFile(folder_ / "a");
    EXPECT_NE(errorOf([&] { linkOrCopyFile(folder_ / "a", folder_ / "b"); }).find("File exists"),
              std::string::npos);
    EXPECT_EQ(test::readFile(folder_ / "a"), before);
}

TEST_F(FileCopy, CopiesWhereLinksCannotReach) {
    if (!fs::is_directory("/dev/shm")) GTEST_SKIP() << "no /dev/shm";
    const fs::path other = fs::path("/dev/shm") / fs::path(folder_.path()).filename();
    linkOrCopyFile(folder_ / "a", other.string());
    EXPECT_EQ(test::readFile(other), test::readFile(folder_ / "a"));
    fs::remove(other);
}

TEST_F(FileCopy, SaysWhatIsWrong) {
    EXPECT_EQ(errorOf([&] { copyFile(folder_ / "none", folder_ / "b"); }),
              "cannot copy " + (folder_ / "none") + " to " + (folder_ / "b") + ": No such file or directory");
    EXPECT_EQ(errorOf([&] { copyFile(folder_ / "a", "/dev/full"); }),
              "cannot copy " + (folder_ / "a") + " to /dev/full: No space left on device");
    EXPECT_NE(errorOf([&] { linkOrCopyFile(folder_ / "none", folder_ / "b"); }).find("none"),
              std::string::npos);
}

}  // namespace
}  // namespace roevo
