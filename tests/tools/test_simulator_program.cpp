// rawlog-simulate as a user calls it.
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <map>
#include <sstream>

namespace {

namespace fs = std::filesystem;

std::string contents(const fs::path& path) {
    std::ifstream file(path, std::ios::binary);
    std::ostringstream text;
    text << file.rdbuf();
    return text.str();
}

class SimulateProgram : public testing::Test {
  protected:
    void SetUp() override {
        std::string pattern = (fs::temp_directory_path() / "simulate_XXXXXX").string();
        ASSERT_NE(mkdtemp(pattern.data()), nullptr);
        folder_ = pattern;
    }
    void TearDown() override { fs::remove_all(folder_); }

    /// Exit code; what was printed on stderr is left in errors_.
    int run(const std::string& arguments) {
        const fs::path log = folder_ / "stderr";
        const std::string command = std::string(ROEVO_BIN_DIR) + "/rawlog-simulate " + arguments + " >" +
                                    (folder_ / "stdout").string() + " 2>" + log.string();
        const int status = std::system(command.c_str());
        errors_ = contents(log);
        return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
    }
    std::string path(const std::string& name) const { return (folder_ / name).string(); }

    /// Relative path -> bytes of everything below a folder.
    static std::map<std::string, std::string> tree(const fs::path& root) {
        std::map<std::string, std::string> files;
        for (const auto& entry : fs::recursive_directory_iterator(root))
            if (entry.is_regular_file())
                files[fs::relative(entry.path(), root).string()] = contents(entry.path());
        return files;
    }

    fs::path folder_;
    std::string errors_;
};

constexpr char kSmall[] =
    "--scene livingroom --size 128x96 --frames 3 --noise kinect --rolling-shutter 0.02 ";

TEST_F(SimulateProgram, SameSeedSameBytes) {
    const std::string tum = std::string(kSmall) + "--layout tum ";
    ASSERT_EQ(run(tum + "--seed 5 --threads 1 --output " + path("a")), 0) << errors_;
    ASSERT_EQ(run(tum + "--seed 5 --threads 2 --output " + path("b")), 0) << errors_;
    ASSERT_EQ(run(tum + "--seed 6 --output " + path("c")), 0) << errors_;
    const auto a = tree(path("a")), b = tree(path("b")), c = tree(path("c"));
    EXPECT_EQ(a.size(), 3u + 3u + 5u);
    EXPECT_TRUE(a == b);
    EXPECT_FALSE(a == c);
    EXPECT_NE(a.at("camera.txt").find("fx: 105\n"), std::string::npos);
}

TEST_F(SimulateProgram, WritesRawlogImagesAndGroundTruth) {
    for (const std::string name : {"x/room.rawlog", "y/room.rawlog"}) {
        fs::create_directory(fs::path(path(name)).parent_path());
        ASSERT_EQ(run(std::string(kSmall) + "--output " + path(name)), 0) << errors_;
    }
    const auto x = tree(path("x")), y = tree(path("y"));
    EXPECT_TRUE(x == y);
    EXPECT_EQ(x.size(), 5u);  // rawlog, three images, ground truth
    std::istringstream truth(x.at("room_groundtruth.txt"));
    std::string header;
    std::getline(truth, header);
    EXPECT_EQ(header.front(), '#');
    double stamp = 0, number = 0;
    int lines = 0, numbers = 0;
    for (std::string line; std::getline(truth, line); ++lines) {
        std::istringstream fields(line);
        fields >> stamp;
        EXPECT_NEAR(stamp, 1 + lines / 30., 1e-6);
        while (fields >> number) ++numbers;
    }
    EXPECT_EQ(lines, 3);
    EXPECT_EQ(numbers, 21);
}

TEST_F(SimulateProgram, UnwritableOutputIsOneLineAndLeavesNothing) {
    std::ofstream(path("file")) << "not a folder";
    EXPECT_EQ(run(std::string(kSmall) + "--output " + path("file") + "/x.rawlog"), 1);
    EXPECT_EQ(errors_.find("rawlog-simulate: error: cannot write " + path("file/x.rawlog") + ": "), 0u)
        << errors_;
    EXPECT_EQ(run(std::string(kSmall) + "--layout tum --output " + path("file") + "/x"), 1);
    EXPECT_NE(errors_.find("rawlog-simulate: error: "), std::string::npos) << errors_;
    fs::create_directory(path("used"));
    std::ofstream(path("used/precious")) << "keep me";
    EXPECT_EQ(run(std::string(kSmall) + "--layout tum --output " + path("used")), 1);
    EXPECT_EQ(contents(path("used/precious")), "keep me");
}

// A signal left s.rawlog.part behind
TEST_F(SimulateProgram, AnInterruptionLeavesNothing) {
    const std::string rawlog = path("s.rawlog");
    const std::string command = std::string(ROEVO_BIN_DIR) +
                                "/rawlog-simulate --scene shadows --size 64x48 --frames 100000 --output " +
                                rawlog + " >" + path("stdout") + " 2>" + path("stderr") +
                                " & child=$!; for i in $(seq 400); do [ -e " + rawlog +
                                ".part ] && break; sleep 0.05; done; kill -TERM $child; wait $child";
    const int status = std::system(command.c_str());
    EXPECT_EQ(WIFEXITED(status) ? WEXITSTATUS(status) : -1, 1);
    EXPECT_NE(contents(path("stderr")).find("interrupted; nothing was written"), std::string::npos);
    EXPECT_FALSE(fs::exists(rawlog) || fs::exists(rawlog + ".part"));
}

TEST_F(SimulateProgram, AnEmptyFileIsNoEmptyFolder) {
    std::ofstream(path("file")).flush();
    EXPECT_EQ(run("--scene shadows --size 64x48 --frames 1 --layout tum --output " + path("file")), 1);
    EXPECT_NE(errors_.find("it exists; choose another output folder"), std::string::npos) << errors_;
    EXPECT_TRUE(fs::is_regular_file(path("file")));
}

TEST_F(SimulateProgram, LoopIsOfTheSceneBlockOnly) {
    EXPECT_EQ(run("--scene corridor --path loop --layout tum --output " + path("folder")), 1);
    EXPECT_EQ(
        errors_,
        "rawlog-simulate: error: scene 'corridor' has no path 'loop': there is no way round in it, as in "
        "'block'\n");
    EXPECT_FALSE(fs::exists(path("folder")) || fs::exists(path("folder.part")));
    EXPECT_EQ(run("--scene block --size 64x48 --frames 2 --path loop --output " + path("loop.rawlog")), 0)
        << errors_;
}

TEST_F(SimulateProgram, LayoutsHaveTheFilesOfTheirBenchmarks) {
    const std::string options = "--scene shadows --frames 2 --start-time 0 --output ";
    ASSERT_EQ(run(options + path("icl") + " --layout icl"), 0) << errors_;
    const auto icl = tree(path("icl"));
    EXPECT_EQ(icl.size(), 2u + 2u + 2u) << "at 640x480 no camera.txt, as in the dataset";
    EXPECT_EQ(icl.at("associations.txt"), "0 depth/0.png 0 rgb/0.png\n1 depth/1.png 1 rgb/1.png\n");
    EXPECT_EQ(icl.at("traj0.gt.freiburg").substr(0, 2), "0 ");
    ASSERT_EQ(run(options + path("eth3d") + " --size 64x48 --layout eth3d --intrinsics 60 61 31 23"), 0)
        << errors_;
    const auto eth3d = tree(path("eth3d"));
    EXPECT_EQ(eth3d.size(), 2u + 2u + 5u);
    EXPECT_EQ(eth3d.at("calibration.txt"), "60 61 31 23\n");
    EXPECT_NE(eth3d.at("associated.txt").find("0.033333 rgb/0.033333.png 0.033333 depth/0.033333.png\n"),
              std::string::npos);
    ASSERT_EQ(run(options + path("seq-01") + " --layout 7scenes"), 0) << errors_;
    const auto scenes = tree(path("seq-01"));
    EXPECT_EQ(scenes.size(), 3u + 3u);
    for (const char* kind : {".color.png", ".depth.png", ".pose.txt"})
        EXPECT_EQ(scenes.count(std::string("frame-000001") + kind), 1u) << kind;
}

TEST_F(SimulateProgram, WrongUsageSaysWhatIsAllowed) {
    const std::string output = " --output " + path("x.rawlog");
    EXPECT_EQ(run("--scene attic" + output), 2);
    EXPECT_NE(errors_.find("livingroom, corridor, shadows, block"), std::string::npos) << errors_;
    EXPECT_EQ(run("--scene shadows --frames 0" + output), 2);
    EXPECT_NE(errors_.find("frames = 0"), std::string::npos) << errors_;
    EXPECT_EQ(run("--scene shadows --size 64by48" + output), 2);
    EXPECT_NE(errors_.find("64by48"), std::string::npos) << errors_;
    EXPECT_EQ(run("--scene shadows --no-such-option" + output), 2);
    EXPECT_EQ(run("--scene shadows --output " + path("x.txt")), 2);
    const std::string folder = "--scene shadows --output " + path("folder") + " --layout ";
    EXPECT_EQ(run(folder + "euroc"), 2);
    EXPECT_NE(errors_.find("rawlog,tum,icl,eth3d,7scenes,plain"), std::string::npos) << errors_;
    EXPECT_EQ(run(folder + "icl --fps 25"), 2);
    EXPECT_NE(errors_.find("30 Hz: leave out --fps"), std::string::npos) << errors_;
    EXPECT_EQ(run(folder + "7scenes --start-time 0.51"), 2);
    EXPECT_NE(errors_.find("multiple of 1/30 s"), std::string::npos) << errors_;
    EXPECT_EQ(run(folder + "7scenes --size 320x240"), 2);
    EXPECT_NE(errors_.find("640x480"), std::string::npos) << errors_;
    EXPECT_EQ(run(folder + "eth3d --distortion 0.1 0 0 0 0"), 2);
    EXPECT_NE(errors_.find("leave out --distortion"), std::string::npos) << errors_;
    EXPECT_EQ(run(folder + "tum --intrinsics 525 0 319 239"), 2);
    EXPECT_NE(errors_.find("fy = 0"), std::string::npos) << errors_;
    EXPECT_FALSE(fs::exists(path("folder")) || fs::exists(path("folder.part")));
    EXPECT_EQ(run("--help"), 0);
    EXPECT_NE(contents(folder_ / "stdout").find("4255"), std::string::npos)
        << "as test_simulator_block.cpp holds it";
    EXPECT_FALSE(fs::exists(path("x.rawlog")));
}

}  // namespace
