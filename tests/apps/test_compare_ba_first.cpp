// What the comparison is to show, on scenes short enough for a test: ROEVO with its map is ahead of MRPT's
// own odometries.
#include <gtest/gtest.h>

#include <filesystem>
#include <map>

#include "compare_program.h"
#include "support/csv.h"
#include "support/data_folder.h"

namespace roevo {
namespace {

class RoevoIsFirst : public test::CompareProgram {
  protected:
    // ATE in cm by method, of those that this build has.
    std::map<std::string, double> compare(const std::string& input, const std::string& frames) const {
        const auto result = run({input}, {"--methods", "roevo-ba,difodo-240,icp-frame,icp-keyframe",
                                          "--first", frames, "--quiet"});
        EXPECT_EQ(result.exit_code, 0) << result.all();
        std::map<std::string, double> ate;
        for (const auto& row : test::parseCsv(table())) {
            if (row.at("status") == "skipped") continue;
            EXPECT_EQ(row.at("status"), "ok") << row.at("method") << ": " << row.at("reason");
            if (!row.at("ate_rmse_m").empty())
                ate[row.at("method")] = 100 * std::stod(row.at("ate_rmse_m"));
            else
                ADD_FAILURE() << row.at("method") << ": " << row.at("no_errors_because");
        }
        return ate;
    }

    void expectFirst(const std::map<std::string, double>& ate) {
        ASSERT_TRUE(ate.count("roevo-ba"));
        for (const auto& [method, error] : ate) {
            RecordProperty(method, std::to_string(error));
            if (method != "roevo-ba") {
                EXPECT_LT(ate.at("roevo-ba"), error) << "ATE in cm, " << method;
            }
        }
    }
};

TEST_F(RoevoIsFirst, InASimulatedRoomWithTheNoiseOfAKinect) {
    const auto made = test::runProgram(
        "rawlog-simulate", {"--scene", "livingroom", "--noise", "kinect", "--frames", "24", "--size",
                            "320x240", "--layout", "tum", "--output", folder / "room"});
    ASSERT_EQ(made.exit_code, 0) << made.all();
    const auto ate = compare(folder / "room", "24");
    if (ate.size() < 2) GTEST_SKIP() << "this build has none of the others";
    expectFirst(ate);
}

TEST_F(RoevoIsFirst, OnAClipOfAPublicDataset) {
    const std::string clip = test::dataFolder() + "/icl_office_kt0_50";
    if (!std::filesystem::exists(clip)) GTEST_SKIP() << clip << " is not there; set ROEVO_DATA_DIR";
    const auto ate = compare(clip, "24");
    if (ate.size() < 2) GTEST_SKIP() << "this build has none of the others";
    expectFirst(ate);
}

}  // namespace
}  // namespace roevo
