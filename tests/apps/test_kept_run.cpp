// A run as it is kept in a folder and read again.
#include <gtest/gtest.h>

#include <filesystem>
#include <limits>
#include <stdexcept>

#include "roevo-compare/method_run.h"
#include "support/run_program.h"

namespace roevo {
namespace {

namespace fs = std::filesystem;
using test::readFile;
using test::TemporaryFolder;
using test::writeFile;

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

class KeptRun : public testing::Test {
  protected:
    KeptRun() {
        run.method = "fake";
        run.label = "Fake";
        run.note = "made up";
        run.input = "recordings/a \"b\"";
        run.warnings = {"damaged", "no scene"};
        run.not_pinned = "core 3: it is not allowed";
        run.signal = 6;
        run.timeout_s = 12.5;
        run.frames = 7;
        run.tracked = 5;
        run.rejected = 1;
        run.stages = {{"edges", 1.25, 2.5, 1.5}, {"fine", 3, 4, 3.5}};
        run.total = {"total", 5, 7, 5.5};
        run.decode = {"decode", 9, 11, 9.5};
        run.cpu_ms_per_frame = 6.125;
        run.core_lost = 0.25;
        run.background = "mapping";
        run.background_ms = 8;
        run.memory_peak_mb = 99.5;
        run.jobs = 2;
        run.settings = {{"first", "7"}, {"recording", "/a/b"}};
        for (int i = 0; i < 3; ++i)
            run.trajectory.push_back({1.5 + i, Pose(Eigen::Translation3d(i, 0.123456789, 0))});
    }
    std::string path() const { return folder.path().string(); }

    std::string readFault() const {
        try {
            readMethodRun(path());
        } catch (const std::runtime_error& e) {
            return e.what();
        }
        return "it was read";
    }
    void expectReadFault(const std::string& word) const {
        EXPECT_NE(readFault().find(word), std::string::npos) << word << " in: " << readFault();
        EXPECT_NE(readFault().find(path()), std::string::npos) << readFault();
        EXPECT_EQ(readFault().find('\n'), std::string::npos);
    }

    TemporaryFolder folder;
    MethodRun run;
};

TEST_F(KeptRun, ComesBackAsItWas) {
    writeMethodRun(path(), run);
    const MethodRun back = readMethodRun(path());
    EXPECT_EQ(back.method, run.method);
    EXPECT_EQ(back.label, run.label);
    EXPECT_EQ(back.note, run.note);
    EXPECT_EQ(back.input, run.input);
    EXPECT_EQ(back.skipped, "");
    EXPECT_EQ(back.failure, "");
    EXPECT_EQ(back.warnings, run.warnings);
    EXPECT_EQ(back.not_pinned, run.not_pinned);
    EXPECT_EQ(back.signal, run.signal);
    EXPECT_EQ(back.timeout_s, run.timeout_s);
    EXPECT_EQ(back.frames, run.frames);
    EXPECT_EQ(back.tracked, run.tracked);
    EXPECT_EQ(back.rejected, run.rejected);
    ASSERT_EQ(back.stages.size(), 2u);
    for (const auto& [a, b] : {std::pair(back.stages[0], run.stages[0]),
                               {back.stages[1], run.stages[1]},
                               {back.total, run.total},
                               {back.decode, run.decode}}) {
        EXPECT_EQ(a.name, b.name);
        EXPECT_EQ(a.median, b.median);
        EXPECT_EQ(a.p95, b.p95);
        EXPECT_EQ(a.mean, b.mean);
    }
    EXPECT_EQ(back.cpu_ms_per_frame, run.cpu_ms_per_frame);
    EXPECT_EQ(back.core_lost, run.core_lost);
    EXPECT_EQ(back.background, run.background);
    EXPECT_EQ(back.background_ms, run.background_ms);
    EXPECT_EQ(back.memory_peak_mb, run.memory_peak_mb);
    EXPECT_EQ(back.jobs, run.jobs);
    EXPECT_EQ(back.settings, run.settings);
    ASSERT_EQ(back.trajectory.size(), 3u);
    for (std::size_t i = 0; i < 3; ++i) {
        EXPECT_EQ(back.trajectory[i].timestamp, run.trajectory[i].timestamp);
        EXPECT_TRUE(back.trajectory[i].T_world_camera.isApprox(run.trajectory[i].T_world_camera, 1e-9));
    }
}

TEST_F(KeptRun, FailuresAndSkippedOnesHaveNoTrajectory) {
    for (std::string MethodRun::*member : {&MethodRun::failure, &MethodRun::skipped}) {
        MethodRun bad;
        bad.method = "fake";
        bad.*member = "for a \"reason\"";
        writeMethodRun(path(), bad);
        EXPECT_EQ(readMethodRun(path()).*member, "for a \"reason\"");
        EXPECT_FALSE(fs::exists(folder / "trajectory.txt"));
    }
}

TEST_F(KeptRun, NoFigureThatIsNotANumberIsKept) {
    for (double MethodRun::*member :
         {&MethodRun::cpu_ms_per_frame, &MethodRun::background_ms, &MethodRun::memory_peak_mb,
          &MethodRun::core_lost, &MethodRun::timeout_s}) {
        MethodRun bad = run;
        bad.*member = kNaN;
        EXPECT_THROW(writeMethodRun(path(), bad), std::runtime_error);
    }
    MethodRun bad = run;
    bad.stages[1].p95 = kNaN;
    EXPECT_THROW(writeMethodRun(path(), bad), std::runtime_error);
    EXPECT_TRUE(fs::is_empty(folder.path()));
}

TEST_F(KeptRun, BytesThatAreNoTextDoNotLoseIt) {
    run.input =
        "re\xff"
        "cording";
    writeMethodRun(path(), run);
    EXPECT_NE(readMethodRun(path()).input.find("cording"), std::string::npos);
}

TEST_F(KeptRun, WhatIsNotWholeIsSaid) {
    expectReadFault("no run.json");
    writeMethodRun(path(), run);
    const std::string json = readFile(folder / "run.json"), poses = readFile(folder / "trajectory.txt");

    writeFile(folder / "run.json", json.substr(0, json.size() / 2));
    expectReadFault("not whole");
    writeFile(folder / "run.json", "[]");
    expectReadFault("not whole");
    std::string other = json;
    other.replace(other.find("\"tracked\""), 9, "\"trucked\"");
    writeFile(folder / "run.json", other);
    expectReadFault("tracked");
    writeFile(folder / "run.json", json);

    writeFile(folder / "trajectory.txt", poses.substr(0, poses.rfind('\n', poses.size() - 2) + 1));
    expectReadFault("2 poses instead of 3");
    fs::remove(folder / "trajectory.txt");
    expectReadFault("trajectory.txt");
    writeFile(folder / "trajectory.txt", poses);
    EXPECT_EQ(readMethodRun(path()).trajectory.size(), 3u);

    run.scene = "map.3Dscene";
    writeMethodRun(path(), run);
    expectReadFault("map.3Dscene is missing");
    writeFile(folder / "map.3Dscene", "");
    EXPECT_EQ(readMethodRun(path()).scene, "map.3Dscene");
}

}  // namespace
}  // namespace roevo
