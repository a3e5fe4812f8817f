#pragma once
/// roevo-compare as a program: how a test runs it, and what it finds afterwards.

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <functional>
#include <string>
#include <thread>
#include <vector>

#include "roevo-compare/rows.h"
#include "support/run_program.h"
#include "support/tum_folder.h"

namespace roevo::test {

class CompareProgram : public testing::Test {
  protected:
    std::vector<std::string> arguments(const std::vector<std::string>& inputs,
                                       const std::vector<std::string>& more) const {
        std::vector<std::string> all{"--input"};
        all.insert(all.end(), inputs.begin(), inputs.end());
        all.insert(all.end(), {"--output", output()});
        all.insert(all.end(), more.begin(), more.end());
        return all;
    }
    ProgramResult run(const std::vector<std::string>& inputs,
                      const std::vector<std::string>& more = {}) const {
        return runProgram("roevo-compare", arguments(inputs, more));
    }
    std::string clip(const std::string& name, int frames = 6) const {
        writeTumFolder(folder / name, slidingRecording(frames));
        return folder / name;
    }
    // Runs the program and does something while it is at it.
    ProgramResult runMeanwhile(const std::vector<std::string>& all,
                               const std::function<void(pid_t program)>& act) const {
        std::vector<std::string> words{"-c", "echo $$ > " + (folder / "pid") + "; exec \"$@\"", "sh",
                                       std::string(ROEVO_BIN_DIR) + "/roevo-compare"};
        words.insert(words.end(), all.begin(), all.end());
        ProgramResult result;
        std::thread program([&] { result = runProgram("/bin/sh", words); });
        while (!std::filesystem::exists(folder / "pid") || readFile(folder / "pid").empty()) usleep(5'000);
        act(std::stoi(readFile(folder / "pid")));
        program.join();
        return result;
    }
    std::string output() const { return folder / "out"; }
    std::string runFolder(const std::string& sequence, const std::string& method) const {
        return output() + "/runs/" + sequence + "/" + method;
    }
    MethodRun kept(const std::string& sequence, const std::string& method) const {
        return readRow(runFolder(sequence, method)).runs[0];
    }
    std::string table() const { return readFile(output() + "/table.csv"); }
    void expectRow(const std::string& begin) const {
        EXPECT_NE(table().find("\n" + begin), std::string::npos) << begin << " in:\n" << table();
    }

    TemporaryFolder folder;
};

}  // namespace roevo::test
