// roevo-odometry --threads: the same results with any number of them.
#include <set>

#include "odometry_fixture.h"

namespace roevo {
namespace {

using test::expectError;
using test::readFile;
using test::slidingRecording;

class Threads : public test::OdometryProgram {
  protected:
    /// Frames of every kind: one frozen, one out of order, one whose file is torn.
    void writeRecording() const {
        auto frames = slidingRecording(60);
        frames[20].colour = frames[19].colour;
        std::swap(frames[30].timestamp, frames[31].timestamp);
        test::writeTumFolder(folder_ / "recording", frames);
        std::set<std::filesystem::path> images;
        for (const auto& file : std::filesystem::directory_iterator(folder_ / "recording/rgb"))
            images.insert(file.path());
        const auto torn = *std::next(images.begin(), 40);
        test::writeFile(torn, readFile(torn).substr(0, 300));
    }
    /// All that was written but for times.
    std::vector<std::string> results() const {
        std::vector<std::string> all;
        for (const char* name : {"trajectory.txt", "trajectory_live.txt", "keyframes.txt", "map.ply",
                                 "map_semi_dense.ply", "map.3Dscene"})
            all.push_back(readFile(output() + "/" + name));
        for (auto row : rows()) {
            row.erase(row.begin() + 10, row.begin() + 17);  // ms
            for (const std::string& value : row) all.push_back(value);
        }
        return all;
    }
};

TEST_F(Threads, AnyNumberGivesTheSameBytes) {
    writeRecording();
    std::vector<std::string> usual;
    for (const std::string threads : {"1", "2", "3", "4"}) {
        const auto result = run(folder_ / "recording", {"--threads", threads});
        ASSERT_EQ(result.exit_code, 0) << result.all();
        EXPECT_NE(readFile(output() + "/config_used.ini").find("threads = " + threads), std::string::npos);
        if (threads == "1") {
            usual = results();
            EXPECT_GE(summary()["frames"]["keyframes"].get<int>(), 2);
            EXPECT_GE(summary()["frames"]["rejected"].get<int>(), 1);
        }
        EXPECT_EQ(results(), usual) << threads;
    }
}

TEST_F(Threads, FirstReadsNoFurther) {
    writeRecording();
    for (const std::string threads : {"1", "4"}) {
        ASSERT_EQ(run(folder_ / "recording", {"--threads", threads, "--first", "7", "--skip", "3"}).exit_code,
                  0);
        EXPECT_EQ(rows().size(), 7u) << threads;
    }
}

TEST_F(Threads, AWrongNumberIsRefused) {
    for (const std::string threads : {"0", "-1", "257", "many"})
        expectError(run(folder_ / "recording", {"--threads", threads}), 2, kName, {"--threads", threads});
}

}  // namespace
}  // namespace roevo
