// Lists of sequences, names of recordings, and roevo-compare --benchmark.
#include <gtest/gtest.h>

#include <filesystem>
#include <nlohmann/json.hpp>

#include "roevo-compare/benchmark_list.h"
#include "roevo-compare/machine_info.h"
#include "roevo-compare/method_run.h"
#include "support/run_program.h"
#include "support/tum_folder.h"

namespace roevo {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using test::expectError;
using test::readFile;
using test::TemporaryFolder;
using test::writeFile;

constexpr char kName[] = "roevo-compare";

json entry(const std::string& name, const json& folder) {
    return {{"name", name},
            {"folder", folder},
            {"ground_truth", "groundtruth.txt"},
            {"truncation", nullptr},
            {"paper", {{"ate_cm", {{"ROEVO-TR+BA", 1.5}, {"ROEVO-CT", 9.5}}}}}};
}

TEST(SequenceNames, AreUniqueAndFitForFolders) {
    const TemporaryFolder folder;
    for (const char* name : {"a/clip", "b/clip", "c.v2"}) fs::create_directories(folder / name);
    EXPECT_EQ(sequenceNames({folder / "a/clip", folder / "b/clip/", folder / "c.v2", folder / "d.x.rawlog"}),
              (std::vector<std::string>{"a_clip", "b_clip", "c.v2", "d.x"}));
    EXPECT_EQ(sequenceNames({folder / "a/clip", folder / "a/clip"}),
              (std::vector<std::string>{"a_clip", "a_clip_2"}));
    EXPECT_EQ(sequenceNames({folder / "a/../b/clip/."}), std::vector<std::string>{"clip"});
    for (const std::string& name : sequenceNames({"/", ".", ".."})) {
        EXPECT_NE(name, "");
        EXPECT_NE(name[0], '.');
        EXPECT_EQ(name.find('/'), std::string::npos);
    }
}

TEST(PartOfARecording, IsNamedByItsFramesAndTheWholeIsNone) {
    const auto part = [](std::size_t skip, std::size_t first, std::size_t size) {
        SequenceInput sequence;
        sequence.skip = skip;
        sequence.first = first;
        return partOf(sequence, size);
    };
    for (const std::size_t first : {0u, 6u, 100u}) EXPECT_EQ(part(0, first, 6), "") << first;
    EXPECT_EQ(part(0, 0, 0), "");
    EXPECT_EQ(part(0, 4, 6), "frames 0 to 3");
    EXPECT_EQ(part(0, 4, 0), "frames 0 to 3");
    EXPECT_EQ(part(2, 3, 6), "frames 2 to 4");
    EXPECT_EQ(part(2, 100, 6), "frames 2 to 5");
    EXPECT_EQ(part(2, 0, 6), "frames 2 to 5");
    EXPECT_EQ(part(2, 0, 0), "frames from number 2 on");
}

TEST(RecordingState, ChangesWithTheFilesOnly) {
    const TemporaryFolder folder;
    const std::string clip = folder / "clip", rawlog = folder / "other.rawlog";
    for (const char* name : {"clip/rgb", "clip/depth", "other_Images", "other_more"})
        fs::create_directories(folder / name);
    const auto state = [&](const std::string& input) { return recordingState(input, folder / "out"); };
    std::string before_clip, before_rawlog;
    const auto remember = [&] { before_clip = state(clip), before_rawlog = state(rawlog); };
    // Writes a file and says whose state is another one then
    const auto changed = [&](const std::string& name, const std::string& text) {
        remember();
        writeFile(folder / name, text);
        return std::string(state(clip) != before_clip ? "clip " : "") +
               (state(rawlog) != before_rawlog ? "rawlog" : "");
    };
    EXPECT_EQ(changed("clip/rgb.txt", "1 a"), "clip ");
    EXPECT_EQ(changed("clip/rgb.txt", "1 a\n2 c"), "clip ");
    EXPECT_EQ(changed("clip/rgb/1.png", "a"), "clip ");
    EXPECT_EQ(changed("clip/rgb/1.png", "another"), "clip ");
    EXPECT_EQ(changed("clip/depth/1.png", "b"), "clip ");
    EXPECT_EQ(changed("other.rawlog", "abc"), "rawlog");
    EXPECT_EQ(changed("other_Images/1.jpg", "a"), "rawlog");
    EXPECT_EQ(changed("other_Images/1.jpg", "ab"), "rawlog");
    EXPECT_EQ(changed("other_more/1.jpg", "a"), "") << "of another recording";
    EXPECT_EQ(state(clip + "/"), state(clip));
    EXPECT_NE(state(clip), state(rawlog));

    for (const char* touched : {"clip/rgb/1.png", "other.rawlog"}) {  // as long, and not as old
        remember();
        fs::last_write_time(folder / touched,
                            fs::last_write_time(folder / touched) + std::chrono::seconds(1));
        EXPECT_NE(state(clip) + state(rawlog), before_clip + before_rawlog) << touched;
    }
}

TEST(RecordingState, ResultsInsideTheRecordingAreNoPartOfIt) {
    const TemporaryFolder folder;
    fs::create_directories(folder / "clip/comparison/runs");
    writeFile(folder / "clip/rgb.txt", "1 a");
    const std::string output = folder / "clip/comparison";
    const std::string before = recordingState(folder / "clip", output);
    writeFile(output + "/runs/run.json", "{}");
    EXPECT_EQ(recordingState(folder / "clip", output), before);
    EXPECT_NE(recordingState(folder / "clip", folder / "elsewhere"), before);
}

TEST(RecordingState, LinksInCirclesHaveAnEnd) {
    const TemporaryFolder folder;
    fs::create_directories(folder / "clip/rgb");
    fs::create_directory(folder / "images");
    writeFile(folder / "images/1.png", "a");
    for (const char* name : {"clip/again", "clip/rgb/again", "clip/rgb/once_more"})
        fs::create_directory_symlink(folder / "clip", folder / name);
    fs::create_directory_symlink(folder / "images", folder / "clip/depth");
    const std::string before = recordingState(folder / "clip", folder / "out");
    writeFile(folder / "images/1.png", "another");
    EXPECT_NE(recordingState(folder / "clip", folder / "out"), before) << "images behind a link count";
}

TEST(MachineInfo, CommandLinesCanBePastedIntoAShell) {
    EXPECT_EQ(shellCommand({"bin/roevo-compare", "--first", "5", "--set", "edges.min_length=3"}),
              "bin/roevo-compare --first 5 --set edges.min_length=3");
    const std::vector<std::string> words{"it's", "a b", "$HOME", "", "*", "~", "#x", "ä\n;"};
    const std::string command = shellCommand(words);
    const auto result = test::runProgram("/bin/sh", {"-c", "printf '<%s>' " + command});
    std::string expected;
    for (const std::string& word : words) expected += "<" + word + ">";
    EXPECT_EQ(result.out, expected) << command;
}

TEST(MachineInfo, NamesTheMachineAndTheLibraries) {
    const std::string machine = machineText();
    EXPECT_EQ(machine.find('\n'), std::string::npos);
    EXPECT_NE(machine.find("core"), std::string::npos) << machine;
    EXPECT_NE(machine.find(" GB"), std::string::npos) << machine;
    std::vector<std::string> names;
    for (const auto& [name, version] : softwareVersions()) {
        names.push_back(name);
        EXPECT_NE(version.find('.'), std::string::npos) << name << ' ' << version;
    }
    EXPECT_EQ(names, (std::vector<std::string>{"ROEVO", "MRPT", "OpenCV", "Eigen", "compiler"}));
    EXPECT_EQ(utcNow().size(), std::string("2026-01-31T12:00:00Z").size());
}

TEST(MachineInfo, AnotherProgramIsNotTakenForThisOne) {
    const TemporaryFolder folder;
    writeFile(folder / "a", "one program");
    writeFile(folder / "b", "one program");
    writeFile(folder / "c", "two program");
    EXPECT_EQ(programState(folder / "a"), programState(folder / "b"));
    EXPECT_NE(programState(folder / "a"), programState(folder / "c"));
    fs::copy_file("/proc/self/exe", folder / "myself");
    EXPECT_EQ(programState(), programState(folder / "myself"));
}

class List : public testing::Test {
  protected:
    List() { fs::create_directory(data()); }
    std::string data() const { return folder / "data"; }
    std::string file() const { return folder / "list.json"; }

    BenchmarkList read(const json& sequences) const {
        writeFile(file(), json{{"sequences", sequences}}.dump());
        return readBenchmarkList(file(), data());
    }
    std::string fault(const std::string& text) const {
        writeFile(file(), text);
        try {
            readBenchmarkList(file(), data());
        } catch (const std::runtime_error& e) {
            EXPECT_EQ(std::string(e.what()).find('\n'), std::string::npos) << e.what();
            return e.what();
        }
        return "it was read";
    }
    void expectFault(const std::string& text, const std::vector<std::string>& words) const {
        const std::string what = fault(text);
        EXPECT_NE(what.find(file()), std::string::npos) << what;
        for (const std::string& word : words)
            EXPECT_NE(what.find(word), std::string::npos) << word << " in: " << what;
    }
    void expectEntryFault(const json& sequence, const std::vector<std::string>& words) const {
        expectFault(json{{"sequences", json::array({sequence})}}.dump(), words);
    }

    TemporaryFolder folder;
};

TEST_F(List, TheProjectsOwnIsUnderstood) {
    const auto list =
        readBenchmarkList(std::string(ROEVO_SOURCE_DIR) + "/datasets_readme/sequences.json", data());
    EXPECT_EQ(list.sequences.size(), 0u);
    ASSERT_EQ(list.missing.size(), 24u);
    EXPECT_EQ(list.missing[4].rfind("fr1_desk: ", 0), 0u) << list.missing[4];
    EXPECT_NE(list.missing[4].find("rgbd_dataset_freiburg1_desk"), std::string::npos) << list.missing[4];
}

TEST_F(List, FindsFoldersAndRawlogs) {
    fs::create_directory(data() + "/folder_a");
    writeFile(data() + "/folder_b.rawlog", "");
    writeFile(data() + "/c.rawlog", "");
    fs::create_directory(data() + "/d");
    const auto list = read({entry("a", "folder_a"), entry("b", "folder_b"), entry("c", "folder_c"),
                            entry("d", nullptr), entry("e", "folder_e"), entry("f", nullptr)});
    ASSERT_EQ(list.sequences.size(), 4u);
    EXPECT_EQ(list.sequences[0].name, "a");
    EXPECT_EQ(list.sequences[0].input, data() + "/folder_a");
    EXPECT_EQ(list.sequences[1].input, data() + "/folder_b.rawlog");
    EXPECT_EQ(list.sequences[2].input, data() + "/c.rawlog");
    EXPECT_EQ(list.sequences[3].input, data() + "/d");
    for (const SequenceInput& sequence : list.sequences) {
        EXPECT_EQ(sequence.paper_ate_cm, 1.5);
        EXPECT_EQ(sequence.skip, 0u);
        EXPECT_EQ(sequence.first, 0u);
        EXPECT_EQ(sequence.note, "");
    }
    ASSERT_EQ(list.missing.size(), 2u);
    EXPECT_EQ(list.missing[0].rfind("e: ", 0), 0u);
    EXPECT_NE(list.missing[0].find("folder_e"), std::string::npos);
}

TEST_F(List, FramesThatThePaperLeavesOut) {
    for (const char* name : {"one", "two", "unknown"}) fs::create_directory(data() + "/" + name);
    json one = entry("one", "one"), two = entry("two", "two"), unknown = entry("unknown", "unknown");
    one["truncation"] = {{"frames", {10, 25}}, {"note", "the rest is a wall"}};
    two["truncation"] = {{"frames", {{0, 5}, {8, 20}}}};
    unknown["truncation"] = {{"frames", nullptr}, {"note", "nobody knows which"}};
    const auto list = read({one, two, unknown});
    ASSERT_EQ(list.sequences.size(), 4u);
    EXPECT_EQ(list.sequences[0].skip, 10u);
    EXPECT_EQ(list.sequences[0].first, 15u);
    EXPECT_EQ(list.sequences[0].note, "the rest is a wall");
    EXPECT_EQ(list.sequences[0].paper_ate_cm, 1.5) << "it is of these frames";
    EXPECT_EQ(list.sequences[1].name, "two_0_5");
    EXPECT_EQ(list.sequences[1].first, 5u);
    EXPECT_EQ(list.sequences[2].name, "two_8_20");
    EXPECT_EQ(list.sequences[2].skip, 8u);
    EXPECT_EQ(list.sequences[2].first, 12u);
    EXPECT_FALSE(list.sequences[2].paper_ate_cm) << "it is of both segments together";
    EXPECT_EQ(list.sequences[3].first, 0u);
    EXPECT_NE(list.sequences[3].note.find("nobody knows which"), std::string::npos);
    EXPECT_FALSE(list.sequences[3].paper_ate_cm) << "it is of other frames";
}

// Each of them has a folder for its runs.
TEST_F(List, NoTwoPartsAndSequencesShareAName) {
    for (const char* name : {"two", "two_0_5"}) fs::create_directory(data() + "/" + name);
    json two = entry("two", "two");
    two["truncation"] = {{"frames", {{0, 5}, {8, 20}}}};
    for (const json& list : {json{two, entry("two_0_5", "two_0_5")}, json{entry("two_0_5", "two_0_5"), two}})
        expectFault(json{{"sequences", list}}.dump(), {"sequence 2", "'two_0_5'"});
    two["truncation"] = {{"frames", {{0, 5}, {0, 5}}}};
    expectEntryFault(two, {"'two_0_5'"});
}

TEST_F(List, WhatIsWrongWithItIsSaid) {
    expectFault("{\"sequences\": [", {"JSON"});
    expectFault("", {"JSON"});
    expectFault("[]", {"no object"});
    expectFault("{}", {"'sequences' is missing"});
    expectFault("{\"sequences\": []}", {"empty"});
    expectFault("{\"sequences\": 3}", {"'sequences'"});
    expectFault("{\"sequences\": [3]}", {"sequence 1", "no object"});
    for (const char* key : {"name", "folder", "ground_truth", "truncation"}) {
        json lacking = entry("a", "folder_a");
        lacking.erase(key);
        expectEntryFault(lacking, {"sequence 1", "'" + std::string(key) + "' is missing"});
    }
    for (const char* name : {"", "..", "a/b", ".a"})
        expectEntryFault(entry(name, "x"), {"sequence 1", "name"});
    expectEntryFault(entry("a", 5), {"'a'", "'folder'"});
    expectFault(json{{"sequences", {entry("a", "x"), entry("a", "y")}}}.dump(),
                {"sequence 2", "of that name"});
    for (const json& frames : {json(5), json({5}), json({5, 5}), json({-1, 5}), json({"a", "b"}),
                               json::array(), json({{1, 2}, {3}})}) {
        json truncated = entry("a", "x");
        truncated["truncation"] = {{"frames", frames}};
        expectEntryFault(truncated, {"'a'", "truncation.frames"});
    }
    json truncated = entry("a", "x");
    truncated["truncation"] = 5;
    expectEntryFault(truncated, {"'a'", "'truncation'"});
    EXPECT_THROW(readBenchmarkList(folder / "none.json", data()), std::runtime_error);
    EXPECT_THROW(readBenchmarkList(data(), data()), std::runtime_error);
    writeFile(file(), json{{"sequences", {entry("a", "x")}}}.dump());
    EXPECT_THROW(readBenchmarkList(file(), folder / "none"), std::runtime_error);
}

class Benchmark : public List {
  protected:
    test::ProgramResult run(const std::vector<std::string>& more = {}) const {
        std::vector<std::string> arguments{"--benchmark", file(),         "--data",    data(),
                                           "--output",    folder / "out", "--methods", "roevo-tr,roevo-ct"};
        arguments.insert(arguments.end(), more.begin(), more.end());
        return test::runProgram(kName, arguments);
    }
    MethodRun kept(const std::string& sequence, const std::string& method) const {
        return readMethodRun(folder / ("out/runs/" + sequence + "/" + method));
    }
    auto madeAt(const std::string& sequence, const std::string& method) const {
        return fs::last_write_time(folder / ("out/runs/" + sequence + "/" + method + "/run.json"));
    }
};

TEST_F(Benchmark, PresentMissingAndBrokenSequences) {
    test::writeTumFolder(data() + "/whole", test::slidingRecording(8));
    test::writeTumFolder(data() + "/part", test::slidingRecording(8));
    fs::create_directory(data() + "/broken");
    json part = entry("part", "part");
    part["truncation"] = {{"frames", {2, 6}}};
    writeFile(file(),
              json{{"sequences",
                    {entry("whole", "whole"), entry("gone", "nowhere"), entry("broken", "broken"), part}}}
                  .dump());
    const auto result = run();
    ASSERT_EQ(result.exit_code, 0) << result.all();
    EXPECT_NE(result.err.find("skipped gone: not in "), std::string::npos) << result.err;
    EXPECT_NE(result.err.find("broken: cannot be used: "), std::string::npos) << result.err;
    EXPECT_EQ(kept("whole", "roevo-tr").frames, 8u);
    EXPECT_EQ(kept("part", "roevo-tr").frames, 4u);
    EXPECT_EQ(kept("part", "roevo-tr").trajectory.front().timestamp,
              kept("whole", "roevo-tr").trajectory.at(2).timestamp);

    const std::string table = readFile(folder / "out/table.csv"), text = readFile(folder / "out/table.md");
    for (const char* row : {"\nwhole,roevo-tr,", "\nwhole,roevo-ct,", "\npart,roevo-tr,", "\nbroken,"})
        EXPECT_NE(table.find(row), std::string::npos) << row << " in:\n" << table;
    EXPECT_NE(text.find("gone"), std::string::npos) << "what was skipped belongs into the report:\n" << text;
    EXPECT_TRUE(fs::exists(folder / "out/report.html"));

    EXPECT_NE(text.find("part: frames 2 to 5"), std::string::npos) << "it is not the whole:\n" << text;

    // The same command again: all is there; a sequence that has come is run alone
    for (const char* sequence : {"whole", "part"})
        for (const char* method : {"roevo-tr", "roevo-ct"}) {  // whatever else the machine has to do
            MethodRun run = kept(sequence, method);
            run.core_lost = 0;
            writeMethodRun(folder / ("out/runs/" + std::string(sequence) + "/" + method), run);
        }
    const auto before = madeAt("whole", "roevo-tr");
    test::writeTumFolder(data() + "/nowhere", test::slidingRecording(6));
    const auto again = run();
    ASSERT_EQ(again.exit_code, 0) << again.all();
    EXPECT_EQ(madeAt("whole", "roevo-tr"), before);
    EXPECT_NE(again.err.find("4 of 6 runs are there already"), std::string::npos) << again.err;
    EXPECT_NE(again.err.find("[2 of 2] gone, roevo-ct: 6 frames"), std::string::npos) << again.err;
    EXPECT_NE(readFile(folder / "out/table.csv").find("\nwhole,roevo-tr,"), std::string::npos);
    EXPECT_NE(readFile(folder / "out/table.csv").find("\ngone,roevo-tr,"), std::string::npos);
}

TEST_F(Benchmark, NothingThereIsAnError) {
    writeFile(file(), json{{"sequences", {entry("gone", "nowhere")}}}.dump());
    expectError(run(), 1, kName, {"not one sequence", "gone", "nowhere"});
    EXPECT_FALSE(fs::exists(folder / "out"));
    fs::create_directory(data() + "/nowhere");
    expectError(run(), 1, kName, {"nowhere", "rgb.txt"});
    EXPECT_FALSE(fs::exists(folder / "out"));
}

TEST_F(Benchmark, GroundTruthThatTheListNamesIsMissed) {
    test::writeTumFolder(data() + "/clip", test::slidingRecording(4));
    fs::remove(data() + "/clip/groundtruth.txt");
    writeFile(file(), json{{"sequences", {entry("clip", "clip")}}}.dump());
    const auto result = run();
    ASSERT_EQ(result.exit_code, 0) << result.all();
    EXPECT_NE(result.out.find("the list says groundtruth.txt"), std::string::npos) << result.out;
    EXPECT_NE(readFile(folder / "out/table.csv").find("the list says groundtruth.txt"), std::string::npos);
}

TEST_F(Benchmark, WrongUsageAndBadLists) {
    expectError(run(), 1, kName, {file(), "No such file"});
    writeFile(file(), "[");
    expectError(run(), 1, kName, {file(), "JSON"});
    writeFile(file(), json{{"sequences", {entry("a", "a")}}}.dump());
    expectError(run({"--input", data()}), 2, kName, {"--input and --benchmark"});
    expectError(run({"--ground-truth", file()}), 2, kName, {"--ground-truth"});
    expectError(test::runProgram(kName, {"--benchmark", file(), "--output", folder / "out"}), 2, kName,
                {"--data"});
    expectError(test::runProgram(kName, {"--input", data(), "--data", data(), "--output", folder / "out"}), 2,
                kName, {"--data"});
    json part = entry("part", "part");
    part["truncation"] = {{"frames", {2, 6}}};
    fs::create_directory(data() + "/part");
    writeFile(file(), json{{"sequences", {part}}}.dump());
    expectError(run({"--skip", "4"}), 2, kName, {"--skip 4", "part", "4 frames"});
    EXPECT_FALSE(fs::exists(folder / "out"));
}

}  // namespace
}  // namespace roevo
