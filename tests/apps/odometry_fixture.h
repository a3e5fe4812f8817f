#pragma once
#include <gtest/gtest.h>

#include <filesystem>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>
#include <vector>

#include "support/csv_lines.h"
#include "support/run_program.h"
#include "support/tum_folder.h"

namespace roevo::test {

/// Runs roevo-odometry in a folder of its own and looks at what it wrote.
class OdometryProgram : public testing::Test {
  protected:
    static constexpr const char* kName = "roevo-odometry";

    ProgramResult run(const std::string& input, const std::vector<std::string>& more = {}) const {
        std::vector<std::string> arguments{"--input", input, "--output", output()};
        arguments.insert(arguments.end(), more.begin(), more.end());
        return runProgram(kName, arguments);
    }

    /// Writes a recording and runs over it.
    ProgramResult runFrames(const std::vector<TumFrame>& frames,
                            const std::vector<std::string>& more = {}) const {
        writeTumFolder(folder_ / "recording", frames);
        return run(folder_ / "recording", more);
    }

    std::string output() const { return folder_ / "out"; }

    nlohmann::json summary() const { return nlohmann::json::parse(readFile(output() + "/summary.json")); }

    /// Rows of frames.csv without the head; commas inside quotes do not separate.
    std::vector<std::vector<std::string>> rows() const {
        auto all = test::csvLines(readFile(output() + "/frames.csv"));
        if (!all.empty()) all.erase(all.begin());
        return all;
    }
    std::string status(std::size_t frame) const { return rows().at(frame).at(1); }
    std::string reason(std::size_t frame) const { return rows().at(frame).at(2); }

    /// All frames but the given one have a pose and no fault.
    void expectOthersTracked(std::size_t bad_frame, std::size_t num_frames) const {
        const auto all = rows();
        ASSERT_EQ(all.size(), num_frames);
        for (std::size_t i = 0; i < num_frames; ++i)
            if (i != bad_frame) {
                EXPECT_TRUE(all[i][1] == "ok" || all[i][1] == "initialised")
                    << i << ": " << all[i][1] << ' ' << all[i][2];
            }
    }

    TemporaryFolder folder_;
};

}  // namespace roevo::test
