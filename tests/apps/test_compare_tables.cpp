// table.csv, table.md, ranks and what stands in place of figures.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>

#include "programs/text.h"
#include "report_fixture.h"
#include "roevo-compare/report/ranking.h"
#include "roevo-compare/report/remarks.h"
#include "roevo-compare/report/tables.h"

namespace roevo {
namespace {

using test::contains;
using test::failedRun;
using test::makeRun;
using test::makeSequence;
using test::skippedRun;
using test::WrittenComparison;

TEST(ReportText, EscapesAndNumbers) {
    EXPECT_EQ(csvField("a,b \"c\"\nd"), "\"a,b \"\"c\"\" d\"");
    EXPECT_EQ(csvField("plain"), "plain");
    EXPECT_EQ(htmlText("<a href='x'>&\"ü"), "&lt;a href=&#39;x&#39;&gt;&amp;&quot;ü");
    EXPECT_EQ(markdownText("a|b_c*d<e>"), "a\\|b\\_c\\*d\\<e\\>");
    EXPECT_EQ(cleanText("a\x01\xC3\xBC\xFF\xED\xA0\x80"), "a ü\uFFFD\uFFFD\uFFFD\uFFFD")
        << "lone bytes, a surrogate";
    EXPECT_EQ(shownNumber(1.23456, 3), "1.235");
    EXPECT_EQ(shownNumber(std::nan(""), 3), "–");
    EXPECT_EQ(exactNumber(0.1), "0.1");
    EXPECT_EQ(exactNumber(std::numeric_limits<double>::infinity()), "");
    EXPECT_EQ(shortened("größer als", 5), "größ…");
}

TEST(CompareTable, HasErrorsThatAreKnownInTheirUnits) {
    const WrittenComparison out({makeSequence("s", {makeRun("a", 0.01)})});
    ASSERT_EQ(out.rows.size(), 1u);
    auto row = out.row("s", "a");
    const auto number = [&](const char* column) { return std::stod(row.at(column)); };
    for (const char* figure : {"rmse", "mean", "median", "max"})
        EXPECT_NEAR(number(("ate_" + std::string(figure) + "_m").c_str()), 0.01, 1e-12) << figure;
    EXPECT_NEAR(number("ate_std_m"), 0, 1e-12);
    EXPECT_EQ(number("ate_count"), 4);
    EXPECT_NEAR(number("rpe_frame_translation_rmse_m"), 0.02, 1e-12);
    EXPECT_NEAR(number("rpe_second_translation_rmse_m_per_s"), 0, 1e-12);
    EXPECT_EQ(number("rpe_second_translation_count"), 2);
    EXPECT_NEAR(number("rpe_second_rotation_rmse_deg_per_s"), 0, 1e-12);
    EXPECT_NEAR(number("rpe_frame_rotation_rmse_deg"), 0, 1e-12);
    EXPECT_EQ(number("tracked_share"), 1);
    EXPECT_EQ(number("time_total_median_ms"), 6.5);
    EXPECT_EQ(number("time_total_p95_ms"), 9);
    EXPECT_EQ(number("time_decode_median_ms"), 5);
    EXPECT_EQ(number("time_stage_fine_p95_ms"), 6);
    EXPECT_EQ(number("processor_time_per_frame_ms"), 7.25);
    EXPECT_EQ(number("memory_peak_mb"), 120);
    EXPECT_EQ(number("ground_truth_length_m"), 6);
    EXPECT_EQ(row.at("status"), "ok");
    EXPECT_EQ(row.at("no_errors_because"), "");
    EXPECT_TRUE(contains(out.md, "| 1.000 |")) << "centimetres:\n" << out.md;
    EXPECT_FALSE(contains(out.md, "**1.000**")) << "one method alone is not the best";
}

TEST(CompareTable, RanksWithTiesAndRunsThatLostFramesBehind) {
    auto lost = makeRun("lost", 0.001);  // the smallest error, but of half the frames
    lost.tracked = 2;
    const WrittenComparison out(
        {makeSequence("s", {makeRun("a", 0.02), makeRun("b", 0.01), makeRun("c", 0.01), lost,
                            failedRun("f", "it threw"), skippedRun("l", "no such library")})});
    const auto rank = [&](const char* method) { return out.row("s", method).at("rank_ate"); };
    EXPECT_EQ(rank("b"), "1");
    EXPECT_EQ(rank("c"), "1");
    EXPECT_EQ(rank("a"), "3");
    EXPECT_EQ(rank("lost"), "4");
    EXPECT_EQ(rank("f"), "");
    EXPECT_EQ(rank("l"), "");
    EXPECT_EQ(out.row("s", "lost").at("status"), "incomplete");
    EXPECT_EQ(out.row("s", "f").at("status"), "failed");
    EXPECT_EQ(out.row("s", "f").at("reason"), "it threw");
    for (const char* column : {"frames_tracked", "frames_rejected"})
        EXPECT_EQ(out.row("s", "f").at(column), "") << "nobody counted";
    EXPECT_EQ(out.row("s", "l").at("status"), "skipped");
    EXPECT_EQ(out.row("s", "l").at("no_errors_because"), "skipped: no such library");

    EXPECT_TRUE(contains(out.md, "| label of b | **1.000** |") &&
                contains(out.md, "| label of c | **1.000** |"));
    EXPECT_TRUE(contains(out.md, "| label of lost | 0.100[^")) << "marked, not bold:\n" << out.md;
    EXPECT_TRUE(contains(out.md, ": tracked 50.0 % of the frames only"));
    EXPECT_TRUE(contains(out.md, ": failed: it threw") && contains(out.md, ": skipped: no such library"));
}

TEST(CompareTable, NinetyPercentOfAllFramesAreEnoughAndRefusedOnesLowerIt) {
    auto run = makeRun("a", 0.01);
    run.frames = 100;
    run.rejected = 10;
    run.tracked = 90;
    auto fewer = run;
    fewer.method = "b";
    fewer.tracked = 89;
    const WrittenComparison out({makeSequence("s", {run, fewer})});
    EXPECT_EQ(out.row("s", "a").at("status"), "ok");
    EXPECT_EQ(out.row("s", "a").at("tracked_share"), "0.9");
    EXPECT_EQ(out.row("s", "b").at("status"), "incomplete");
    EXPECT_EQ(out.row("s", "a").at("rank_ate"), "1");
    EXPECT_EQ(out.row("s", "b").at("rank_ate"), "2") << "same error, fewer frames";
}

TEST(CompareTable, SaysWhyThereAreNoErrorsAndKeepsTheRest) {
    auto without = makeSequence("without", {makeRun("a", 0.01)});
    without.reference.clear();
    without.ground_truth.clear();
    auto faulty = without;
    faulty.name = "faulty";
    faulty.ground_truth_fault = "gt.txt:3: found 3 numbers";
    auto elsewhere = makeSequence("elsewhere", {makeRun("a", 0.01)});
    for (StampedPose& pose : elsewhere.reference) pose.timestamp += 250;
    auto one = makeSequence("one", {makeRun("a", 0.01)});
    one.runs[0].trajectory.resize(1);
    one.runs[0].frames = one.runs[0].tracked = 1;
    auto none = makeSequence("none", {makeRun("a", 0.01)});
    none.runs[0].trajectory.clear();
    none.runs[0].tracked = 0;
    const WrittenComparison out({without, faulty, elsewhere, one, none});
    ASSERT_EQ(out.rows.size(), 5u);

    const auto why = [&](const char* sequence) { return out.row(sequence, "a").at("no_errors_because"); };
    EXPECT_EQ(why("without"), "no ground truth");
    EXPECT_EQ(why("faulty"), "gt.txt:3: found 3 numbers");
    for (const char* words :
         {"1250.000000 s to 1251.500000 s", "1000.000000 s to 1001.500000 s", "add 250.000000 s"})
        EXPECT_TRUE(contains(why("elsewhere"), words)) << words << " in " << why("elsewhere");
    EXPECT_TRUE(contains(why("one"), "only 1 pose has")) << why("one");
    EXPECT_EQ(why("none"), "the method gave no pose");
    for (const auto& row : out.rows) {
        EXPECT_EQ(row.at("ate_rmse_m"), "");
        EXPECT_EQ(row.at("rank_ate"), "");
        if (row.at("sequence") != "none") {
            EXPECT_EQ(row.at("time_total_median_ms"), "6.5") << row.at("sequence");
        }
    }
    EXPECT_TRUE(contains(out.md, "No method could be ranked"));
    EXPECT_TRUE(contains(out.md, "elsewhere: no run could be compared with its ground truth: no pose has"));
    for (std::size_t n = 1; contains(out.md, "[^" + std::to_string(n) + "]"); ++n)
        EXPECT_TRUE(contains(out.md, "\n[^" + std::to_string(n) + "]: ")) << "footnote " << n;
    EXPECT_TRUE(contains(out.md, ": ranked on no sequence"));
    EXPECT_EQ(test::count(out.md, "| mean |"), 5u) << "of shares, times and memory, but of no error";
}

TEST(CompareTable, TheVerdictNamesAllThatAreAhead) {
    const auto verdictOf = [](const std::vector<double>& errors) {
        std::vector<MethodRun> runs;
        for (std::size_t i = 0; i < errors.size(); ++i)
            runs.push_back(makeRun(std::string(1, static_cast<char>('a' + i)), errors[i]));
        const auto sequence = makeSequence("s", runs);
        return verdict(evaluateAll({sequence}));
    };
    const std::string rest = " the smallest ATE on 1 of 1 sequence that could be ranked.";
    EXPECT_EQ(verdictOf({0.02, 0.01}), "label of b has" + rest);
    EXPECT_EQ(verdictOf({0.01, 0.01, 0.02}), "label of a and label of b each have" + rest);
    EXPECT_EQ(verdictOf({0.01, 0.01, 0.01}), "label of a, label of b and label of c each have" + rest);
}

TEST(CompareTable, MeansAreOverSequencesWithFigures) {
    auto without = makeSequence("u", {makeRun("a", 0.01), makeRun("b", 0.01)});
    without.reference.clear();
    const WrittenComparison out({makeSequence("s", {makeRun("a", 0.01), makeRun("b", 0.05)}),
                                 makeSequence("t", {makeRun("a", 0.03), failedRun("b", "it threw")}),
                                 without});
    EXPECT_TRUE(contains(out.md, "| s | t | u | mean of 2 |"));
    EXPECT_TRUE(contains(out.md, "| label of a | **1.000** | 3.000 | –[^1] | 2.000 |")) << out.md;
    EXPECT_TRUE(contains(out.md, ": no mean where a sequence is missing")) << "b";
}

TEST(CompareTable, ASequenceThatFailedIsARow) {
    auto bad = makeSequence("bad", {});
    bad.failure = "cannot read it";
    const WrittenComparison out({makeSequence("good", {makeRun("a", 0.01)}), bad});
    ASSERT_EQ(out.rows.size(), 2u);
    EXPECT_EQ(out.row("bad", "").at("reason"), "cannot read it");
    EXPECT_EQ(out.row("bad", "").at("status"), "failed");
    EXPECT_TRUE(contains(out.md, "bad: nothing could be run on it: cannot read it"));
    EXPECT_TRUE(contains(out.html, "bad: nothing could be run on it: cannot read it"));
}

TEST(CompareTable, EverythingFailed) {
    const WrittenComparison out(
        {makeSequence("s", {failedRun("a", "signal 11"), failedRun("b", "signal 6")})});
    ASSERT_EQ(out.rows.size(), 2u);
    EXPECT_TRUE(contains(out.md, "No method could be ranked"));
    const WrittenComparison nothing({});
    EXPECT_TRUE(contains(nothing.html, "No method could be ranked"));
}

TEST(CompareTable, NumbersThatAreNoneAreLeftOut) {
    const double nan = std::nan(""), infinity = std::numeric_limits<double>::infinity();
    auto run = makeRun("a", 0.01);
    run.trajectory[2].T_world_camera.translation().y() = nan;
    run.total = {"total", nan, infinity, -infinity};
    run.stages[0].mean = infinity;
    run.memory_peak_mb = nan;
    run.cpu_ms_per_frame = nan;
    const WrittenComparison out({makeSequence("s", {run, makeRun("b", 0.01)})});
    EXPECT_EQ(out.row("s", "a").at("no_errors_because"), "a pose is not a number");
    for (const char* column : {"ate_rmse_m", "time_total_median_ms", "time_total_p95_ms", "memory_peak_mb"})
        EXPECT_EQ(out.row("s", "a").at(column), "") << column;
    EXPECT_EQ(out.row("s", "b").at("rank_ate"), "1");
    EXPECT_FALSE(contains(out.md, "**–")) << "a dash is never the best";
}

TEST(CompareTable, ErrorsBeyondAllNumbersAreNone) {
    auto run = makeRun("a", 0.01);
    run.trajectory[2].T_world_camera.translation().x() = 1e200;
    const WrittenComparison out({makeSequence("s", {run, makeRun("b", 0.01)})});
    EXPECT_EQ(out.row("s", "a").at("no_errors_because"), "its errors are too large to be computed");
    EXPECT_EQ(out.row("s", "a").at("ate_rmse_m"), "");
    EXPECT_EQ(out.row("s", "b").at("rank_ate"), "1");
}

TEST(CompareTable, OddNamesStayInTheirFields) {
    const std::string name = "a,b \"c\" <d> & 'é' | *e*_f_\ng";
    auto run = makeRun("m", 0.01);
    run.label = name;
    run.note = "line one\r\nline two, with comma";
    const WrittenComparison out({makeSequence(name, {run})});
    ASSERT_EQ(out.rows.size(), 1u);
    EXPECT_EQ(out.rows[0].count(""), 0u) << "as many fields as the head:\n" << out.csv;
    EXPECT_EQ(out.rows[0].at("sequence"), "a,b \"c\" <d> & 'é' | *e*_f_ g");
    EXPECT_EQ(out.rows[0].at("note"), "line one  line two, with comma");
    EXPECT_EQ(std::count(out.csv.begin(), out.csv.end(), '\n'), 2) << "a line per row";
    EXPECT_TRUE(contains(out.md, "\\<d\\> \\& 'é' \\| \\*e\\*\\_f\\_ g"));
}

TEST(CompareTable, SaysWhenMethodsHadDifferentFrames) {
    auto fewer = makeRun("b", 0.01);
    fewer.frames = fewer.tracked = 3;
    const WrittenComparison out({makeSequence("s", {makeRun("a", 0.01), fewer})});
    EXPECT_TRUE(contains(out.md, "given 3 to 4 frames")) << out.md;
    EXPECT_TRUE(contains(out.html, "given 3 to 4 frames"));
}

TEST(CompareTable, ManySequencesAreRows) {
    std::vector<SequenceComparison> sequences;
    for (int i = 0; i < 9; ++i)
        sequences.push_back(makeSequence("seq" + std::to_string(i), {makeRun("a", 0.01 + 0.001 * i)}));
    sequences[3].paper_ate_cm = 1.234;
    const WrittenComparison out(sequences);
    EXPECT_TRUE(contains(out.md, "| seq3 | 1.300 | 1.234 |")) << "the paper's figure beside ours:\n"
                                                              << out.md;
    EXPECT_TRUE(contains(out.md, "| mean | 1.400 |"));
    EXPECT_EQ(out.row("seq3", "a").at("paper_roevo_ba_ate_cm"), "1.234");
}

TEST(CompareTable, SaysOfWhichFramesThePapersFiguresAre) {
    auto whole = makeSequence("whole", {makeRun("a", 0.01)}),
         part = makeSequence("part", {makeRun("a", 0.01)});
    whole.paper_ate_cm = 1.5;
    part.runs[0].part = "frames 10 to 24";
    const std::string words = "The paper's figures are by its own protocol, of whole sequences";
    EXPECT_TRUE(contains(WrittenComparison({whole, part}).md, words + ".")) << "the part has none";
    part.paper_ate_cm = 2.5;
    EXPECT_TRUE(contains(WrittenComparison({whole, part}).md,
                         words + "; that of part, as ours, of its frames 10 to 24."));
}

TEST(Remarks, OptionsOfVariantsAreMeantToDiffer) {
    auto plain = makeRun("roevo-tr", 0.01), few = makeRun("roevo-tr@few", 0.01), foreign = makeRun("a", 0.01);
    plain.config = "[edges]\n; a note = 3\ncanny_factor = 1.5\n";
    few.config = foreign.config = "[edges]\ncanny_factor = 4\n";
    std::vector<SequenceComparison> sequences{makeSequence("s", {plain, few, foreign})};
    EXPECT_EQ(optionsRemark(evaluateAll(sequences)), std::nullopt);
    auto coarse = makeRun("roevo-ct", 0.01);  // the mode is the method's
    coarse.config = "[odometry]\nmode = ct\n" + plain.config;
    sequences.push_back(makeSequence("modes", {coarse, plain}));
    plain.config += "[odometry]\nmode = tr\n[map]\nnew_option = 1\n";  // of a later version
    sequences.push_back(makeSequence("t", {plain}));
    EXPECT_EQ(optionsRemark(evaluateAll(sequences)), std::nullopt);
    few.config = "[edges]\ncanny_factor = 3\n";
    sequences.push_back(makeSequence("u", {few}));
    EXPECT_TRUE(contains(*optionsRemark(evaluateAll(sequences)), "differ in edges.canny_factor@few (3, 4):"));
    EXPECT_FALSE(conditionsOf(evaluateAll(sequences)).config);
    const std::string csv = WrittenComparison(sequences).csv;  // although no recording has both
    EXPECT_TRUE(contains(csv, "Runs of ROEVO differ in edges.canny_factor@few (3, 4)"));
    EXPECT_FALSE(contains(csv, "one configuration for all"));
}

TEST(CompareTable, RunsThatAreNotPinnedAreNotSaidToBeOnOneCore) {
    auto pinned = makeSequence("pinned", {makeRun("a", 0.01)}),
         free = makeSequence("free", {makeRun("a", 0.01)});
    free.runs[0].not_pinned = "core 1: it is not allowed";
    const WrittenComparison good({pinned}), out({pinned, free});
    EXPECT_FALSE(contains(good.md, "Not pinned") || contains(good.html, "Not pinned"));
    for (const std::string* text : {&out.md, &out.html}) {
        EXPECT_TRUE(contains(*text, "Not pinned: not every run was bound to one core. Times per frame"));
        EXPECT_TRUE(contains(*text, "Not pinned to one core, reading and decoding apart"));
        EXPECT_FALSE(contains(*text, "One processor core for each run"));
    }
    EXPECT_EQ(out.row("free", "a").at("not_pinned"), "core 1: it is not allowed");
    EXPECT_TRUE(contains(out.row("free", "a").at("protocol"), "Not pinned"));
    EXPECT_FALSE(contains(out.row("pinned", "a").at("protocol"), "Not pinned"));
}

// The figures of the paper's ATE tables in our ranking. Its own rank table says 13, 15, 18 for ROEVO and
// slightly other numbers for the others; these follow from its own figures (counted by a script of its own).
TEST(Ranking, OfThePapersFigures) {
    const auto list = nlohmann::json::parse(
        test::readFile(std::string(ROEVO_SOURCE_DIR) + "/datasets_readme/sequences.json"));
    const std::vector<std::string> names{"ORB-SLAM3-LM", "ManhattanSLAM", "RE-SLAM",    "DROID-SLAM",
                                         "PHOTO-SLAM",   "MAST3R-SLAM",   "ROEVO-TR+BA"};
    std::vector<SequenceComparison> sequences;
    for (const auto& entry : list["sequences"]) {
        SequenceComparison sequence;
        sequence.name = entry["name"];
        for (const std::string& name : names) sequence.runs.push_back(makeRun(name, 0));
        sequences.push_back(sequence);
    }
    std::vector<SequenceResults> results;
    for (std::size_t s = 0; s < sequences.size(); ++s) {
        results.push_back({&sequences[s], {}});
        for (const std::string& name : names) {
            EvaluatedRun run;
            const auto& ate = list["sequences"][s]["paper"]["ate_cm"];
            if (ate.contains(name) && ate[name].is_number()) {
                run.evaluation.emplace();
                run.evaluation->ate.translation.rmse = ate[name].get<double>() / 100;
                run.evaluation->ate.translation.count = 1;
            } else {
                run.fault = "no figure";
            }
            results.back().evaluated.push_back(run);
        }
    }
    const auto rows = rankTable(shownMetrics().front(), results, tableMethods(results));
    const std::array<int, 3> expected[] = {{3, 10, 14}, {1, 7, 8}, {1, 2, 7},   {3, 5, 8},
                                           {4, 9, 15},  {0, 0, 2}, {12, 15, 18}};
    ASSERT_EQ(rows.size(), names.size());
    for (std::size_t i = 0; i < rows.size(); ++i) {
        EXPECT_EQ(rows[i].top, expected[i]) << rows[i].method.name;
        EXPECT_EQ(rows[i].sequences, 24);
    }
}

TEST(Ranking, FailuresAreLastAndSkippedMethodsAreNotRanked) {
    const std::vector<SequenceComparison> sequences{
        makeSequence("s", {makeRun("roevo-tr", 0.02), makeRun("roevo-ba", 0.01), makeRun("x", 0.03),
                           failedRun("y", "it threw"), skippedRun("z", "no such library")}),
        makeSequence("t", {makeRun("roevo-tr", 0.02), makeRun("roevo-ba", 0.04), makeRun("x", 0.03)})};
    const auto results = evaluateAll(sequences);
    const auto rows = rankTable(shownMetrics().front(), results, tableMethods(results));
    const auto of = [&](const char* name) {
        return *std::find_if(rows.begin(), rows.end(),
                             [&](const RankRow& r) { return r.method.name == name; });
    };
    EXPECT_EQ(of("roevo-ba").top, (std::array<int, 3>{1, 1, 2}));
    EXPECT_DOUBLE_EQ(of("roevo-ba").mean_rank, 2);
    EXPECT_DOUBLE_EQ(of("roevo-tr").mean_rank, 1.5);
    EXPECT_EQ(of("y").failures, 1);
    EXPECT_DOUBLE_EQ(of("y").mean_rank, 4);
    EXPECT_EQ(of("z").sequences, 0);

    // One ROEVO, the fullest: its other mode takes no place
    const auto one = oneRoevo(tableMethods(results));
    ASSERT_EQ(one.size(), 4u);
    EXPECT_EQ(one[0].name, "roevo-ba");
    EXPECT_EQ(rankTable(shownMetrics().front(), results, one)[1].top, (std::array<int, 3>{1, 2, 2})) << "x";
}

}  // namespace
}  // namespace roevo
