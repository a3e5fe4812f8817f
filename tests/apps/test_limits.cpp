// The system's limits on memory and file sizes: one line, and nothing half-written.
#include <filesystem>
#include <opencv2/imgcodecs.hpp>

#include "odometry_fixture.h"

namespace roevo {
namespace {

namespace fs = std::filesystem;
using test::expectError;

class Limits : public test::OdometryProgram {
  protected:
    void SetUp() override { test::writeTumFolder(folder_ / "recording", test::slidingRecording(4)); }

    static std::size_t entriesOf(const std::string& folder) {
        return fs::exists(folder) ? static_cast<std::size_t>(std::distance(fs::directory_iterator(folder),
                                                                           fs::directory_iterator()))
                                  : 0;
    }

    test::ProgramResult runUnder(const std::string& limit, const std::vector<std::string>& more = {}) const {
        std::vector<std::string> arguments{"--input", folder_ / "recording", "--output", output(), "--quiet"};
        arguments.insert(arguments.end(), more.begin(), more.end());
        return test::runLimited(limit, kName, arguments);
    }
};

TEST_F(Limits, FileSize) {
    for (const char* limit : {"-f 1", "-f 8", "-f 40"}) {
        SCOPED_TRACE(limit);
        expectError(runUnder(limit), 1, kName, {"cannot write", output()});
        EXPECT_EQ(entriesOf(output()), 0u);
    }
}

TEST_F(Limits, FileSizeKeepsWhatWasThere) {
    ASSERT_EQ(run(folder_ / "recording").exit_code, 0);
    const std::size_t before = entriesOf(output());
    const std::string trajectory = test::readFile(output() + "/trajectory.txt");
    expectError(runUnder("-f 8", {"--first", "2"}), 1, kName, {"cannot write"});
    EXPECT_EQ(entriesOf(output()), before);
    EXPECT_EQ(test::readFile(output() + "/trajectory.txt"), trajectory);
}

TEST_F(Limits, FileSizeOfOtherPrograms) {
    test::ProgramResult result = test::runLimited(
        "-f 1", "rawlog-simulate",
        {"--scene", "shadows", "--frames", "1", "--size", "160x120", "--output", folder_ / "s.rawlog"});
    expectError(result, 1, "rawlog-simulate", {"cannot write"});
    result = test::runLimited("-f 1", "rgbd2rawlog",
                              {"--input", folder_ / "recording", "--output", folder_ / "r.rawlog"});
    expectError(result, 1, "rgbd2rawlog", {"cannot write"});
    result = test::runLimited("-f 1", "roevo-odometry", {"--write-default-config", folder_ / "options.ini"});
    expectError(result, 1, "roevo-odometry", {"cannot write", "options.ini"});
    EXPECT_EQ(entriesOf(folder_.path().string()), 1u) << "the recording";
}

#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
TEST_F(Limits, Memory) {
    // What the program takes before it reads anything is of the machine's libraries
    int least = 0;
    for (int kilobytes = 100000; least == 0 && kilobytes < 1000000; kilobytes += 20000)
        if (test::runLimited("-v " + std::to_string(kilobytes), kName, {"--version"}).exit_code == 0)
            least = kilobytes;
    ASSERT_GT(least, 0);
    int failures = 0;
    for (int more = 0; more <= 40000; more += 10000) {
        SCOPED_TRACE(more);
        const auto result = runUnder("-v " + std::to_string(least + more));
        if (result.exit_code == 0) continue;
        failures++;
        expectError(result, 1, kName, {"memory"});
        EXPECT_EQ(entriesOf(output()), 0u);
    }
    EXPECT_GT(failures, 0);
    // Far from the first frame: an image larger than what is left
    cv::Mat large(7000, 7000, CV_8UC3, cv::Scalar::all(9));
    cv::imwrite(folder_ / "recording/rgb/0002.png", large);
    expectError(runUnder("-v " + std::to_string(least + 140000)), 1, kName, {"memory"});
    EXPECT_EQ(entriesOf(output()), 0u);
}
#endif

}  // namespace
}  // namespace roevo
