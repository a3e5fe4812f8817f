// A report of rows that were not made alike: of other frames, with other options, by several commands.
#include <gtest/gtest.h>

#include <filesystem>
#include <map>

#include "compare_program.h"
#include "support/csv.h"

namespace roevo {
namespace {

namespace fs = std::filesystem;
using test::readFile;

class MixedRows : public test::CompareProgram {
  protected:
    void make(const std::string& input, const std::string& method, std::vector<std::string> more = {}) const {
        more.insert(more.end(), {"--methods", method, "--quiet"});
        const auto result = run({input}, more);
        ASSERT_EQ(result.exit_code, 0) << result.all();
    }
    // Writes the report of all rows. @return what is printed
    std::string report(const std::vector<std::string>& more = {}) const {
        std::vector<std::string> all{"--report", output() + "/runs", "--output", folder / "all"};
        all.insert(all.end(), more.begin(), more.end());
        const auto result = test::runProgram("roevo-compare", all);
        EXPECT_EQ(result.exit_code, 0) << result.all();
        return result.out;
    }
    std::string file(const char* name) const { return readFile(folder / "all/" + name); }
    std::map<std::string, std::string> row(const std::string& method) const {
        for (const auto& row : test::parseCsv(file("table.csv")))
            if (row.at("method") == method) return row;
        ADD_FAILURE() << "no row of " << method;
        return {};
    }
    void expectInAll(const std::string& terminal, const std::string& words) const {
        for (const std::string& text : {terminal, file("table.md"), file("report.html")})
            EXPECT_NE(text.find(words), std::string::npos) << words << " in:\n" << text.substr(0, 3000);
    }
    void expectInNone(const std::string& words) const {
        for (const char* name : {"table.csv", "table.md", "report.html"})
            EXPECT_EQ(file(name).find(words), std::string::npos) << words << " in " << name;
    }
};

TEST_F(MixedRows, OtherFramesAreSaidAndNotCalledTheSame) {
    const std::string input = clip("clip", 12);
    make(input, "roevo-tr", {"--first", "5"});
    make(input, "roevo-ct", {"--skip", "6"});
    const std::string printed = report();
    EXPECT_EQ(row("roevo-tr").at("sequence_part"), "frames 0 to 4");
    EXPECT_EQ(row("roevo-ct").at("sequence_part"), "frames 6 to 11");
    EXPECT_LT(std::stod(row("roevo-ct").at("ground_truth_length_m")), 1.0);
    EXPECT_NE(row("roevo-ct").at("ground_truth_length_m"), row("roevo-tr").at("ground_truth_length_m"))
        << "of the part that was run";
    expectInAll(printed,
                "ROEVO CT: frames 6 to 11; ROEVO TR: frames 0 to 4: figures are not of the same frames");
    EXPECT_NE(row("roevo-tr").at("warning").find("not of the same frames"), std::string::npos);
    EXPECT_EQ(printed.find("  only frames"), std::string::npos) << printed;
    for (const char* words : {"Same frames for every", "same frames and", "the same frames for all",
                              "Only parts of these recordings were run", "only frames 0"})
        expectInNone(words);
}

TEST_F(MixedRows, OtherOptionsAreNamed) {
    const std::string input = clip("clip", 5);
    make(input, "roevo-tr", {"--set", "edges.canny_factor=4"});
    make(input, "roevo-ct");
    make(input, "distance-field");
    fs::create_directories(folder / "all");
    test::writeFile(folder / "all/config_used.ini", "of an earlier comparison");
    const std::string printed = report();
    EXPECT_FALSE(fs::exists(folder / "all/config_used.ini")) << "each row has its own";
    expectInAll(printed, "Runs of ROEVO differ in edges.canny");
    expectInAll(printed, "factor (1.5, 4)");
    EXPECT_NE(row("roevo-ct").at("warning").find("edges.canny_factor (1.5, 4)"), std::string::npos);
    for (const char* words : {"one configuration for all", "One configuration for all"}) expectInNone(words);
    EXPECT_NE(file("table.md").find("same frames for all"), std::string::npos);
}

TEST_F(MixedRows, WhatChangedSinceAnEarlierComparisonIsSaidEverywhere) {
    const std::string input = clip("clip", 5), before = folder / "before";
    make(input, "roevo-ct");
    fs::copy(output() + "/runs", before, fs::copy_options::recursive);
    expectInAll(report({"--baseline", before}), "Against the earlier comparison, ROEVO CT: median change");
    make(input, "roevo-ct", {"--first", "4"});
    expectInAll(report({"--baseline", before}), "Against the earlier comparison: no method was run on");
}

TEST_F(MixedRows, AllFramesOfARawlogAreNoPart) {
    const std::string input = clip("clip", 6), rawlog = folder / "clip.rawlog";
    ASSERT_EQ(test::runProgram("rgbd2rawlog", {"--input", input, "--output", rawlog}).exit_code, 0);
    make(rawlog, "roevo-ct", {"--first", "6"});
    make(rawlog, "roevo-tr", {"--first", "5", "--skip", "1"});
    make(rawlog, "distance-field", {"--first", "5"});
    report();
    EXPECT_EQ(row("roevo-ct").at("sequence_part"), "");
    EXPECT_EQ(row("roevo-tr").at("sequence_part"), "frames 1 to 5");
    EXPECT_EQ(row("distance-field").at("sequence_part"), "frames 0 to 4");
}

}  // namespace
}  // namespace roevo
