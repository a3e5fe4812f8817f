// Names of recordings, parts of them, and what a report says of the machine.
#include <gtest/gtest.h>

#include <filesystem>

#include "roevo-compare/machine_info.h"
#include "roevo-compare/sequences.h"
#include "support/run_program.h"

namespace roevo {
namespace {

namespace fs = std::filesystem;
using test::TemporaryFolder;

TEST(SequenceNames, AreUniqueAndFitForFolders) {
    const TemporaryFolder folder;
    for (const char* name : {"a/clip", "b/clip", "c.v2"}) fs::create_directories(folder / name);
    EXPECT_EQ(sequenceNames({folder / "a/clip", folder / "b/clip/", folder / "c.v2", folder / "d.x.rawlog"}),
              (std::vector<std::string>{"a_clip", "b_clip", "c.v2", "d.x"}));
    EXPECT_EQ(sequenceNames({folder / "a/clip", folder / "a/clip"}),
              (std::vector<std::string>{"a_clip", "a_clip_2"}));
    EXPECT_EQ(sequenceNames({folder / "a/../b/clip/."}), std::vector<std::string>{"clip"});
    fs::create_directory_symlink(folder / "a/clip", folder / "linked");
    EXPECT_EQ(sequenceNames({folder / "linked"}), std::vector<std::string>{"linked"}) << "as it is given";
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

}  // namespace
}  // namespace roevo
