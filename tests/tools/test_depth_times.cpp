// Depth images with stamps of their own, through a rawlog and back.
#include <gtest/gtest.h>

#include "recordings/depth_times.h"
#include "tools/rawlog_tools_check.h"
#include "tools/small_tum_folder.h"

namespace roevo {
namespace {

namespace fs = std::filesystem;
using test::convert;
using test::convertBack;
using test::SmallTumFolder;

class DepthTimesFile : public ::testing::Test {
  protected:
    /// What rawlog2rgbd says; the folder is "back".
    std::string back(const std::string& rawlog = "o.rawlog") {
        fs::remove_all(output_ / "back");
        const auto outcome = convertBack(output_ / rawlog, output_ / "back");
        EXPECT_EQ(outcome.exit_code, 0) << outcome.all();
        return outcome.out;
    }
    void expectColoursTimes() const {
        const DatasetReader dataset = openDataset(output_ / "back");
        for (std::size_t i = 0; i < dataset.size(); i++)
            EXPECT_EQ(dataset.entry(i).depth_timestamp, dataset.entry(i).timestamp);
    }
    std::string times() const { return output_ / "o_depth_times.txt"; }

    SmallTumFolder input_{5};
    test::TemporaryFolder output_;
};

TEST_F(DepthTimesFile, GoesThereAndBack) {
    const auto there = convert(input_.path(), output_ / "o.rawlog");
    ASSERT_EQ(there.exit_code, 0) << there.all();
    EXPECT_CONTAINS(there.out, "times of the depth images: " + times());
    EXPECT_CONTAINS(test::readFile(times()),
                    "\n" + SmallTumFolder::stamp(1) + " " + SmallTumFolder::stamp(1, 0.004) + "\n");
    EXPECT_CONTAINS(back(), "times of the depth images: from " + times());
    test::expectSameDataset(input_.path(), output_ / "back");
    EXPECT_TRUE(fs::exists(output_ / ("back/" + SmallTumFolder::depthName(0)))) << "named as it was";
    EXPECT_EQ(openDataset(input_.path()).description().association.toText(),
              openDataset(output_ / "back").description().association.toText());
}

TEST_F(DepthTimesFile, HoldsTheFramesThatAreInTheRawlog) {
    const auto there = convert(input_.path(), output_ / "o.rawlog", {"--every", "2", "--from", "0.1"});
    ASSERT_EQ(there.exit_code, 0) << there.all();
    EXPECT_EQ(readDepthTimes(output_ / "o.rawlog").times.size(), 2u);
    back();
    const DatasetReader dataset = openDataset(output_ / "back");
    ASSERT_EQ(dataset.size(), 2u);
    EXPECT_EQ(dataset.entry(1).depth_timestamp, std::stod(SmallTumFolder::stamp(3, 0.004)));
}

TEST_F(DepthTimesFile, IsNotWrittenWhereAllAreAlike) {
    const std::string list = test::readFile(input_ / "depth.txt");
    std::string alike;
    for (int i = 0; i < 5; i++) alike += SmallTumFolder::stamp(i) + " " + SmallTumFolder::depthName(i) + "\n";
    input_.write("depth.txt", alike);
    const auto first = convert(input_.path(), output_ / "o.rawlog");
    ASSERT_EQ(first.exit_code, 0) << first.all();
    EXPECT_FALSE(fs::exists(times()));
    EXPECT_EQ(first.err.find("depth_times"), std::string::npos) << first.all();
    EXPECT_EQ(back().find("times of the depth"), std::string::npos);
    expectColoursTimes();

    test::writeFile(times(), "1 2\n");  // of an older rawlog
    const auto again = convert(input_.path(), output_ / "o.rawlog");
    EXPECT_CONTAINS(again.err, "warning: " + times() + " was there before and is not from this recording");
}

TEST_F(DepthTimesFile, OnesThatCannotBeUsedAreSaid) {
    ASSERT_EQ(convert(input_.path(), output_ / "o.rawlog").exit_code, 0);
    const std::string good = test::readFile(times());
    const auto stamps = [](int i, double later) {
        return SmallTumFolder::stamp(i) + " " + SmallTumFolder::stamp(i, later) + "\n";
    };
    const std::string rest = stamps(2, 0.004) + stamps(3, 0.004) + stamps(4, 0.004);
    const std::string said = "times of the depth images: those of colour, since " + times() + ":";
    const struct {
        std::string text, fault;
    } cases[] = {
        {good + "1 two\n", ":8: 'two' is not a number"},
        {good + "1 2 3\n", ":8: expected two time stamps, found 3 words"},
        {good + stamps(0, 0.005), ":8: this stamp was there before"},
        {good.substr(0, good.size() - 20), ":7: expected two time stamps, found 1 words"},
        {good.substr(0, good.rfind("\n", good.size() - 2) + 1), "it lacks 1 of the 5 frames"},
        {"", "it lacks 5 of the 5 frames: is it of another recording?"},
        {"1 1.004\n2 2.004\n", "it lacks 5 of the 5 frames: is it of another recording?"},
        {stamps(0, 0.104) + stamps(1, 0.004) + rest, "its depth stamps do not ascend"},
        {stamps(0, 0.004) + stamps(1, 0.05) + rest, "would pair its images in another way"},
    };
    for (const auto& each : cases) {
        test::writeFile(times(), each.text);
        const std::string out = back();
        EXPECT_CONTAINS(out, said);
        EXPECT_CONTAINS(out, each.fault);
        expectColoursTimes();
        EXPECT_EQ(openDataset(output_ / "back").size(), 5u);
    }
}

TEST_F(DepthTimesFile, MoreFramesThanTheRawlogHasDoNoHarm) {
    ASSERT_EQ(convert(input_.path(), output_ / "all.rawlog").exit_code, 0);
    ASSERT_EQ(convert(input_.path(), output_ / "o.rawlog", {"--to", "0.25"}).exit_code, 0);
    fs::copy_file(output_ / "all_depth_times.txt", times(), fs::copy_options::overwrite_existing);
    EXPECT_CONTAINS(back(), "times of the depth images: from ");
    EXPECT_EQ(openDataset(output_ / "back").entry(2).depth_timestamp,
              std::stod(SmallTumFolder::stamp(2, 0.004)));
}

TEST(DepthTimes, OtherImagesMayBeCloser) {
    // 0.019 is 1 ms from 0.018, so that the first frame would be left without a partner
    EXPECT_EQ(depthTimesFault({0.000, 0.019}, {0.004, 0.018}), "");
    EXPECT_NE(depthTimesFault({0.000, 0.019}, {0.018, 0.038}), "");
    EXPECT_NE(depthTimesFault({0, 1}, {0, std::nullopt}), "");
}

}  // namespace
}  // namespace roevo
