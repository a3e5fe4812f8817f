// What roevo-compare prints at its end, and what it says of how the runs were made.
#include <gtest/gtest.h>

#include <sstream>

#include "report_fixture.h"
#include "roevo-compare/comparison_notes.h"
#include "roevo-compare/terminal_table.h"

namespace roevo {
namespace {

using test::contains;
using test::count;
using test::failedRun;
using test::makeRun;
using test::makeSequence;

std::string lineWith(const std::string& text, const std::string& words) {
    std::istringstream in(text);
    for (std::string line; std::getline(in, line);)
        if (contains(line, words)) return line;
    return {};
}

TEST(TerminalTable, MarksTheBestAsTheReportDoes) {
    auto lost = makeRun("lost", 0.001);
    lost.tracked = 2;
    auto quick = makeRun("quick", 0.02);
    quick.total.median = 3.25;
    const std::string text =
        terminalTable({makeSequence("s", {makeRun("a", 0.01), quick, lost, failedRun("f", "it threw")})});
    EXPECT_TRUE(contains(lineWith(text, "label of a"), " 1.000* ")) << text;
    EXPECT_TRUE(contains(lineWith(text, "label of quick"), " 2.000  ")) << text;
    EXPECT_TRUE(contains(lineWith(text, "label of quick"), " 3.25* ")) << text;
    EXPECT_TRUE(contains(lineWith(text, "label of lost"), " 0.100  ")) << "too few frames\n" << text;
    EXPECT_TRUE(contains(lineWith(text, "label of lost"), " 50.0! ")) << "and why it is not the best\n"
                                                                      << text;
    EXPECT_TRUE(contains(text, "\n! tracked less than 90 %")) << text;
    EXPECT_TRUE(contains(lineWith(text, "  f"), "failed: it threw")) << text;
    EXPECT_EQ(lineWith(text, "label of a").size(), lineWith(text, "label of quick").size()) << text;
    EXPECT_TRUE(contains(text, "\n* the best")) << text;
    EXPECT_FALSE(contains(terminalTable({makeSequence("s", {makeRun("a", 0.01)})}), "*"))
        << "one alone is not the best";
    EXPECT_FALSE(contains(terminalTable({makeSequence("s", {makeRun("a", 0.01)})}), "!"));
}

TEST(TerminalTable, SaysWhatIsOddOnce) {
    auto sequence = makeSequence("s", {makeRun("a", 0.01), makeRun("b", 0.01)});
    for (MethodRun& run : sequence.runs) run.warnings = {"the file ends early"}, run.part = "frames 2 to 5";
    sequence.notes = {"3 images had no partner"};
    const std::string text = terminalTable({sequence});
    for (const char* words : {"the file ends early", "3 images had no partner", "only frames 2 to 5"})
        EXPECT_EQ(count(text, words), 1u) << words << " in " << text;
}

TEST(ComparisonNotes, NoneWhenAllWentWell) {
    auto fair = makeRun("a", 0.01);
    fair.core_lost = 0.04;
    EXPECT_EQ(comparisonNotes({makeSequence("s", {fair, makeRun("b", 0.01)})}), std::vector<std::string>());
}

TEST(ComparisonNotes, SayWhatCastsDoubtOnTheTimes) {
    auto disturbed = makeRun("a", 0.01), free = makeRun("b", 0.01);
    disturbed.core_lost = 0.31;
    free.not_pinned = "core 1: it is not allowed";
    const auto notes = comparisonNotes({makeSequence("s", {disturbed, free, makeRun("c", 0.01)})});
    ASSERT_EQ(notes.size(), 2u);
    EXPECT_TRUE(contains(notes[0], "in 1 of 3 runs")) << notes[0];
    EXPECT_TRUE(contains(notes[0], "more than 5 %") && contains(notes[0], "up to 31 %")) << notes[0];
    EXPECT_TRUE(contains(notes[1], "Not pinned: 1 of 3 runs")) << notes[1];
    EXPECT_TRUE(contains(notes[1], "core 1: it is not allowed")) << notes[1];
}

}  // namespace
}  // namespace roevo
