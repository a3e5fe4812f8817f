// rgbd2rawlog and rawlog2rgbd where files may not be read or written.
#include <gtest/gtest.h>

#include "tools/rawlog_tools_check.h"
#include "tools/small_tum_folder.h"

namespace roevo {
namespace {

namespace fs = std::filesystem;
using test::expectError;
using test::runUnprivileged;
using test::SmallTumFolder;

/// A dataset and its rawlog that all may read, a folder that all may write into, and one that they may not.
class Permissions : public ::testing::Test {
  protected:
    void SetUp() override {
        if (runUnprivileged("rawlog2rgbd", {"--version"}).exit_code != 0)
            GTEST_SKIP() << "root without setpriv, or programs that only root may run";
        input_.write("groundtruth.txt", "1 0 0 0 0 0 0 1\n");
        for (const char* name : {"open", "closed"}) fs::create_directory(folder_ / name);
        ASSERT_EQ(test::convert(input_.path(), folder_ / "open/o.rawlog").exit_code, 0);
        fs::permissions(input_.path(), fs::perms(0755));
        fs::permissions(folder_.path(), fs::perms(0755));
        fs::permissions(folder_ / "open", fs::perms(0777));
        fs::permissions(folder_ / "closed", fs::perms(0555));
    }
    void TearDown() override { fs::permissions(folder_ / "closed", fs::perms(0755)); }

    static void forbid(const std::string& file) { fs::permissions(file, fs::perms::none); }

    void expectRefused(const std::string& program, const std::string& input, const std::string& output,
                       const std::vector<std::string>& words) const {
        const auto before = test::countEntries(folder_ / "open");
        expectError(runUnprivileged(program, {"--input", input, "--output", folder_ / output}), 1, program,
                    words);
        EXPECT_EQ(test::countEntries(folder_ / "open"), before);
        EXPECT_EQ(test::countEntries(folder_ / "closed"), 0);
    }

    SmallTumFolder input_;
    test::TemporaryFolder folder_;
};

TEST_F(Permissions, OutputFolder) {
    expectRefused("rgbd2rawlog", input_.path(), "closed/x.rawlog",
                  {"closed/x", "folder", "closed: Permission denied"});
    expectRefused("rawlog2rgbd", folder_ / "open/o.rawlog", "closed/x", {"closed/x", "Permission denied"});
}

TEST_F(Permissions, Rawlog) {
    forbid(folder_ / "open/o.rawlog");
    expectRefused("rawlog2rgbd", folder_ / "open/o.rawlog", "open/x", {"cannot read", "o.rawlog"});
}

TEST_F(Permissions, FolderOfARawlog) {
    forbid(folder_ / "closed");
    expectError(runUnprivileged("rawlog2rgbd",
                                {"--input", folder_ / "closed/o.rawlog", "--output", folder_ / "open/x"}),
                1, "rawlog2rgbd", {"error: cannot read " + (folder_ / "closed/o.rawlog: Permission denied")});
}

TEST_F(Permissions, ImagesFolderOfARawlog) {
    forbid(folder_ / "open/o_Images");
    const std::string image = folder_ / ("open/o_Images/RGBD_" + SmallTumFolder::stamp(0) + ".png");
    expectRefused("rawlog2rgbd", folder_ / "open/o.rawlog", "open/x",
                  {"none of its 3 frames can be used", "cannot read image (Permission denied): " + image});
    fs::permissions(folder_ / "open/o_Images", fs::perms(0755));
}

TEST_F(Permissions, DepthFilesBehindAClosedFolder) {
    auto scan = test::scanAt(0);
    fs::create_directory(folder_ / "depth");
    scan->rangeImage_convertToExternalStorage("d.bin", folder_ / "depth/");
    fs::create_directory_symlink(folder_ / "depth", folder_ / "open/d_Images");
    test::writeObjects(folder_ / "open/d.rawlog", {scan});
    forbid(folder_ / "depth");
    expectRefused("rawlog2rgbd", folder_ / "open/d.rawlog", "open/x",
                  {"cannot read range image (Permission denied): " + (folder_ / "open/d_Images/d.bin")});
    fs::permissions(folder_ / "depth", fs::perms(0755));
}

TEST_F(Permissions, ImageOfADataset) {
    // Not the rawlog's hard link to it
    fs::remove_all(folder_ / "open/o_Images");
    fs::remove(folder_ / "open/o.rawlog");
    forbid(input_ / SmallTumFolder::rgbName(1));
    expectRefused("rgbd2rawlog", input_.path(), "open/x.rawlog", {SmallTumFolder::rgbName(1), "ermission"});
}

TEST_F(Permissions, GroundTruthBesideARawlog) {
    forbid(folder_ / "open/o_groundtruth.txt");
    expectRefused("rawlog2rgbd", folder_ / "open/o.rawlog", "open/x",
                  {"o_groundtruth.txt", "Permission denied"});
}

TEST_F(Permissions, AnImageOfARawlogCostsItsFrameOnly) {
    forbid(folder_ / ("open/o_Images/RGBD_" + SmallTumFolder::stamp(1) + ".png"));
    const auto outcome = runUnprivileged(
        "rawlog2rgbd", {"--input", folder_ / "open/o.rawlog", "--output", folder_ / "open/x"});
    EXPECT_EQ(outcome.exit_code, 0) << outcome.all();
    EXPECT_CONTAINS(outcome.out, "2 frames written, 1 left out");
    EXPECT_CONTAINS(outcome.out, "cannot read image (Permission denied)");
}

}  // namespace
}  // namespace roevo
