// The report of hundreds of recordings: distributions, failures, the worst ones, and what changed since an
// earlier comparison. Errors are known by construction.
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>

#include "report_fixture.h"
#include "roevo-compare/report/baseline.h"
#include "roevo-compare/report/distributions.h"

namespace roevo {
namespace {

using test::contains;
using test::count;
using test::failedRun;
using test::makeRun;
using test::makeSequence;
using test::WrittenComparison;

constexpr std::size_t kCount = kManySequences + 10;

std::string nameOf(std::size_t i) {
    return (i < 10 ? "r0" : "r") + std::to_string(i);
}

// ATE of roevo-ba: 0.1 cm, 0.2 cm, and so on, times a factor for each recording.
std::vector<SequenceComparison> many(double (*factor)(std::size_t)) {
    std::vector<SequenceComparison> sequences;
    for (std::size_t i = 0; i < kCount; ++i)
        sequences.push_back(makeSequence(
            nameOf(i),
            {makeRun("roevo-ba", 0.001 * static_cast<double>(i + 1) * factor(i)), makeRun("icp", 0.1)}));
    return sequences;
}
double one(std::size_t) {
    return 1;
}
// Up to 2 % about 1, as many above as below.
double noise(std::size_t i) {
    return std::exp(0.02 * std::sin(2.4 * static_cast<double>(i)));
}

TEST(ManyRecordings, TableHasQuantilesOfTheErrors) {
    auto sequences = many(one);
    sequences[3].runs[1] = failedRun("icp", "it died of signal 11 after 3 frames");
    const auto results = evaluateAll(sequences);
    const Table table = distributionTable(results, tableMethods(results));
    ASSERT_EQ(table.rows.size(), 2u);
    const auto& ours = table.rows[0].cells;
    EXPECT_EQ(ours[0].text, std::to_string(kCount));
    EXPECT_EQ(ours[1].text, "0");
    EXPECT_EQ(ours[2].text, "2.550") << "the median of 0.1 to 5.0";
    EXPECT_EQ(ours[3].text, "1.325");
    EXPECT_EQ(ours[4].text, "3.775");
    EXPECT_EQ(ours[6].text, "5.000");
    EXPECT_EQ(table.rows[1].cells[1].text, "1") << "a failure";
    EXPECT_EQ(table.rows[1].cells[2].text, "10.000");
}

TEST(ManyRecordings, ReasonsThatDifferInNumbersAreOne) {
    auto sequences = many(one);
    for (const std::size_t i : {1u, 5u, 7u})
        sequences[i].runs[1] =
            failedRun("icp", "it was not done within 1.5 s, ended after " + std::to_string(i) + " frames");
    sequences[9].runs[0] = failedRun("roevo-ba", "out of memory");
    const Table table = reasonTable(evaluateAll(sequences), 10);
    ASSERT_EQ(table.rows.size(), 2u);
    EXPECT_EQ(table.rows[0].cells[0].text, "3");
    EXPECT_EQ(table.rows[0].cells[1].text, "r01");
    EXPECT_TRUE(contains(table.rows[0].cells[2].text, "after 1 frames"));
    EXPECT_EQ(table.rows[1].cells[2].text, "failed: out of memory");
    EXPECT_TRUE(contains(reasonTable(evaluateAll(sequences), 1).protocol, "most frequent of 2"));
}

TEST(ManyRecordings, TheWorstAreThoseOfTheFullestMode) {
    const auto sequences = many(one);
    const auto results = evaluateAll(sequences);
    const auto worst = worstRecordings(results, 3);
    EXPECT_EQ(worst, (std::vector<std::size_t>{kCount - 1, kCount - 2, kCount - 3}));
    const std::vector<TableMethod> methods{TableMethod{"icp", "", ""}, TableMethod{"roevo-ba@thin", "", ""},
                                           TableMethod{"roevo-ct", "", ""}};
    EXPECT_EQ(leadingMethod(methods).name, "roevo-ba@thin");
}

TEST(ManyRecordings, ReportShowsDistributionsAndNotEachRecording) {
    auto sequences = many(one);
    sequences[2].runs[1] = failedRun("icp", "it <died>");
    for (std::size_t i = 0; i < sequences.size(); ++i)  // as rows that were read, but for the worst
        if (i + kWorstSequences < sequences.size()) {
            sequences[i].errors = evaluateRuns(sequences[i]);
            for (MethodRun& run : sequences[i].runs) run.trajectory.clear();
        }
    const WrittenComparison written(sequences);
    EXPECT_EQ(written.rows.size(), 2 * kCount) << "table.csv has all";
    EXPECT_NEAR(std::stod(written.row("r00", "roevo-ba").at("ate_rmse_m")), 0.001, 1e-9);
    for (const char* part :
         {"Distributions", "Failures", "The worst 10 recordings", "Ranking", "it &lt;died&gt;"})
        EXPECT_TRUE(contains(written.html, part)) << part;
    EXPECT_FALSE(contains(written.html, "r00"));
    for (std::size_t i = 0; i < kCount; ++i) {
        const bool is_worst = i + kWorstSequences >= kCount;
        const std::string page = "pages/" + nameOf(i) + ".html";
        EXPECT_EQ(contains(written.html, "href=\"" + page + "\""), is_worst) << page;
        EXPECT_EQ(std::filesystem::exists(written.path(page)), is_worst) << page;
    }
    EXPECT_TRUE(contains(test::readFile(written.path("pages/r45.html")), "Position error over time"));
    EXPECT_LT(written.md.size(), 10'000u);
    EXPECT_FALSE(contains(written.html + written.md, "nan"));
}

MethodChange changeOf(double (*before)(std::size_t), double (*now)(std::size_t)) {
    const auto old_ones = many(before), new_ones = many(now);
    return changesSince(evaluateAll(old_ones), evaluateAll(new_ones)).at(0);
}

TEST(Baseline, NoiseIsNoChange) {
    const MethodChange change = changeOf(one, noise);
    EXPECT_EQ(change.pairs.size(), kCount);
    EXPECT_NEAR(change.median, 1, 0.01);
    EXPECT_LE(change.low, 1);
    EXPECT_GE(change.high, 1);
    EXPECT_TRUE(change.better.empty() && change.worse.empty());
    EXPECT_STREQ(change.verdict(), "no difference");
    EXPECT_STREQ(changeOf(one, one).verdict(), "no difference");
}

TEST(Baseline, AChangeOfAllIsSeenAndIsNotOneOfSingleRecordings) {
    const MethodChange worse = changeOf(one, [](std::size_t i) { return 1.1 * noise(i); });
    EXPECT_NEAR(worse.median, 1.1, 0.01);
    EXPECT_STREQ(worse.verdict(), "worse");
    EXPECT_TRUE(worse.worse.empty()) << "none is out of the ordinary";
    EXPECT_STREQ(changeOf([](std::size_t i) { return 1.1 * noise(i); }, one).verdict(), "better");
}

TEST(Baseline, RecordingsThatStandOutAreNamedTheLargestChangeFirst) {
    const MethodChange change = changeOf(one, [](std::size_t i) {
        return i == 4 ? 2.0 : i == 7 ? 3.0 : i == 20 ? 0.4 : noise(i);
    });
    ASSERT_EQ(change.worse.size(), 2u);
    EXPECT_EQ(change.worse[0].sequence, "r07");
    EXPECT_NEAR(change.worse[0].ratio(), 3, 1e-6);
    EXPECT_EQ(change.worse[1].sequence, "r04");
    ASSERT_EQ(change.better.size(), 1u);
    EXPECT_EQ(change.better[0].sequence, "r20");
    EXPECT_STREQ(change.verdict(), "no difference");
    const Table table = changedRecordings(change, 1);
    ASSERT_EQ(table.rows.size(), 2u);
    EXPECT_EQ(table.rows[0].cells[2].text, "+200.0 %");
    EXPECT_EQ(table.rows[1].cells[2].text, "-60.0 %");
}

TEST(Baseline, FailuresThatCameAndWentAreNamed) {
    auto before = many(one), now = many(one);
    now[5].runs[0] = failedRun("roevo-ba", "it died");
    before[6].runs[0] = failedRun("roevo-ba", "it died");
    now.erase(now.begin());
    const MethodChange change = changesSince(evaluateAll(before), evaluateAll(now)).at(0);
    EXPECT_EQ(change.pairs.size(), kCount - 3);
    EXPECT_EQ(change.lost, std::vector<std::string>{"r05"});
    EXPECT_EQ(change.gained, std::vector<std::string>{"r06"});
    const Table table = changeTable(changesSince(evaluateAll(before), evaluateAll(now)));
    EXPECT_EQ(table.rows[0].cells[4].text, "1");
    EXPECT_EQ(table.rows[0].cells[5].text, "1");
    EXPECT_TRUE(changesSince({}, evaluateAll(now)).empty());
}

TEST(Baseline, PartsOfARecordingAreNotItsWhole) {
    const auto before = many(one);
    auto now = many(one);
    for (MethodRun& run : now[3].runs) run.part = "frames 0 to 59";
    const MethodChange change = changesSince(evaluateAll(before), evaluateAll(now)).at(0);
    EXPECT_EQ(change.pairs.size(), kCount - 1);
    EXPECT_TRUE(change.lost.empty() && change.gained.empty());
    EXPECT_EQ(changesSince(evaluateAll(now), evaluateAll(now)).at(0).pairs.size(), kCount);

    auto broken = many(one);  // a run that died does not know which part it was to be of
    broken[3].runs[0] = failedRun("roevo-ba", "it died");
    EXPECT_EQ(changesSince(evaluateAll(now), evaluateAll(broken)).at(0).lost,
              std::vector<std::string>{"r03"});
    EXPECT_EQ(changesSince(evaluateAll(broken), evaluateAll(now)).at(0).gained,
              std::vector<std::string>{"r03"});
}

TEST(Baseline, FewRecordingsProveNothing) {
    const std::vector<SequenceComparison> before{makeSequence("a", {makeRun("roevo-ba", 0.01)})},
        now{makeSequence("a", {makeRun("roevo-ba", 0.02)})};
    EXPECT_STREQ(changesSince(evaluateAll(before), evaluateAll(now)).at(0).verdict(), "too few to tell");
}

}  // namespace
}  // namespace roevo
