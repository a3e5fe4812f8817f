// Rows: runs as they are kept in folders, read again and put together.
#include <gtest/gtest.h>

#include <filesystem>
#include <limits>
#include <stdexcept>

#include "report_fixture.h"
#include "roevo-compare/rows.h"
#include "support/run_program.h"

namespace roevo {
namespace {

namespace fs = std::filesystem;
using test::readFile;
using test::TemporaryFolder;
using test::writeFile;

constexpr double kNoNumber = std::numeric_limits<double>::quiet_NaN();

class Row : public testing::Test {
  protected:
    Row() {
        sequence.name = "clip";
        run.method = "fake";
        run.label = "Fake";
        run.note = "made up";
        run.input = "recordings/a \"b\"";
        run.warnings = {"damaged", "no scene"};
        run.not_pinned = "core 3: it is not allowed";
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
        run.key = "abc";
        run.trajectory_file = "their/orb.txt";
        run.poses = 3;
        for (int i = 0; i < 3; ++i)
            run.trajectory.push_back({1.5 + i, Pose(Eigen::Translation3d(i, 0.123456789, 0))});
    }
    std::string path() const { return folder.path().string(); }

    std::string readFault() const {
        try {
            readRow(path());
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
    SequenceComparison sequence = test::makeSequence("clip", {MethodRun()});
    MethodRun& run = sequence.runs[0];
};

TEST_F(Row, ComesBackAsItWas) {
    writeRow(path(), sequence);
    const MethodRun back = readRow(path()).runs[0];
    EXPECT_EQ(back.method, run.method);
    EXPECT_EQ(back.label, run.label);
    EXPECT_EQ(back.note, run.note);
    EXPECT_EQ(back.input, run.input);
    EXPECT_EQ(back.skipped, "");
    EXPECT_EQ(back.failure, "");
    EXPECT_EQ(back.warnings, run.warnings);
    EXPECT_EQ(back.not_pinned, run.not_pinned);
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
    EXPECT_EQ(back.trajectory_file, run.trajectory_file);
    EXPECT_EQ(back.key, "abc");
    ASSERT_EQ(back.trajectory.size(), 3u);
    for (std::size_t i = 0; i < 3; ++i) {
        EXPECT_EQ(back.trajectory[i].timestamp, run.trajectory[i].timestamp);
        EXPECT_TRUE(back.trajectory[i].T_world_camera.isApprox(run.trajectory[i].T_world_camera, 1e-9));
    }
}

TEST_F(Row, FailuresAndSkippedOnesHaveNoTrajectory) {
    for (std::string MethodRun::*member : {&MethodRun::failure, &MethodRun::skipped}) {
        MethodRun bad;
        bad.method = "fake";
        bad.*member = "for a \"reason\"";
        sequence.runs = {bad};
        writeRow(path(), sequence);
        EXPECT_EQ(readRow(path()).runs[0].*member, "for a \"reason\"");
        EXPECT_FALSE(fs::exists(folder / "trajectory.txt"));
    }
}

TEST_F(Row, NoFigureThatIsNotANumberIsKept) {
    for (double MethodRun::*member : {&MethodRun::cpu_ms_per_frame, &MethodRun::background_ms,
                                      &MethodRun::memory_peak_mb, &MethodRun::core_lost}) {
        SequenceComparison bad = sequence;
        bad.runs[0].*member = kNoNumber;
        EXPECT_THROW(writeRow(path(), bad), std::runtime_error);
    }
    run.stages[1].p95 = kNoNumber;
    EXPECT_THROW(writeRow(path(), sequence), std::runtime_error);
    EXPECT_TRUE(fs::is_empty(folder.path()));
}

TEST_F(Row, BytesThatAreNoTextDoNotLoseIt) {
    run.input =
        "re\xff"
        "cording";
    writeRow(path(), sequence);
    EXPECT_NE(readRow(path()).input.find("cording"), std::string::npos);
}

TEST_F(Row, WhatIsNotWholeIsSaid) {
    expectReadFault("no run.json");
    writeRow(path(), sequence);
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
    EXPECT_EQ(readRow(path()).runs[0].trajectory.size(), 3u);

    run.scene = "map.3Dscene";
    writeRow(path(), sequence);
    expectReadFault("map.3Dscene is missing");
    writeFile(folder / "map.3Dscene", "");
    EXPECT_EQ(readRow(path()).runs[0].scene, "map.3Dscene");
}

// Rows of several recordings and methods in a folder, as a batch leaves them.
class ManyRows : public testing::Test {
  protected:
    std::string put(const std::string& name, const MethodRun& run) const {
        const fs::path at = folder.path() / "runs" / name / run.method;
        fs::create_directories(at);
        writeRow(at.string(), test::makeSequence(name, {run}));
        return at.string();
    }
    Rows read() const { return readRows({folder / "runs"}); }
    std::string fault() const {
        try {
            read();
        } catch (const std::runtime_error& e) {
            return e.what();
        }
        return "it was read";
    }
    TemporaryFolder folder;
};

TEST_F(ManyRows, ArePutTogetherByRecordingInTheOrderOfAllMethods) {
    put("b", test::makeRun("difodo-240", 0.03));
    put("b", test::makeRun("roevo-ba@thin", 0.02));
    put("b", test::makeRun("roevo-ct", 0.02));
    put("a", test::makeRun("roevo-ba", 0.01));
    put("a", test::failedRun("difodo-240", "it died"));
    writeFile(folder / "lacking.json",
              R"({"sequence": {"name": "a"}, "method": "roevo-tr@x", "failure": "no row"})");
    const MethodRun lacking = readRows({folder / "runs", folder / "lacking.json"}).sequences[0].runs[0];
    EXPECT_EQ(lacking.label, "ROEVO TR (x)");
    EXPECT_EQ(lacking.failure, "no row");
    fs::create_directories(folder / "runs/b/.roevo-tr.node.1.partial");
    writeFile(folder / "runs/b/.roevo-tr.node.1.partial/run.json", "{}");
    const Rows rows = read();
    EXPECT_EQ(rows.notes, std::vector<std::string>()) << "what is under way is no row";
    ASSERT_EQ(rows.sequences.size(), 2u);
    EXPECT_EQ(rows.sequences[0].name, "a");
    ASSERT_EQ(rows.sequences[1].runs.size(), 3u);
    EXPECT_EQ(rows.sequences[1].runs[0].method, "roevo-ct");
    EXPECT_EQ(rows.sequences[1].runs[1].method, "roevo-ba@thin");
    EXPECT_EQ(rows.sequences[1].runs[2].method, "difodo-240");
    EXPECT_EQ(rows.sequences[1].run_folders[0], folder / "runs/b/roevo-ct");
}

TEST_F(ManyRows, StateTheErrorsThatTheirTrajectoriesGive) {
    put("a", test::makeRun("roevo-ba", 0.01));
    put("a", test::failedRun("difodo-240", "it died"));
    SequenceComparison row = read().sequences.at(0);
    EXPECT_TRUE(row.runs[0].trajectory.empty());
    const auto stated = evaluateRuns(row);
    loadTrajectories(row);
    EXPECT_EQ(row.runs[0].trajectory.size(), 4u);
    const auto computed = evaluateRuns(row);
    for (const auto& errors : {stated, computed}) {
        ASSERT_TRUE(errors[0].evaluation);
        EXPECT_NEAR(errors[0].evaluation->ate.translation.rmse, 0.01, 1e-9);
        EXPECT_NEAR(errors[0].evaluation->rpe_frame.translation.rmse, 0.02, 1e-9);
        EXPECT_EQ(errors[0].evaluation->ate.translation.count, 4u);
        EXPECT_EQ(errors[1].fault, "it died");
    }
    EXPECT_EQ(row.runs[0].ground_truth_length_m, 6.0);
}

TEST_F(ManyRows, OneWithoutGroundTruthIsJudgedByThatOfTheOthers) {
    put("a", test::makeRun("roevo-tr", 0.01));
    SequenceComparison blind = test::makeSequence("a", {test::makeRun("roevo-ba", 0.02)});
    blind.reference.clear();
    fs::create_directories(folder / "runs/a/roevo-ba");
    writeRow(folder / "runs/a/roevo-ba", blind);
    SequenceComparison row = read().sequences.at(0);
    EXPECT_FALSE(evaluateRuns(row)[1].evaluation);
    loadTrajectories(row);
    EXPECT_EQ(row.runs.at(1).method, "roevo-ba");
    EXPECT_TRUE(row.runs[1].ok()) << row.runs[1].failure;
    ASSERT_TRUE(evaluateRuns(row)[1].evaluation);
    EXPECT_NEAR(evaluateRuns(row)[1].evaluation->ate.translation.rmse, 0.02, 1e-9);
}

TEST_F(ManyRows, WhatWasNotMeasuredIsNoFigure) {
    MethodRun quick = test::makeRun("roevo-ba", 0.01);
    SequenceComparison sequence = test::makeSequence("a", {quick});
    for (auto* poses : {&sequence.reference, &sequence.runs[0].trajectory})
        for (std::size_t i = 0; i < 4; ++i) (*poses)[i].timestamp = 1000 + 0.1 * static_cast<double>(i);
    fs::create_directories(folder / "runs/a");
    writeRow(folder / "runs/a", sequence);
    const std::string json = readFile(folder / "runs/a/run.json");
    for (const char* error : {"rpe_second_translation_m", "rpe_second_rotation_deg"})
        EXPECT_NE(json.find("\"" + std::string(error) + "\": null"), std::string::npos) << json;
    const Evaluation back = *read().sequences.at(0).errors.at(0).evaluation;
    EXPECT_EQ(back.rpe_second.translation.count, 0u);
    EXPECT_EQ(back.rpe_frame.translation.count, 3u);
}

TEST_F(ManyRows, TheGroundTruthsLengthIsOfThePartThatWasRun) {
    MethodRun part = test::makeRun("roevo-ba", 0.01);
    part.trajectory.pop_back();
    part.frames = part.tracked = 3;
    put("a", part);
    EXPECT_EQ(read().sequences.at(0).runs[0].ground_truth_length_m, 4.0);
}

TEST_F(ManyRows, SeveralMayBeInOneFile) {
    const std::string a = put("a", test::makeRun("roevo-ba", 0.01)),
                      b = put("b", test::makeRun("roevo-ba", 0.02));
    writeFile(folder / "all.json", readFile(a + "/run.json") + "\n" + readFile(b + "/run.json"));
    EXPECT_EQ(readRows({folder / "all.json"}).sequences.size(), 2u);
    EXPECT_THROW(readRows({folder / "runs", folder / "all.json"}), std::runtime_error)
        << "each is there twice";
    EXPECT_THROW(readRows({folder / "none"}), std::runtime_error);
}

TEST_F(ManyRows, OneThatIsDamagedCostsItselfAndIsSaid) {
    EXPECT_NE(fault().find("no such"), std::string::npos) << fault();
    const std::string a = put("a", test::makeRun("roevo-ba", 0.01)),
                      b = put("b", test::makeRun("roevo-ba", 0.02));
    const std::string text = readFile(b + "/run.json");
    for (const std::string& damaged :
         {text.substr(0, text.size() / 2), std::string("[]"), std::string("{}")}) {
        writeFile(b + "/run.json", damaged);
        const Rows rows = read();
        EXPECT_EQ(rows.sequences.size(), 1u);
        ASSERT_EQ(rows.notes.size(), 1u);
        EXPECT_NE(rows.notes[0].find(b + "/run.json"), std::string::npos) << rows.notes[0];
    }
    fs::remove(b + "/run.json");
    fs::create_symlink("nowhere", b + "/run.json");
    EXPECT_NE(fault().find("cannot read " + b + "/run.json"), std::string::npos) << fault();
    fs::remove(b + "/run.json");
    fs::remove_all(a);
    EXPECT_NE(fault().find("there is no row"), std::string::npos) << fault();
}

}  // namespace
}  // namespace roevo
