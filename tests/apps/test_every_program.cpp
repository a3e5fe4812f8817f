#include <gtest/gtest.h>

#include "support/run_program.h"

namespace roevo {
namespace {

using test::expectError;

class EveryProgram : public testing::TestWithParam<const char*> {};

TEST_P(EveryProgram, HelpShowsAnExample) {
    const auto result = test::runProgram(GetParam(), {"--help"});
    EXPECT_EQ(result.exit_code, 0) << result.all();
    EXPECT_NE(result.out.find("Example"), std::string::npos) << result.out;
    EXPECT_NE(result.out.find(std::string("\n  ") + GetParam() + " --"), std::string::npos) << result.out;
    EXPECT_EQ(result.err, "");
}

TEST_P(EveryProgram, VersionIsNameAndNumber) {
    const auto result = test::runProgram(GetParam(), {"--version"});
    EXPECT_EQ(result.exit_code, 0);
    EXPECT_EQ(result.out.find(std::string(GetParam()) + " "), 0u) << result.out;
    EXPECT_NE(result.out.find('.'), std::string::npos) << result.out;
}

TEST_P(EveryProgram, WrongUsageIsExitCode2) {
    expectError(test::runProgram(GetParam(), {"--no-such-option"}), 2, GetParam(),
                {"--no-such-option", "--help"});
    expectError(test::runProgram(GetParam(), {"a/path"}), 2, GetParam(), {"a/path", "--help"});
    expectError(test::runProgram(GetParam(), {}), 2, GetParam(), {"required"});
}

TEST(ProgramsThatTakeFrames, SayWhatANumberOfFramesIs) {
    for (const char* name : {"roevo-odometry", "roevo-compare", "roevo-study", "roevo-batch"})
        for (const std::string word : {"abc", "0", "1.5", "99999999999999999999999x"})
            expectError(test::runProgram(name, {"--first", word}), 2, name,
                        {"--first: '" + word + "' is not a whole number of 1 or more"});
    for (const char* name : {"roevo-odometry", "roevo-compare", "roevo-study"})
        expectError(test::runProgram(name, {"--skip", "abc"}), 2, name,
                    {"--skip: 'abc' is not a whole number of 0 or more"});
}

// A script whose variable is not set must not get another run than it asks for.
TEST(TextOfOptions, MustNotBeEmpty) {
    const auto expectRefused = [](const char* name, const std::string& option) {
        expectError(test::runProgram(name, {"--input", "in", "--output", "out", option, ""}), 2, name,
                    {option, "empty"});
    };
    for (const char* option :
         {"--map-in", "--map-out", "--mask", "--ground-truth", "--config", "--covariances", "--simplemap",
          "--sensor-label", "--associations", "--colour-topic", "--mode", "--write-default-config"})
        expectRefused("roevo-odometry", option);
    for (const char* option : {"--config", "--set", "--methods", "--baseline"}) {
        expectRefused("roevo-compare", option);
        expectRefused("roevo-batch", option);
    }
    for (const auto& [name, option] : {std::pair("roevo-render", "--title"),
                                       {"rgbd2rawlog", "--associations"},
                                       {"rawlog2rgbd", "--sensor-label"}})
        expectRefused(name, option);
    expectError(test::runProgram("roevo-study",
                                 {"--input", "a", "--output", "b", "--experiment", "gaps", "--mode", ""}),
                2, "roevo-study", {"--mode", "empty"});
    expectError(test::runProgram("roevo-eval", {"--reference", "a", "--estimate", "b", "--json", ""}), 2,
                "roevo-eval", {"--json", "empty"});
    expectError(test::runProgram("rawlog-simulate", {"--scene", "", "--output", "b"}), 2, "rawlog-simulate",
                {"--scene", "empty"});
}

TEST(NumbersOfOptions, AreRefusedInWords) {
    for (const auto& [name, option, words] :
         {std::tuple("roevo-compare", "--memory", "'-5' is not a finite number from 0 to 1e12"),
          {"roevo-study", "--truth-sigma", "'-5' is not a finite number from 0 to 1e12"},
          {"roevo-study", "--gap", "'-5' is not a whole number of 1 or more"}})
        expectError(test::runProgram(name, {"--input", "in", "--output", "out", option, "-5"}), 2, name,
                    {std::string(option) + ": " + words});
    expectError(test::runProgram("roevo-study", {"--gap", "0"}), 2, "roevo-study", {"--gap: '0' is not a"});
}

INSTANTIATE_TEST_SUITE_P(Programs, EveryProgram,
                         testing::Values("roevo-odometry", "roevo-eval", "roevo-render", "rgbd2rawlog",
                                         "rawlog2rgbd", "rawlog-simulate", "roevo-compare", "roevo-batch",
                                         "roevo-study"),
                         [](const auto& info) {
                             std::string name = info.param;
                             name.erase(std::remove(name.begin(), name.end(), '-'), name.end());
                             return name;
                         });

}  // namespace
}  // namespace roevo
