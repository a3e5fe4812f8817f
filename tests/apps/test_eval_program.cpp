#include <gtest/gtest.h>

#include <filesystem>
#include <nlohmann/json.hpp>

#include "support/data_folder.h"
#include "support/run_program.h"

namespace roevo {
namespace {

using test::expectError;
using test::TemporaryFolder;
using test::writeFile;

constexpr char kName[] = "roevo-eval";

const std::string kReference = "1 0 0 0 0 0 0 1\n2 1 0 0 0 0 0 1\n3 1 1 0 0 0 0 1\n4 1 1 1 0 0 0 1\n";

TEST(EvalProgram, GoldenFiguresOfFr2Desk) {
    const std::string data = test::dataFolder() + "/eval_fr2_desk/";
    if (!std::filesystem::exists(data)) GTEST_SKIP() << "no " << data;
    const TemporaryFolder folder;
    const auto result = test::runProgram(kName, {"--reference", data + "groundtruth.txt", "--estimate",
                                                 data + "estimate.txt", "--json", folder / "e.json"});
    ASSERT_EQ(result.exit_code, 0) << result.all();
    EXPECT_NE(result.out.find("0.8144"), std::string::npos) << "centimetres, in the table:\n" << result.out;
    const auto json = nlohmann::json::parse(test::readFile(folder / "e.json"));
    EXPECT_NEAR(json["ate_m"]["rmse"].get<double>(), 0.008144, 0.5e-6);
    EXPECT_EQ(json["max_dt_s"], 0.02);
    EXPECT_GT(json["rpe_per_second"]["translation_m"]["rmse"].get<double>(), 0);
}

TEST(EvalProgram, OffsetShiftsTheEstimate) {
    const TemporaryFolder folder;
    writeFile(folder / "r.txt", kReference);
    writeFile(folder / "e.txt", "11 0 0 0 0 0 0 1\n12 1 0 0 0 0 0 1\n13 1 1 0 0 0 0 1\n14 1 1 1 0 0 0 1\n");
    const std::vector<std::string> arguments{"--reference", folder / "r.txt", "--estimate", folder / "e.txt"};
    expectError(test::runProgram(kName, arguments), 1, kName,
                {"1.000000 s", "14.000000 s", "-10.000000", "--offset"});
    auto shifted = arguments;
    shifted.insert(shifted.end(), {"--offset", "-10"});
    const auto result = test::runProgram(kName, shifted);
    EXPECT_EQ(result.exit_code, 0) << result.all();
    EXPECT_NE(result.out.find("4 of 4"), std::string::npos) << result.out;
}

TEST(EvalProgram, FailuresAreOneLine) {
    const TemporaryFolder folder;
    writeFile(folder / "r.txt", kReference);
    writeFile(folder / "bad.txt", "1 0 0 0 0 0 0 1\n2 0 0\n");
    writeFile(folder / "two.txt", "1 0 0 0 0 0 0 1\n2 1 0 0 0 0 0 1\n");
    const auto with = [&](const std::string& estimate, std::vector<std::string> more = {}) {
        std::vector<std::string> arguments{"--reference", folder / "r.txt", "--estimate", estimate};
        arguments.insert(arguments.end(), more.begin(), more.end());
        return test::runProgram(kName, arguments);
    };
    expectError(with(folder / "none.txt"), 1, kName, {"none.txt", "No such file"});
    expectError(with(folder.path().string()), 1, kName, {"it is a folder"});
    expectError(with(folder / "bad.txt"), 1, kName, {"bad.txt:2:", "found 3"});
    expectError(with(folder / "two.txt"), 1, kName, {"only 2 poses"});
    expectError(with(folder / "r.txt", {"--max-dt", "-1"}), 2, kName, {"--max-dt"});
    expectError(with(folder / "r.txt", {"--max-dt", "much"}), 2, kName, {"--max-dt"});
    expectError(with(folder / "r.txt", {"--offset", "nan"}), 2, kName, {"--offset", "finite"});
    expectError(with(folder / "r.txt", {"--json", folder / "e.csv", "--table", folder / "e.csv"}), 2, kName,
                {"e.csv' is to be two outputs"});
    EXPECT_FALSE(std::filesystem::exists(folder / "e.csv"));
    expectError(with(folder / "r.txt", {"--json", folder / "no/such/e.json"}), 1, kName,
                {"cannot write", "e.json"});
    for (const char* option : {"--json", "--table", "--plot"}) {
        const std::string name = folder / (option + 2 == std::string("table")  ? "r.csv"
                                           : option + 2 == std::string("plot") ? "r.html"
                                                                               : "r.json");
        writeFile(name, kReference);
        expectError(with(name, {option, name}), 2, kName, {option, "an input"});
        EXPECT_EQ(test::readFile(name), kReference);
    }
}

TEST(EvalProgram, NamesNeedNotBeUtf8) {
    const TemporaryFolder folder;
    const std::string file = folder / "gt\xE9.txt";
    writeFile(file, kReference);
    const auto result = test::runProgram(kName, {"--reference", file, "--estimate", file, "--json",
                                                 folder / "e.json", "--table", folder / "e.csv"});
    EXPECT_EQ(result.exit_code, 0) << result.all();
    EXPECT_NE(test::readFile(folder / "e.json").find("gt\uFFFD.txt"), std::string::npos);
    EXPECT_TRUE(std::filesystem::exists(folder / "e.csv"));
}

TEST(EvalProgram, FiguresThatCannotBePrintedAreAFailure) {
    const TemporaryFolder folder;
    writeFile(folder / "r.txt", kReference);
    const std::string command = std::string(ROEVO_BIN_DIR) + "/" + kName + " --reference " +
                                (folder / "r.txt") + " --estimate " + (folder / "r.txt") +
                                " > /dev/full 2> " + (folder / "err");
    EXPECT_NE(std::system(command.c_str()), 0);
    EXPECT_NE(test::readFile(folder / "err").find("cannot write to the standard output"), std::string::npos);
}

}  // namespace
}  // namespace roevo
