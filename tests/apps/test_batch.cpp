// roevo-batch: many recordings as rows and a report, what is made again and what stays, whatever goes wrong.
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <thread>

#include "programs/process.h"
#include "roevo-compare/rows.h"
#include "support/run_program.h"
#include "support/tum_folder.h"

namespace roevo {
namespace {

namespace fs = std::filesystem;
using test::expectError;
using test::readFile;
using test::writeFile;

constexpr char kName[] = "roevo-batch";

class Batch : public testing::Test {
  protected:
    void SetUp() override {
        if (findProgram("snakemake").empty()) GTEST_SKIP() << "snakemake is not installed";
        fs::create_directories(data());
    }
    void clip(const std::string& name, int frames = 4) const {
        test::writeTumFolder(data() + "/" + name, test::slidingRecording(frames));
    }
    test::ProgramResult run(const std::vector<std::string>& more = {}) const {
        std::vector<std::string> all{"--input", data(), "--output", out(), "--methods", "roevo-ct"};
        all.insert(all.end(), more.begin(), more.end());
        return test::runProgram(kName, all);
    }
    std::string data() const { return folder / "data"; }
    std::string out() const { return folder / "out"; }
    std::string runFolder(const std::string& sequence, const std::string& method) const {
        return out() + "/runs/" + sequence + "/" + method;
    }
    MethodRun row(const std::string& sequence, const std::string& method = "roevo-ct") const {
        return readRow(runFolder(sequence, method)).runs.at(0);
    }
    auto madeAt(const std::string& sequence, const std::string& method = "roevo-ct") const {
        return fs::last_write_time(runFolder(sequence, method) + "/run.json");
    }
    std::size_t rows() const {
        std::size_t count = 0;
        for (const char* name : {"a", "b", "c", "d", "e"})
            count += fs::exists(runFolder(name, "roevo-tr") + "/run.json");
        return count;
    }
    /// The engine that a roevo-batch has started: a group of its own. 0 when there is none.
    static pid_t engineOf(pid_t batch) {
        const std::string task = "/proc/" + std::to_string(batch) + "/task/" + std::to_string(batch);
        return static_cast<pid_t>(std::atoi(readFile(task + "/children").c_str()));
    }
    std::string table() const { return readFile(out() + "/table.csv"); }

    test::TemporaryFolder folder;
};

TEST_F(Batch, MakesARowOfEachAndOnlyWhatIsMissingWhenItGoesOn) {
    clip("a");
    clip("b {odd} 'name'", 5);
    fs::create_directories(data() + "/broken");
    const auto result = run({"--methods", "roevo-ct", "distance-field"});
    ASSERT_EQ(result.exit_code, 0) << result.all();
    EXPECT_NE(result.out.find("\nfiles       " + out() + "/\n"), std::string::npos) << result.out;
    for (const char* method : {"roevo-ct", "distance-field"}) {
        EXPECT_EQ(row("a", method).frames, 4u);
        EXPECT_EQ(row("b__odd___name_", method).frames, 5u);
        EXPECT_NE(row("broken", method).failure.find("rgb.txt"), std::string::npos) << row("broken").failure;
    }
    EXPECT_NE(table().find("\nbroken,roevo-ct,"), std::string::npos);
    EXPECT_TRUE(fs::exists(out() + "/report.html"));
    EXPECT_TRUE(fs::exists(out() + "/logs/a/roevo-ct.log"));
    const auto alone = test::runProgram("roevo-odometry", {"--input", data() + "/a", "--output",
                                                           folder / "alone", "--mode", "ct", "--quiet"});
    ASSERT_EQ(alone.exit_code, 0) << alone.all();
    EXPECT_EQ(readFile(runFolder("a", "roevo-ct") + "/trajectory.txt"),
              readFile(folder / "alone/trajectory.txt"));

    // One row is lost, a recording has changed, one is new; what a killed program left is no hindrance
    const auto kept = madeAt("a", "distance-field"), failed = madeAt("broken"),
               old = madeAt("b__odd___name_");
    fs::remove_all(runFolder("a", "roevo-ct"));
    fs::create_directories(out() + "/runs/a/.roevo-ct.node.1.partial");
    clip("b {odd} 'name'", 6);
    clip("c");
    const auto again = run({"--methods", "roevo-ct", "distance-field"});
    ASSERT_EQ(again.exit_code, 0) << again.all();
    EXPECT_NE(again.err.find("3 of 8 rows are there already"), std::string::npos) << again.err;
    EXPECT_EQ(madeAt("a", "distance-field"), kept);
    EXPECT_EQ(madeAt("broken"), failed) << "its own failure stays";
    EXPECT_NE(madeAt("b__odd___name_"), old);
    EXPECT_EQ(row("b__odd___name_").frames, 6u);
    EXPECT_TRUE(row("a").ok());
    EXPECT_TRUE(row("c").ok());
    EXPECT_FALSE(fs::exists(out() + "/runs/a/.roevo-ct.node.1.partial"));
}

TEST_F(Batch, NoResultAtAllIsAFailure) {
    fs::create_directories(data() + "/broken");
    for (const char* when : {"made", "kept"}) {
        expectError(run(), 1, kName, {"no run gave a result; the first: ", "rgb.txt"});
        EXPECT_TRUE(fs::exists(out() + "/report.html")) << when;
    }
}

TEST_F(Batch, ARecordingKeepsItsName) {
    clip("a b");
    clip("a_b", 5);
    ASSERT_EQ(run({"--quiet"}).exit_code, 0);
    const auto kept = madeAt("a_b_2");
    fs::remove_all(data() + "/a b");
    ASSERT_EQ(run({"--quiet"}).exit_code, 0);
    EXPECT_EQ(row("a_b_2").frames, 5u);
    EXPECT_EQ(madeAt("a_b_2"), kept);
    EXPECT_EQ(row("a_b").frames, 4u) << "of the earlier command: not of the same recording";
}

TEST_F(Batch, ConfigurationsAreComparedWithEachOther) {
    clip("a");
    writeFile(folder / "long.ini", "[edges]\nmin_length = 15\n");
    writeFile(folder / "short.ini", "[edges]\nmin_length = 8\n");
    const auto result =
        run({"--config", folder / "long.ini", folder / "short.ini", "--set", "sensor.max_depth=4"});
    ASSERT_EQ(result.exit_code, 0) << result.all() << readFile(out() + "/logs/engine.log");
    EXPECT_TRUE(row("a", "roevo-ct@long").ok()) << row("a", "roevo-ct@long").failure;
    EXPECT_NE(readFile(runFolder("a", "roevo-ct@long") + "/config_used.ini").find("min_length = 15"),
              std::string::npos);
    EXPECT_TRUE(row("a", "roevo-ct@short").ok());
    EXPECT_NE(table().find("(short)"), std::string::npos) << table();
}

// A list of sequences as that of the paper's: parts, names, the paper's figures, what is not there.
TEST_F(Batch, ListsOfSequences) {
    clip("whole", 8);
    clip("part", 8);
    const auto entry = [](const std::string& name, const std::string& truncation) {
        return R"({"name": ")" + name + R"(", "folder": ")" + name + R"(", "truncation": )" + truncation +
               R"(, "paper": {"ate_cm": {"ROEVO-TR+BA": 1.5}}})";
    };
    const std::string list = folder / "list.json";
    writeFile(list, R"({"sequences": [)" + entry("whole", "null") + "," + entry("gone", "null") + "," +
                        entry("part", R"({"frames": [[0, 4], [5, 8]], "note": "a wall"})") + "]}");
    const std::vector<std::string> arguments{"--input",  list,  "--data",    data(),
                                             "--output", out(), "--methods", "roevo-ct"};
    const auto result = test::runProgram(kName, arguments);
    ASSERT_EQ(result.exit_code, 0) << result.all();
    EXPECT_NE(result.err.find("skipped gone: not in "), std::string::npos) << result.err;
    EXPECT_EQ(row("whole").frames, 8u);
    EXPECT_EQ(readRow(runFolder("whole", "roevo-ct")).paper_ate_cm, 1.5);
    EXPECT_EQ(row("part_0_4").frames, 4u);
    const SequenceComparison second = readRow(runFolder("part_5_8", "roevo-ct"));
    EXPECT_EQ(second.runs[0].frames, 3u);
    EXPECT_FALSE(second.paper_ate_cm) << "it is of both parts together";
    EXPECT_EQ(second.notes.at(0), "a wall");
    EXPECT_EQ(second.runs[0].part, "frames 5 to 7");

    for (const auto& [text, word] :
         {std::pair<std::string, std::string>("[", "no list"),
          {"{}", "'sequences'"},
          {R"({"sequences": [{"name": "a"}]})", "'folder'"},
          {R"({"sequences": 3})", "no list"},
          {R"({"sequences": [)" + entry("part", R"({"frames": [6, 6]})") + "]}", "no range"}}) {
        writeFile(list, text);
        expectError(test::runProgram(kName, arguments), 1, kName, {"list.json", word});
    }
}

TEST_F(Batch, AMissingProgramIsAReasonAndMadeLater) {
    // The program as it is installed, in a folder of its own
    const fs::path bin = fs::path(ROEVO_BIN_DIR);
    fs::create_directories(folder / "tree/bin");
    fs::copy(bin / "roevo-batch", folder / "tree/bin/roevo-batch");
    fs::copy(bin / "../share", folder / "tree/share", fs::copy_options::recursive);
    // Says what methods there are, and is gone when it comes to work
    const std::string program = folder / "tree/bin/roevo-compare", real = (bin / "roevo-compare").string();
    writeFile(program, "#!/bin/sh\ncase \"$*\" in *--rows-only*) exec /nowhere/roevo-compare;; esac\nexec " +
                           real + " \"$@\"\n");
    fs::permissions(program, fs::perms::owner_all);
    clip("a");
    const std::vector<std::string> arguments{"--input", data(), "--output", out(), "--methods", "roevo-ct"};
    expectError(test::runProgram(folder / "tree/bin/roevo-batch", arguments), 1, kName,
                {"1 of 1 rows are lacking", "/nowhere/roevo-compare", "goes on"});
    EXPECT_NE(table().find("/nowhere/roevo-compare"), std::string::npos) << table();
    ASSERT_EQ(test::runProgram(kName, arguments).exit_code, 0);
    EXPECT_TRUE(row("a").ok());
    EXPECT_EQ(table().find("/nowhere/"), std::string::npos);
}

TEST_F(Batch, KilledItGoesOn) {
    const std::vector<std::string> names{"a", "b", "c", "d", "e"};
    const auto frames = [](const std::string& name) { return 30 + static_cast<std::size_t>(name[0] - 'a'); };
    for (const std::string& name : names) clip(name, static_cast<int>(frames(name)));
    const std::vector<std::string> all{"--input",   data(),     "--output", out(),
                                       "--methods", "roevo-tr", "--jobs",   "1"};
    for (const int signal : {SIGKILL, SIGINT}) {
        const std::size_t before = rows();
        const pid_t child = fork();
        if (child == 0) {
            const std::string program = std::string(ROEVO_BIN_DIR) + "/" + kName;
            std::vector<char*> argv{const_cast<char*>(program.c_str())};
            for (const std::string& word : all) argv.push_back(const_cast<char*>(word.c_str()));
            argv.push_back(nullptr);
            if (!freopen((folder / "err").c_str(), "w", stderr)) _exit(126);
            execv(program.c_str(), argv.data());
            _exit(127);
        }
        // One more row: then it holds the folder. Snakemake has an order of its own
        for (int i = 0; i < 6000 && rows() <= before; ++i) usleep(5'000);
        // However late the other one starts, this one must not be done by then
        const pid_t engine = engineOf(child);
        ASSERT_GT(engine, 0);
        kill(-engine, SIGSTOP);
        expectError(test::runProgram(kName, all), 1, kName, {"another roevo-batch", out()});
        kill(child, signal);
        kill(-engine, SIGCONT);
        int status = 0;
        waitpid(child, &status, 0);
        if (signal == SIGINT) {
            EXPECT_EQ(WEXITSTATUS(status), 1);
            EXPECT_NE(readFile(folder / "err").find("interrupted: "), std::string::npos)
                << readFile(folder / "err");
            EXPECT_TRUE(fs::exists(out() + "/report.html")) << "of what is finished";
        }
    }
    const auto result = test::runProgram(kName, all);
    ASSERT_EQ(result.exit_code, 0) << result.all();
    EXPECT_EQ(rows(), names.size());
    for (const std::string& name : names)
        EXPECT_EQ(row(name, "roevo-tr").trajectory.size(), frames(name))
            << readFile(runFolder(name, "roevo-tr") + "/run.json");
}

/// The names that a folder's or a list's recordings get.
TEST_F(Batch, WhatIsARecording) {
    const auto names = [&](const std::string& input, const std::string& output = "/nowhere") {
        const std::string code =
            "import sys; sys.path.insert(0, sys.argv[1]); import types, recordings; print(*[r['name'] for r "
            "in "
            "recordings.recordings(types.SimpleNamespace(input=sys.argv[2], output=sys.argv[3], "
            "data=None))])";
        const auto result = test::runProgram(
            "/usr/bin/python3",
            {"-B", "-c", code, std::string(ROEVO_BIN_DIR) + "/../share/roevo/batch", input, output});
        EXPECT_EQ(result.exit_code, 0) << result.all();
        return result.out;
    };
    clip("a"), clip("b");
    EXPECT_EQ(names(data()), "a b\n");
    fs::create_directories(data() + "/batch/runs");
    EXPECT_EQ(names(data(), data() + "/batch"), "a b\n") << "and not what a batch wrote there before";
    EXPECT_EQ(names(data() + "/a"), "a\n");
    fs::create_directories(folder / "walk/image");
    fs::create_directories(folder / "walk/depths");
    EXPECT_EQ(names(folder / "walk"), "walk\n");
    fs::create_directories(folder / "seq-01");
    writeFile(folder / "seq-01/frame-000000.color.png", "");
    EXPECT_EQ(names(folder / "seq-01"), "seq-01\n");
    writeFile(folder / "list.txt",
              "\xEF\xBB\xBF"
              "data/b\n");
    EXPECT_EQ(names(folder / "list.txt"), "b\n");
}

TEST_F(Batch, WrongUsage) {
    expectError(test::runProgram(kName, {"--input", data()}), 2, kName, {"--output is required"});
    expectError(run({"--jobs", "0"}), 2, kName, {"--jobs 0"});
    expectError(run({"--timeout", "-1"}), 2, kName, {"--timeout", "-1"});
    expectError(run({"--memory", "nan"}), 2, kName, {"--memory", "nan"});
    expectError(run({"--methods", "roevo-xy"}), 2, kName, {"roevo-xy", "roevo-ba"});
    expectError(run({"--data", data()}), 2, kName, {"--data"});
    expectError(run({"--config", folder / "none.ini"}), 1, kName, {"none.ini"});
    writeFile(folder / "odd.ini", "[edges]\nmin_lenght = 17\n");
    expectError(run({"--config", folder / "odd.ini"}), 1, kName, {"odd.ini:2", "edges.min_length"});
    expectError(run({"--set", "foo=1"}), 2, kName, {"--set: unknown option 'foo'", "roevo-batch --help"});
    expectError(run({"--set", "odometry.mode=ct"}), 2, kName, {"--set", "--methods"});
    expectError(run({"--baseline", folder / "none"}), 1, kName, {"--baseline", folder / "none"});
    expectError(run({"--baseline", data()}), 1, kName, {"--baseline", "run.json", data()});
    expectError(run(), 1, kName, {"no recording", data()});
    expectError(run({"--input", folder / "none"}), 1, kName, {folder / "none"});
    writeFile(folder / "rgb.txt", "1 rgb/1.png\n");
    expectError(run({"--input", folder / "rgb.txt"}), 1, kName, {"rgb.txt", "part of a recording"});
    writeFile(folder / "odd.txt", std::string("a\0b\n", 4));
    expectError(run({"--input", folder / "odd.txt"}), 1, kName, {"odd.txt", "no text"});
    EXPECT_FALSE(fs::exists(out()));
    writeFile(out(), "a file");
    clip("a");
    expectError(run(), 1, kName, {out()});
}

}  // namespace
}  // namespace roevo
