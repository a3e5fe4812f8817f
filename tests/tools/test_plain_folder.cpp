#include <gtest/gtest.h>

#include "recordings/dataset_reader.h"
#include "recordings/numbered_files.h"
#include "tools/small_dataset.h"

namespace roevo {
namespace {

namespace fs = std::filesystem;
using test::errorOf;
using test::SmallDataset;

/// Gives frame i's images another name.
void rename(const SmallDataset& folder, int i, const std::string& name) {
    fs::rename(folder / folder.colour(i), folder / ("rgb/" + name + ".png"));
    fs::rename(folder / folder.depth(i), folder / ("depth/" + name + ".png"));
}

std::vector<double> timesWithNames(const std::vector<std::string>& names, const std::string& camera = "") {
    const SmallDataset folder("plain", static_cast<int>(names.size()));
    for (std::size_t i = 0; i < names.size(); i++) rename(folder, static_cast<int>(i), names[i]);
    folder.writeCamera("5000", camera);
    const DatasetReader dataset = openDataset(folder.path());
    std::vector<double> times;
    for (std::size_t i = 0; i < dataset.size(); i++) times.push_back(dataset.entry(i).timestamp);
    return times;
}

TEST(PlainFolder, NamesTellTheTime) {
    using Times = std::vector<double>;
    EXPECT_EQ(timesWithNames({"1305031453.359684", "1305031453.4"}),
              (Times{1305031453.359684, 1305031453.4}));
    EXPECT_EQ(timesWithNames({"9", "10"}), (Times{0.3, 0.333333})) << "not in the order of the letters";
    EXPECT_EQ(timesWithNames({"frame_0003", "frame_0006"}), (Times{0.1, 0.2}));
    EXPECT_EQ(timesWithNames({"0003", "0006"}, "frame_rate: 10\n"), (Times{0.3, 0.6}));
    EXPECT_EQ(timesWithNames({"1305031453", "1305031454"}), (Times{1305031453, 1305031454}));
    EXPECT_EQ(timesWithNames({"1305031453359"}), (Times{1305031453.359}));
    EXPECT_EQ(timesWithNames({"1305031453359684"}), (Times{1305031453.359684}));
    EXPECT_EQ(timesWithNames({"1305031453359684123"}), (Times{1305031453.359684}));
    EXPECT_EQ(timesWithNames({"1305031453_359684123", "1305031454-000684123"}),
              (Times{1305031453.359684, 1305031454.000684}));
    EXPECT_EQ(timesWithNames({"a_Color_5000.25", "a_Color_5033.5"}), (Times{5.00025, 5.0335})) << "ms";
    EXPECT_EQ(timesWithNames({"0012.color", "0015.color"}), (Times{0.4, 0.5}));
    EXPECT_EQ(timesWithNames({"1000000", "1033333"}), (Times{1, 1.033333})) << "us of a device's clock";
}

TEST(PlainFolder, NamesWithSeveralNumbers) {
    using Times = std::vector<double>;
    const Times minute{1715949059.966667, 1715949060, 1715949060.033333};  // 2024-05-17 12:30:59.97 UTC
    EXPECT_EQ(timesWithNames({"20240517_123059_966667", "20240517_123100_000000", "20240517_123100_033333"}),
              minute);
    EXPECT_EQ(timesWithNames({"a-2024-05-17_12-30-59.966667", "a-2024-05-17_12-31-00.0",
                              "a-2024-05-17_12-31-00.033333"}),
              minute);
    EXPECT_EQ(timesWithNames({"20240517123059967", "20240517123100000"}),
              (Times{1715949059.967, 1715949060}));
    EXPECT_EQ(timesWithNames({"PXL_20240517_123059967", "PXL_20240517_123100000"}),
              (Times{1715949059.967, 1715949060}));
    EXPECT_EQ(timesWithNames({"20240517123059.967", "20240517123100.5"}),
              (Times{1715949059.967, 1715949060.5}));
    EXPECT_EQ(timesWithNames({"20240517_123059", "20240517_123100", "20240517_123102"}),
              (Times{1715949059, 1715949060, 1715949062}));
    EXPECT_EQ(timesWithNames({"20240517_123059_000003", "20240517_123059_000006", "20240517_123100_000009"}),
              (Times{0.1, 0.2, 0.3}))
        << "a count of six digits";
    EXPECT_EQ(timesWithNames({"20120800000000", "20120833333333", "20120866666666"}),
              (Times{20120.8, 20120.833333, 20120.866667}))
        << "ns since a machine was started";
    EXPECT_EQ(timesWithNames({"img_0_1305031453.5", "img_1_1305031453.6", "img_0_1305031453.7"}),
              (Times{1305031453.5, 1305031453.6, 1305031453.7}));
    EXPECT_EQ(timesWithNames({"exp8_00003", "exp12_00004", "exp6_00005"}), (Times{0.1, 0.133333, 0.166667}));
    EXPECT_EQ(timesWithNames({"1305031454_033333", "1305031453_966667", "1305031453_933333"}),
              (Times{1305031453.933333, 1305031453.966667, 1305031454.033333}));
    EXPECT_EQ(timesWithNames({"1305031453_966", "1305031454_033"}), (Times{1305031453.966, 1305031454.033}));
    EXPECT_EQ(timesWithNames({"frame_0003_640x480", "frame_0012_640x480"}), (Times{0.1, 0.4}));
    EXPECT_EQ(timesWithNames({"3_1305031453.5", "12_1305031453.6"}), (Times{1305031453.5, 1305031453.6}));
    EXPECT_EQ(timesWithNames({"20240517_123059_0003", "20240517_123100_0006"}), (Times{0.1, 0.2}))
        << "a number at a date's end";
}

TEST(PlainFolder, NamesThatDoNotTellWhichNumberCounts) {
    EXPECT_CONTAINS(errorOf([] { timesWithNames({"1_2", "2_1", "3_7"}); }), "which number in its name");
    EXPECT_CONTAINS(errorOf([] {
                        timesWithNames({"a_7", "b_7", "c_7", "d_8", "e_7"});
                    }),
                    "5 images like it have but 2 different times");
}

TEST(PlainFolder, KindsThatAreNumberedFromAnotherStart) {
    const SmallDataset folder("plain", 4);
    for (int i = 3; i >= 0; i--) {
        rename(folder, i, std::to_string(i));
        fs::rename(folder / ("rgb/" + std::to_string(i) + ".png"),
                   folder / ("rgb/" + std::to_string(i + 1) + ".png"));
    }
    EXPECT_CONTAINS(openDataset(folder.path()).summary(), "warning: as many colour as depth images, and one");
    folder.remove("rgb/4.png");
    EXPECT_EQ(openDataset(folder.path()).summary().find("warning: as many"), std::string::npos)
        << "the first depth image has no partner";
}

TEST(PlainFolder, AlignedDepthIsTakenBeforeWhatTheSensorSaw) {
    const SmallDataset folder("plain");
    fs::copy(folder / "depth", folder / "aligned_depth");
    EXPECT_CONTAINS(openDataset(folder.path()).entry(0).depth, "/aligned_depth/");
}

TEST(PlainFolder, AnAssumedRateIsSaid) {
    const SmallDataset folder("plain", 1);
    rename(folder, 0, "7");
    EXPECT_CONTAINS(openDataset(folder.path()).summary(), "frame numbers at 30 Hz (assumed; frame_rate");
    folder.writeCamera("5000", "frame_rate: 15\n");
    EXPECT_CONTAINS(openDataset(folder.path()).summary(), "frame numbers at 15 Hz");
    folder.writeCamera("5000", "frame_rate: 0\n");
    EXPECT_CONTAINS(errorOf([&] { openDataset(folder.path()); }), "frame_rate must be above 0");
}

TEST(PlainFolder, NamesThatTellNoTime) {
    const auto error = [](const std::string& first, const std::string& second) {
        return errorOf([&] { timesWithNames({first, second}); });
    };
    EXPECT_CONTAINS(error("left", "right"), "left.png: no time in its name");
    EXPECT_CONTAINS(error("7", "1305031453.5"), "some images are named by number, others by time");
    const SmallDataset folder("plain", 1);
    fs::rename(folder / folder.depth(0), folder / "depth/other7.png");
    EXPECT_CONTAINS(errorOf([&] { openDataset(folder.path()); }), "other7.png");
    folder.remove("depth/other7.png");
    EXPECT_CONTAINS(errorOf([&] { openDataset(folder.path()); }), "depth has no images in it");
}

TEST(PlainFolder, MayBeNamedFromWhereOneIs) {
    const SmallDataset folder("plain");
    const fs::path before = fs::current_path();
    fs::current_path(folder.parent().path());
    EXPECT_EQ(errorOf([] { openDataset("dataset").readFrame(2); }), "");
    fs::current_path(before);
}

TEST(PlainFolder, NoCameraFileIsAnErrorAndNeverADefault) {
    const SmallDataset folder("plain");
    folder.remove("camera.txt");
    EXPECT_CONTAINS(errorOf([&] { openDataset(folder.path()); }), "no intrinsics");
    EXPECT_CONTAINS(errorOf([&] { openDataset(folder.path()); }), "has no camera.txt; write it with width");
}

TEST(PlainFolder, ColourFolderMayHaveOtherNamesAndEndings) {
    for (const char* name : {"color", "colour", "images"}) {
        const SmallDataset folder("plain");
        fs::rename(folder / "rgb", folder / name);
        fs::copy(folder / folder.depth(0), folder / "depth/Thumbs.db");
        EXPECT_EQ(openDataset(folder.path()).size(), 3u);
    }
}

TEST(PlainFolder, WholeNumbers) {
    EXPECT_EQ(wholeNumber("000012"), 12);
    for (const char* none : {"", "-1", "1.5", "a1", "99999999999999999999"})
        EXPECT_FALSE(wholeNumber(none)) << none;
}

}  // namespace
}  // namespace roevo
