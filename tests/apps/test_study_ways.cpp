// Recordings backwards and from several starts, and what is told of accuracy and sigmas over all of them.
#include "recordings/reversed.h"
#include "study_fixture.h"
#include "ways.h"

namespace roevo {
namespace {

using test::MemorySource;
using test::sliding;

/// Frames that tell which they are: no pixels but the number.
std::vector<RgbdFrame> numbered(int count) {
    std::vector<RgbdFrame> frames;
    for (int i = 0; i < count; ++i)
        frames.push_back({100 + 0.1 * i, cv::Mat(1, 1, CV_8UC1, cv::Scalar(i)), {}, {}});
    return frames;
}

int numberOf(const SourceFrame& frame) {
    return frame.frame.grey.at<std::uint8_t>(0, 0);
}

TEST(ReversedFrames, ComeFromTheLastToTheFirst) {
    for (const int count : {1, 63, 64, 65, 200}) {
        int opened = 0;
        const auto source = reversedFrames(
            [&, count] {
                ++opened;
                return std::make_unique<MemorySource>(PinholeCamera(), numbered(count));
            },
            300);
        EXPECT_EQ(source->size(), static_cast<std::size_t>(count));
        int expected = count;
        for (SourceFrame frame; source->next(frame);) {
            ASSERT_EQ(numberOf(frame), --expected);
            EXPECT_NEAR(frame.timestamp, 200 - 0.1 * expected, 1e-9);
            EXPECT_EQ(frame.timestamp, frame.frame.timestamp);
            EXPECT_NEAR(frame.progress, 1 - static_cast<double>(expected) / count, 1e-9);
        }
        EXPECT_EQ(expected, 0);
        EXPECT_FALSE(source->skip());
        EXPECT_EQ(opened, 1 + (count + 63) / 64);
    }
}

TEST(ReversedFrames, SkipLeavesOutOneWhereverItIs) {
    const auto source = reversedFrames(
        [] { return std::make_unique<MemorySource>(PinholeCamera(), numbered(100), 40); }, 200);
    SourceFrame frame;
    std::vector<int> seen;
    int faults = 0;
    for (bool skip = true; skip ? source->skip() : source->next(frame); skip = !skip) {
        if (skip) continue;
        faults += !frame.fault.empty();
        seen.push_back(frame.fault.empty() ? numberOf(frame) : 40);
    }
    ASSERT_EQ(seen.size(), 50u);
    for (std::size_t i = 0; i < seen.size(); ++i) EXPECT_EQ(seen[i], 98 - 2 * static_cast<int>(i));
    EXPECT_EQ(faults, 1) << "a frame that cannot be read stays one";
}

TEST(ReversedFrames, PosesGoWithThem) {
    const std::vector<StampedPose> poses{
        {1, Pose(Eigen::Translation3d(1, 0, 0))}, {2, {}}, {4, Pose(Eigen::Translation3d(4, 0, 0))}};
    const auto reversed = reversedPoses(poses, 10);
    ASSERT_EQ(reversed.size(), 3u);
    EXPECT_EQ(reversed[0].timestamp, 6);
    EXPECT_EQ(reversed[0].T_world_camera.translation().x(), 4);
    EXPECT_EQ(reversed[2].timestamp, 9);
}

class StudyWays : public test::StudyFolder {
  protected:
    /// In mode tr alone, which is quick.
    static StudyInput tracked(const std::string& name, const testing::Sequence& sequence) {
        StudyInput quick = input(name, sequence, true);
        quick.modes = {Mode::kTracking};
        return quick;
    }
    static std::size_t column(const std::vector<std::vector<std::string>>& rows, const std::string& name) {
        const auto at = std::find(rows[0].begin(), rows[0].end(), name);
        EXPECT_NE(at, rows[0].end()) << name;
        return static_cast<std::size_t>(at - rows[0].begin());
    }
    static double number(const std::vector<std::vector<std::string>>& rows, std::size_t row,
                         const std::string& name) {
        return std::stod(rows.at(row).at(column(rows, name)));
    }
};

TEST_F(StudyWays, ForwardsAndBackwardsFromFiveStarts) {
    const testing::Sequence sequence = sliding(16);
    const StudyInput whole = input("a", sequence, true);
    const std::vector<Way> ways = waysThrough(whole);
    ASSERT_EQ(ways.size(), 10u);
    EXPECT_EQ(ways[0].name(), "forwards");
    EXPECT_EQ(ways[9].name(), "backwards from frame 12");
    for (const Way& way : ways) {
        const StudyInput part = along(whole, way);
        SourceFrame frame;
        ASSERT_TRUE(part.open()->next(frame));
        const std::size_t expected = way.backwards ? 15 - way.start : way.start;
        EXPECT_EQ(frame.frame.grey.data, sequence.frames[expected].grey.data) << way.name();
        const auto truth = poseAt(part.ground_truth, frame.timestamp);
        ASSERT_TRUE(truth);
        EXPECT_TRUE(truth->isApprox(sequence.truth[expected].T_world_camera, 1e-6)) << way.name();
    }
    const testing::Sequence brief = sliding(5);
    EXPECT_EQ(waysThrough(input("b", brief, true)).size(), 2u) << "too short for later starts";
}

TEST_F(StudyWays, SigmasArePooledOverAllWays) {
    const testing::Sequence sequence = sliding(36), brief = sliding(8);
    StudyInput noisy = tracked("noisy", brief);
    noisy.truth_noise = {1, 1};
    const StudyReport report = studySigmas({tracked("a", sequence), noisy}, folder());
    EXPECT_TRUE(exists("sigmas.svg"));
    const auto pooled = table("sigmas.csv"), runs = table("sigmas_runs.csv");
    ASSERT_EQ(pooled.size(), 1u + 2 * 3);
    ASSERT_EQ(runs.size(), 1u + (10 + 4) * 3);
    for (std::size_t k = 0; k < 3; ++k) {
        EXPECT_EQ(pooled[1 + k][column(pooled, "way")], "all");
        double motions = 0;
        for (std::size_t way = 0; way < 10; ++way) motions += number(runs, 1 + 3 * way + k, "motions");
        EXPECT_EQ(number(pooled, 1 + k, "motions"), motions);
    }
    EXPECT_EQ(number(pooled, 3, "motions"), 2 * (35 + 32 + 29 + 26 + 23)) << "from the start";
    EXPECT_EQ(number(pooled, 2, "motions"), 0) << "shorter than 3 s";
    EXPECT_EQ(pooled[2][column(pooled, "nees")], "");
    for (const std::size_t row : {1u, 3u}) {
        EXPECT_GT(number(pooled, row, "nees"), 0.05);
        EXPECT_LT(number(pooled, row, "nees"), 10);
        EXPECT_LE(number(pooled, row, "inside_95"), 1);
    }
    EXPECT_LT(number(pooled, 6, "nees"), 1e-3) << "a truth that errs by a metre";
    EXPECT_NE(report.table.find("| a | tr | "), std::string::npos) << report.table;
}

TEST_F(StudyWays, ErrorsOfTheTrajectoryRaiseTheNees) {
    testing::Sequence sequence = sliding(20);
    for (StampedPose& pose : sequence.truth) pose.T_world_camera.translation() *= 1.3;
    studySigmas({tracked("a", sequence)}, folder());
    EXPECT_GT(number(table("sigmas.csv"), 3, "nees_translation"), 20);
}

TEST_F(StudyWays, TheDistributionTellsMedianRangeAndRefusals) {
    const testing::Sequence sequence = sliding(22);
    StudyInput mapped = input("a", sequence, true);
    mapped.modes = {Mode::kBundleAdjustment, Mode::kTracking};
    // No two observations agree so well: every edge is rejected, and keyframes stay as they were
    mapped.options.mapping.max_spread = 0.01;
    mapped.options.keyframe.max_translation = 0.01;
    mapped.options.motion.smooth = false;  // so that in tr final poses are the live ones
    const StudyReport report = studyDistribution({mapped}, folder());
    EXPECT_TRUE(exists("distribution.svg"));
    const auto pooled = table("distribution.csv"), runs = table("distribution_runs.csv");
    ASSERT_EQ(pooled.size(), 3u);
    ASSERT_EQ(runs.size(), 1u + 2 * 10);
    for (std::size_t mode = 0; mode < 2; ++mode) {
        std::vector<double> ates, ratios;
        double refusals = 0;
        for (std::size_t way = 0; way < 10; ++way) {
            const std::size_t row = 1 + 10 * mode + way;
            ates.push_back(number(runs, row, "ate_m"));
            ratios.push_back(number(runs, row, "final_over_live"));
            EXPECT_NEAR(ratios.back(), ates.back() / number(runs, row, "ate_live_m"), 1e-4);
            refusals += number(runs, row, "refusals");
        }
        std::sort(ates.begin(), ates.end());
        EXPECT_EQ(number(pooled, 1 + mode, "ate_least_m"), ates.front());
        EXPECT_EQ(number(pooled, 1 + mode, "ate_largest_m"), ates.back());
        EXPECT_NEAR(number(pooled, 1 + mode, "ate_median_m"), (ates[4] + ates[5]) / 2, 1e-8);
        EXPECT_EQ(number(pooled, 1 + mode, "final_over_live_worst"),
                  *std::max_element(ratios.begin(), ratios.end()));
        EXPECT_EQ(number(pooled, 1 + mode, "refusals"), refusals);
        EXPECT_EQ(number(pooled, 1 + mode, "failed"), 0);
        EXPECT_EQ(number(pooled, 1 + mode, "tracked_least"), 1);
    }
    EXPECT_GT(number(pooled, 1, "refusals"), 0);
    EXPECT_NE(pooled[1][column(pooled, "refusal_reasons")].find("too few observations fit the map: "),
              std::string::npos);
    EXPECT_EQ(number(pooled, 2, "refusals"), 0) << "tr has no map";
    EXPECT_EQ(number(pooled, 2, "final_over_live_worst"), 1);
    EXPECT_NE(report.summary.find("20 runs, 0 without errors"), std::string::npos) << report.summary;
}

TEST_F(StudyWays, WithoutATruthARecordingIsLeftOut) {
    const testing::Sequence sequence = sliding(8);
    StudyInput late = tracked("late", sequence);
    for (StampedPose& pose : late.ground_truth) pose.timestamp += 100;
    StudyInput none = input("none", sequence, false);
    none.modes = {Mode::kTracking};
    for (const Experiment study : {studySigmas, studyDistribution}) {
        const StudyReport report = study({none, late, tracked("a", sequence)}, folder());
        ASSERT_EQ(report.left_out.size(), 2u);
        EXPECT_EQ(report.left_out[0].name, "none");
        EXPECT_EQ(report.left_out[0].reason, "no ground truth was found");
        EXPECT_EQ(report.left_out[1].name, "late");
        EXPECT_THROW(study({none}, folder()), std::runtime_error);
    }
}

}  // namespace
}  // namespace roevo
