// Pipes, devices and folders where a file is wanted: refused by name, neither waited for nor replaced.
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <filesystem>

#include "support/run_program.h"
#include "support/tum_folder.h"

namespace roevo {
namespace {

namespace fs = std::filesystem;
using test::expectError;

constexpr int kPatience = 10;  // s

class SpecialFiles : public testing::Test {
  protected:
    void SetUp() override {
        ASSERT_EQ(mkfifo((folder_ / "pipe").c_str(), 0600), 0);
        fs::create_directory(folder_ / "folder");
        fs::create_symlink("/dev/null", folder_ / "device");
        test::writeFile(folder_ / "poses.txt", "1 0 0 0 0 0 0 1\n2 1 0 0 0 0 0 1\n3 1 1 0 0 0 0 1\n");
    }

    /// Runs a program with each of the three in place of "@" in its arguments.
    void expectAllRefused(const std::string& name, const std::vector<std::string>& arguments,
                          const std::vector<std::string>& kinds = {"pipe", "folder", "device"}) const {
        for (const std::string& kind : kinds) {
            std::vector<std::string> filled = arguments;
            for (std::string& argument : filled)
                if (argument == "@") argument = folder_ / kind;
            SCOPED_TRACE(name + " " + kind);
            expectError(test::runForSeconds(kPatience, name, filled), 1, name,
                        {folder_ / kind, "it is a " + kind});
        }
        EXPECT_TRUE(fs::is_fifo(folder_ / "pipe"));
        EXPECT_TRUE(fs::is_symlink(folder_ / "device")) << "nothing was put in its place";
    }

    const test::TemporaryFolder folder_;
};

TEST_F(SpecialFiles, AsInput) {
    const std::string out = folder_ / "out", poses = folder_ / "poses.txt";
    expectAllRefused("roevo-odometry", {"--input", "@", "--output", out}, {"pipe", "device"});
    expectAllRefused("rawlog2rgbd", {"--input", "@", "--output", out});
    expectAllRefused("roevo-eval", {"--reference", "@", "--estimate", poses});
    expectAllRefused("roevo-eval", {"--reference", poses, "--estimate", "@"});
    expectAllRefused("roevo-render", {"--scene", "@", "--output", folder_ / "view.png"});
    EXPECT_FALSE(fs::exists(out));
}

TEST_F(SpecialFiles, BesideAGoodInput) {
    const std::string input = folder_ / "recording", out = folder_ / "out";
    test::writeTumFolder(input, test::slidingRecording(2));
    expectAllRefused("roevo-odometry", {"--input", input, "--output", out, "--config", "@"});
    expectAllRefused("roevo-odometry", {"--input", input, "--output", out, "--ground-truth", "@"});
    for (const char* file : {"camera.txt", "rgb.txt", "depth.txt"}) {
        SCOPED_TRACE(file);
        fs::rename(input + "/" + file, folder_ / "kept");
        ASSERT_EQ(mkfifo((input + "/" + file).c_str(), 0600), 0);
        expectError(test::runForSeconds(kPatience, "roevo-odometry", {"--input", input, "--output", out}), 1,
                    "roevo-odometry", {file, "it is a pipe"});
        fs::remove(input + "/" + file);
        fs::rename(folder_ / "kept", input + "/" + file);
    }
    // What an input that is no bag need not have is not waited for
    ASSERT_EQ(mkfifo((input + "/metadata.yaml").c_str(), 0600), 0);
    EXPECT_EQ(test::runForSeconds(kPatience, "roevo-odometry", {"--input", input, "--output", out}).exit_code,
              0);
}

TEST_F(SpecialFiles, AsOutput) {
    const std::string poses = folder_ / "poses.txt";
    expectAllRefused("roevo-odometry", {"--write-default-config", "@"});
    expectAllRefused("roevo-eval", {"--reference", poses, "--estimate", poses, "--json", "@"});
    fs::rename(folder_ / "device", folder_ / "device.rawlog");
    const auto result = test::runForSeconds(
        kPatience, "rawlog-simulate",
        {"--scene", "livingroom", "--frames", "1", "--size", "64x48", "--output", folder_ / "device.rawlog"});
    expectError(result, 1, "rawlog-simulate", {"device.rawlog", "it is a device"});
    EXPECT_TRUE(fs::is_symlink(folder_ / "device.rawlog"));
}

TEST_F(SpecialFiles, AmongTheResultsOfARun) {
    const std::string out = folder_ / "out";
    test::writeTumFolder(folder_ / "recording", test::slidingRecording(3));
    fs::create_directory(out);
    fs::create_symlink("/dev/null", out + "/frames.csv");
    expectError(
        test::runForSeconds(kPatience, "roevo-odometry", {"--input", folder_ / "recording", "--output", out}),
        1, "roevo-odometry", {"frames.csv", "it is a device"});
    EXPECT_EQ(std::distance(fs::directory_iterator(out), {}), 1) << "before any work was done";
    EXPECT_TRUE(fs::is_symlink(out + "/frames.csv"));
}

}  // namespace
}  // namespace roevo
