#pragma once
/// roevo-compare as a program: how a test runs it, and what it finds afterwards.

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <functional>
#include <string>
#include <thread>
#include <vector>

#include "roevo-compare/method_run.h"
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
        return readMethodRun(runFolder(sequence, method));
    }
    // Whatever else goes on on the machine of the test: a run whose core was taken would be made anew.
    void pretendACalmMachine() const {
        for (const auto& entry : std::filesystem::recursive_directory_iterator(output())) {
            if (entry.path().filename() != "run.json") continue;
            const std::string folder_of_run = entry.path().parent_path().string();
            MethodRun run = readMethodRun(folder_of_run);
            if (run.core_lost <= 0) continue;
            run.core_lost = 0;
            writeMethodRun(folder_of_run, run);
        }
    }
    auto madeAt(const std::string& sequence, const std::string& method) const {
        return std::filesystem::last_write_time(runFolder(sequence, method) + "/run.json");
    }
    // Changes a run that was kept.
    void changeRun(const std::string& sequence, const std::string& method,
                   const std::function<void(MethodRun& run)>& change) const {
        MethodRun run = kept(sequence, method);
        change(run);
        writeMethodRun(runFolder(sequence, method), run);
    }
    std::string table() const { return readFile(output() + "/table.csv"); }
    void expectRow(const std::string& begin) const {
        EXPECT_NE(table().find("\n" + begin), std::string::npos) << begin << " in:\n" << table();
    }

    TemporaryFolder folder;
};

}  // namespace roevo::test
