// roevo-batch over a real Slurm cluster of two nodes, which a script starts on this machine and stops again.
#include <gtest/gtest.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>

#include "programs/process.h"
#include "support/run_program.h"
#include "support/tum_folder.h"

namespace roevo {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using test::readFile;

class Slurm : public testing::Test {
  protected:
    void SetUp() override {
        setenv("PATH", (path_ + ":/usr/sbin").c_str(), 1);
        for (const char* program : {"snakemake", "slurmctld", "slurmd", "munged", "sbatch"})
            if (findProgram(program).empty())
                GTEST_SKIP() << program << " is not installed (snakemake, slurm-wlm, munge)";
        if (geteuid() != 0) GTEST_SKIP() << "slurmd wants to be root";
        setenv("CI", "true", 1);  // Snakemake looks each second then, and each tenth second else
        setenv("SLURM_CONF", (folder / "cluster/slurm.conf").c_str(), 1);
        const auto started = cluster({"start"});
        ASSERT_EQ(started.exit_code, 0) << started.all();
    }
    void TearDown() override {
        if (fs::exists(folder / "cluster")) cluster({"stop"});
        setenv("PATH", path_.c_str(), 1);
        unsetenv("SLURM_CONF");
        unsetenv("CI");
    }
    test::ProgramResult cluster(std::vector<std::string> words) const {
        words.insert(words.begin() + 1, folder / "cluster");
        return test::runProgram(std::string(ROEVO_SOURCE_DIR) + "/tests/slurm_cluster.sh", words);
    }
    test::ProgramResult run(const std::string& output, const std::vector<std::string>& more) const {
        std::vector<std::string> all{"--input",   folder / "data", "--output",       folder / output,
                                     "--methods", "roevo-ba",      "distance-field", "--quiet"};
        all.insert(all.end(), more.begin(), more.end());
        return test::runProgram("roevo-batch", all);
    }
    // A row without what differs from run to run: times, memory, what else the machine did.
    std::string row(const std::string& output, const std::string& run) const {
        json row = json::parse(readFile(folder / (output + "/runs/" + run + "/run.json")));
        for (const char* key : {"stages_ms", "total_ms", "decode_ms", "cpu_ms_per_frame", "core_lost",
                                "background_ms", "memory_peak_mb", "not_pinned"})
            row.erase(key);
        return row.dump(1);
    }

    test::TemporaryFolder folder;

  private:
    const std::string path_ = std::getenv("PATH");
};

TEST_F(Slurm, RowsAreThoseOfOneMachine) {
    for (const char* name : {"a", "b"})
        test::writeTumFolder(folder / ("data/" + std::string(name)), test::slidingRecording(5));
    fs::create_directories(folder / "data/broken");
    const auto local = run("local", {});
    ASSERT_EQ(local.exit_code, 0) << local.all();
    const auto remote = run("remote", {"--profile", "slurm"});
    ASSERT_EQ(remote.exit_code, 0) << remote.all() << readFile(folder / "remote/logs/engine.log");
    for (const std::string sequence : {"a", "b", "broken"})
        for (const std::string method : {"roevo-ba", "distance-field"}) {
            const std::string name = sequence + "/" + method;
            EXPECT_EQ(row("remote", name), row("local", name));
            if (sequence != "broken") {
                EXPECT_EQ(readFile(folder / ("remote/runs/" + name + "/trajectory.txt")),
                          readFile(folder / ("local/runs/" + name + "/trajectory.txt")));
            }
        }
}

}  // namespace
}  // namespace roevo
