// What can be wrong with a dataset, for every layout alike: one clear line, or the rest is read.
#include <gtest/gtest.h>
#include <unistd.h>

#include <opencv2/core.hpp>
#include <sstream>

#include "recordings/dataset_reader.h"
#include "tools/small_dataset.h"

namespace roevo {
namespace {

namespace fs = std::filesystem;
using test::errorOf;
using test::SmallDataset;

std::string openError(const SmallDataset& folder, const std::string& format = "auto") {
    const std::string error = errorOf([&] { openDataset(folder.path(), {format, 0.02}); });
    EXPECT_EQ(error.find('\n'), std::string::npos) << error;
    EXPECT_EQ(error.find("filesystem error"), std::string::npos) << error;
    return error;
}

/// Files are read without root's privileges while this lives.
class AsNobody {
  public:
    AsNobody() {
        if (root_) {
            EXPECT_EQ(seteuid(65534), 0);
        }
    }
    ~AsNobody() {
        if (root_) {
            EXPECT_EQ(seteuid(0), 0);
        }
    }

  private:
    bool root_ = geteuid() == 0;
};

class AnyLayout : public testing::TestWithParam<const char*> {
  protected:
    std::string layout() const { return GetParam(); }
};
class ListLayout : public AnyLayout {};

const auto kNames = [](const auto& info) {
    return std::string(info.param) == "7scenes" ? "sevenscenes" : std::string(info.param);
};
INSTANTIATE_TEST_SUITE_P(Layouts, AnyLayout, testing::Values("tum", "icl", "eth3d", "7scenes", "plain"),
                         kNames);
INSTANTIATE_TEST_SUITE_P(Layouts, ListLayout, testing::Values("tum", "icl", "eth3d"), kNames);

TEST_P(AnyLayout, IsRecognisedAndRead) {
    const SmallDataset folder(layout());
    const DatasetReader dataset = openDataset(folder.path());
    EXPECT_EQ(dataset.description().format, layout());
    ASSERT_EQ(dataset.size(), 3u);
    EXPECT_EQ(dataset.camera(), (PinholeCamera{64, 48, 60, 61, 31.5, 23.5, {}}));
    ASSERT_EQ(dataset.groundTruth().poses.size(), 3u) << dataset.groundTruth().note;
    for (int i = 0; i < 3; i++) {
        const auto n = static_cast<std::size_t>(i);
        const RgbdFrame frame = dataset.readFrame(n);
        EXPECT_EQ(frame.timestamp, SmallDataset::time(i));
        EXPECT_FLOAT_EQ(frame.depth.at<float>(20, 30), 2.f);
        EXPECT_EQ(frame.colour.at<cv::Vec3b>(1, 1)[0], 10 * i);
        EXPECT_EQ(dataset.groundTruth().poses[n].timestamp, SmallDataset::time(i));
        EXPECT_NEAR(dataset.groundTruth().poses[n].T_world_camera.translation().x(), 0.01 * i, 1e-12);
    }
    EXPECT_CONTAINS(dataset.summary(), "3 frames matched, 0 colour and 0 depth images dropped");
    EXPECT_CONTAINS(dataset.summary(), "largest gap 0.033 s");
}

TEST_P(AnyLayout, PathsMayHoldBlanksAndOtherLetters) {
    const SmallDataset folder(layout(), 3, "Büro & Küche 部屋");
    EXPECT_EQ(openDataset(folder.path()).size(), 3u);
    EXPECT_EQ(openDataset(folder.path() + "/").readFrame(2).timestamp, SmallDataset::time(2));
}

TEST_P(AnyLayout, CommentsBlankLinesAndWindowsLineEnds) {
    const SmallDataset folder(layout());
    auto files = folder.lists();
    files.push_back(layout() == "7scenes" ? SmallDataset::pose(1) : folder.truthFile());
    files.push_back(layout() == "eth3d" ? "calibration.txt" : "camera.txt");
    for (const std::string& file : files) {
        const bool key_first = file == "camera.txt";  // the mark must not become a part of the key
        std::string text = std::string("\xEF\xBB\xBF") + (key_first ? "" : "# head\r\n\r\n");
        std::istringstream lines(folder.read(file));
        for (std::string line; std::getline(lines, line);)
            text += "  " + line + "  \t # note\r\n   \r\n# between: 7\r\n";
        folder.write(file, text);
    }
    const DatasetReader dataset = openDataset(folder.path());
    ASSERT_EQ(dataset.size(), 3u);
    EXPECT_EQ(dataset.camera(), (PinholeCamera{64, 48, 60, 61, 31.5, 23.5, {}}));
    EXPECT_EQ(dataset.groundTruth().poses.size(), 3u) << dataset.groundTruth().note;
}

TEST_P(AnyLayout, MissingImages) {
    const SmallDataset folder(layout());
    folder.remove(folder.depth(1));
    if (!folder.lists().empty()) {
        EXPECT_CONTAINS(openError(folder), "1 listed image(s) missing");
        EXPECT_CONTAINS(openError(folder), folder / folder.depth(1));
        return;
    }
    const DatasetReader dataset = openDataset(folder.path());
    EXPECT_EQ(dataset.size(), 2u);
    EXPECT_EQ(dataset.description().association.dropped_colour, 1u);
    EXPECT_CONTAINS(dataset.summary(), "1 colour and 0 depth images dropped");
    EXPECT_CONTAINS(dataset.summary(), "largest gap 0.067 s");
}

TEST_P(AnyLayout, EightBitDepthGivesOneLineAndNoRawlog) {
    const SmallDataset folder(layout());
    for (int i = 0; i < 3; i++) folder.writeDepth(i, cv::Mat(48, 64, CV_8UC1, cv::Scalar(9)));
    EXPECT_CONTAINS(openError(folder), "must be 16-bit");
    const std::string rawlog = folder.parent() / "out.rawlog";
    expectError(test::runProgram("rgbd2rawlog", {"--input", folder.path(), "--output", rawlog}), 1,
                "rgbd2rawlog", {"must be 16-bit", ".png"});
    EXPECT_EQ(test::countEntries(folder.parent().path()), 1) << "only the dataset";
}

TEST_P(AnyLayout, OneBadImageSpoilsOneFrame) {
    const SmallDataset folder(layout(), 4);
    folder.writeDepth(1, cv::Mat(48, 64, CV_8UC1, cv::Scalar(9)));
    folder.writeColour(2, cv::Mat(24, 32, CV_8UC3, cv::Scalar(9)));
    fs::resize_file(folder / folder.colour(3), 50);
    const DatasetReader dataset = openDataset(folder.path());
    EXPECT_EQ(errorOf([&] { dataset.readFrame(0); }), "");
    EXPECT_CONTAINS(errorOf([&] { dataset.readFrame(1); }), folder.depth(1));
    EXPECT_CONTAINS(errorOf([&] { dataset.readFrame(2); }), "32x24, but the camera is 64x48");
    EXPECT_CONTAINS(errorOf([&] { dataset.readFrame(3); }), folder.colour(3));
}

TEST_P(AnyLayout, DepthOfAnotherSize) {
    const SmallDataset folder(layout());
    for (int i = 0; i < 3; i++) folder.writeDepth(i, cv::Mat(24, 32, CV_16UC1, cv::Scalar(9000)));
    EXPECT_CONTAINS(openError(folder), "32x24, but the camera is 64x48");
    EXPECT_CONTAINS(openError(folder), folder.depth(0));
}

TEST_P(AnyLayout, WrongScaleIsNamedWithTheLikelyOne) {
    const SmallDataset folder(layout());
    folder.writeCamera("50");
    EXPECT_CONTAINS(openError(folder),
                    "depth_scale " + std::to_string(folder.unitsPerMetre()) + " would give 2 m");
    EXPECT_CONTAINS(openError(folder), "camera.txt");
}

TEST_P(AnyLayout, EmptyFolder) {
    const SmallDataset folder(layout());
    for (const auto& entry : fs::directory_iterator(folder.path())) fs::remove_all(entry);
    EXPECT_CONTAINS(openError(folder, layout()), folder.path());
    const std::string error = openError(folder);
    for (const char* known : {"no dataset recognised", "tum: rgb.txt", "icl: ", "eth3d: calibration.txt",
                              "7scenes: frame-", "plain: camera.txt"})
        EXPECT_CONTAINS(error, known);
}

TEST_P(AnyLayout, AnotherLayoutsNameIsOneLine) {
    const SmallDataset folder(layout());
    for (const std::string& other : datasetFormats())
        if (other != "auto" && other != layout()) openError(folder, other);
}

TEST_P(AnyLayout, NoPermission) {
    const SmallDataset folder(layout());
    fs::permissions(folder.parent().path(), fs::perms::all);
    const auto errorWithout = [&](const std::string& file) {
        const fs::perms before = fs::status(file).permissions();
        fs::permissions(file, fs::perms::none);
        std::string error;
        {
            const AsNobody nobody;
            error = openError(folder);
        }
        fs::permissions(file, before);
        return error;
    };
    EXPECT_CONTAINS(errorWithout(folder.path()), "Permission denied");
    EXPECT_CONTAINS(errorWithout(folder / folder.colour(1)), "no permission to read it");
    const std::string camera = layout() == "eth3d" ? "calibration.txt" : "camera.txt";
    EXPECT_CONTAINS(errorWithout(folder / camera), camera + ": Permission denied");
    for (const std::string& list : folder.lists()) {
        EXPECT_CONTAINS(errorWithout(folder / list), "Permission denied");
        EXPECT_CONTAINS(errorWithout(folder / list), list);
    }
}

TEST_P(AnyLayout, GroundTruthThatIsNoneIsSaidAndLeftOut) {
    const SmallDataset folder(layout());
    const bool frames = layout() == "7scenes";
    const std::string file = frames ? SmallDataset::pose(1) : folder.truthFile();
    folder.write(file, "1 2 three\n");
    const DatasetReader dataset = openDataset(folder.path());
    EXPECT_EQ(dataset.groundTruth().poses.size(), frames ? 2u : 0u);
    EXPECT_CONTAINS(dataset.groundTruth().note, file + ":1: 'three'");
    EXPECT_CONTAINS(dataset.summary(), "three");
}

TEST_P(ListLayout, UnsortedAndRepeatedStamps) {
    const SmallDataset folder(layout());
    for (const std::string& list : folder.lists()) {
        std::istringstream lines(folder.read(list));
        std::string text, last;
        for (std::string line; std::getline(lines, line); last = line) text = line + "\n" + text;
        folder.write(list, text + last + "\n");
    }
    const DatasetReader dataset = openDataset(folder.path());
    ASSERT_EQ(dataset.size(), 3u);
    for (int i = 0; i < 3; i++)
        EXPECT_EQ(dataset.entry(static_cast<std::size_t>(i)).timestamp, SmallDataset::time(i));
    EXPECT_EQ(dataset.description().association.duplicates, folder.lists().size());
    EXPECT_CONTAINS(dataset.summary(), "out of order");
}

TEST_P(ListLayout, MissingLists) {
    const SmallDataset folder(layout());
    for (const std::string& list : folder.lists()) folder.remove(list);
    if (layout() == "eth3d") {
        EXPECT_EQ(openDataset(folder.path()).size(), 3u) << "rgb.txt and depth.txt serve, too";
        folder.remove("depth.txt");
        EXPECT_CONTAINS(openError(folder), "associated.txt");
    } else if (layout() == "icl") {
        EXPECT_EQ(openDataset(folder.path()).size(), 3u) << "the names say it all";
        folder.remove("rgb");
        EXPECT_CONTAINS(openError(folder, "icl"), "associations.txt");
    } else {
        EXPECT_CONTAINS(openError(folder, "tum"), "has no rgb.txt");
    }
}

TEST_P(ListLayout, LinesThatAreNone) {
    const SmallDataset folder(layout());
    const std::string list = folder.lists().front();
    folder.write(list, "# c\n" + folder.stamp(0) + "\n");
    EXPECT_CONTAINS(openError(folder, layout()), list + ":2: expected 'timestamp");
    folder.write(list, "soon rgb/a.png 2 depth/a.png\n");
    EXPECT_CONTAINS(openError(folder, layout()), list + ":1: 'soon' is not a number");
    folder.write(list, "# nothing\n");
    EXPECT_CONTAINS(openError(folder, layout()), (folder / list) + " lists no images");
}

}  // namespace
}  // namespace roevo
