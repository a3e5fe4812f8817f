// What the stamps in lists of images are taken for: their unit, numbers of frames, too few digits.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>

#include "recordings/dataset_reader.h"
#include "recordings/time_units.h"
#include "tools/small_dataset.h"

namespace roevo {
namespace {

using test::errorOf;
using test::SmallDataset;

constexpr double kEpoch = 1305031105.711309;

std::string written(double stamp, int decimals) {
    char text[60];
    std::snprintf(text, sizeof text, "%.*f", decimals, stamp);
    return text;
}

/// A folder whose lists have these stamps, as they are written.
class StampedFolder : public SmallDataset {
  public:
    explicit StampedFolder(const std::vector<std::string>& stamps)
        : SmallDataset("tum", static_cast<int>(stamps.size())) {
        std::string colours, depths;
        for (std::size_t i = 0; i < stamps.size(); i++) {
            colours += stamps[i] + " " + colour(static_cast<int>(i)) + "\n";
            depths += stamps[i] + " " + depth(static_cast<int>(i)) + "\n";
        }
        write("rgb.txt", colours);
        write("depth.txt", depths);
        remove("groundtruth.txt");
    }
    void writeTruth(double first, double step, int count, int decimals = 3) const {
        std::string text;
        for (int i = 0; i < count; i++) text += written(first + step * i, decimals) + " 0 0 0 0 0 0 1\n";
        write("groundtruth.txt", text);
    }
    DatasetReader open(double rate = 0) const {
        DatasetOptions options;
        options.folder.frame_rate = rate;
        return openDataset(path(), options);
    }
};

std::vector<std::string> stamps(double first, double step, int count, int decimals) {
    std::vector<std::string> out;
    for (int i = 0; i < count; i++) out.push_back(written(first + step * i, decimals));
    return out;
}

std::vector<double> numbers(double first, double step, int count = 20) {
    std::vector<double> out;
    for (int i = 0; i < count; i++) out.push_back(first + step * i);
    return out;
}

std::size_t count(const std::string& text, const std::string& part) {
    std::size_t found = 0;
    for (std::size_t at = 0; (at = text.find(part, at)) != std::string::npos; at++) found++;
    return found;
}

TEST(ImageTimes, UnitsAreToldByTheirSize) {
    EXPECT_EQ(unitOfStamps(numbers(kEpoch, 12.001)), 1) << "a time lapse, with decimals";
    EXPECT_EQ(unitOfStamps(numbers(1e3 * kEpoch, 12001.25)), 1e3) << "the same in ms";
    EXPECT_EQ(unitOfStamps(numbers(1305031105711309056, 12'001'000'000)), 1e9) << "the same in ns";
    EXPECT_EQ(unitOfStamps(numbers(1305031105711, 33)), 1e3);
    EXPECT_EQ(unitOfStamps(numbers(1.3e15, 33'333'333)), 1e9) << "ns of a phone that was on for 15 days";
    EXPECT_EQ(unitOfStamps(numbers(0, 1000.0 / 120)), 1e3) << "ms at 120 Hz";
    EXPECT_EQ(unitOfStamps(numbers(0, 1000.0 / 30)), 1e3);
    EXPECT_EQ(unitOfStamps(numbers(0, 2.5)), 1) << "s of a slow recording";
}

TEST(ImageTimes, ATimeLapseKeepsItsSeconds) {
    const StampedFolder folder(stamps(kEpoch, 12.001, 4, 6));
    const DatasetReader dataset = folder.open();
    EXPECT_EQ(dataset.entry(0).timestamp, kEpoch);
    EXPECT_EQ(dataset.summary().find("times of the images"), std::string::npos) << dataset.summary();
}

TEST(ImageTimes, AnotherUnitThanSecondsIsSaidOnce) {
    for (const char* layout : {"tum", "eth3d"}) {
        const SmallDataset folder(layout);
        for (const std::string& list : folder.lists()) {
            std::string text = folder.read(list);
            for (int i = 0; i < 3; i++)
                for (std::size_t at = 0; (at = text.find(folder.stamp(i) + " ", at)) != std::string::npos;)
                    text.replace(at, folder.stamp(i).size(), written(1e6 * SmallDataset::time(i), 0));
            folder.write(list, text);
        }
        const DatasetReader dataset = openDataset(folder.path());
        EXPECT_EQ(dataset.entry(1).timestamp, SmallDataset::time(1));
        EXPECT_EQ(count(dataset.summary(), "times of the images are in us, as their size tells"), 1u)
            << dataset.summary();
    }
    const SmallDataset named("plain");
    for (int i = 0; i < 3; i++)
        for (const std::string& image : {named.colour(i), named.depth(i)})
            std::filesystem::rename(named / image, named / (image.substr(0, image.find('/') + 1) +
                                                            written(1e3 * (kEpoch + 0.04 * i), 0) + ".png"));
    EXPECT_EQ(count(openDataset(named.path()).summary(), "times of the images are in ms"), 1u);
}

TEST(ImageTimes, AGroundTruthThatIsMuchLongerHasTheUnitOfTheImages) {
    const StampedFolder milliseconds(stamps(0, 32.003, 6, 3));
    milliseconds.writeTruth(-495.4, 10, 600);
    const DatasetReader ms = milliseconds.open();
    EXPECT_CONTAINS(ms.summary(), "times of the ground truth are in ms");
    EXPECT_NEAR(ms.groundTruth().poses.front().timestamp, -0.4954, 1e-9);
    const StampedFolder nanoseconds(stamps(0, 32002926, 6, 0));
    nanoseconds.writeTruth(-495409012, 1e7, 600, 0);
    const DatasetReader ns = nanoseconds.open();
    EXPECT_CONTAINS(ns.summary(), "times of the ground truth are in ns");
    EXPECT_NEAR(ns.groundTruth().poses.back().timestamp, 5.494591, 1e-6);
    nanoseconds.writeTruth(-0.495, 0.01, 6000);
    const DatasetReader seconds = nanoseconds.open();
    EXPECT_EQ(seconds.summary().find("times of the ground truth"), std::string::npos) << seconds.summary();
    EXPECT_EQ(seconds.groundTruth().poses.front().timestamp, -0.495) << "it may have another unit";
}

TEST(ImageTimes, TooFewDigits) {
    std::vector<std::string> fours, some = stamps(10, 0.1, 10, 1);
    for (const std::string& stamp : stamps(10, 0.1, 3, 1)) fours.insert(fours.end(), 4, stamp);
    const StampedFolder coarse(fours);
    const std::string expected = ": 9 of 12 lines repeat a time stamp: was it written with too few digits?";
    EXPECT_CONTAINS(errorOf([&] { coarse.open(); }), "rgb.txt" + expected);
    std::string pairs;
    for (int i = 0; i < 12; i++) {
        const std::string& stamp = fours[static_cast<std::size_t>(i)];
        pairs += stamp + " " + coarse.colour(i) + " " + stamp + " " + coarse.depth(i) + "\n";
    }
    coarse.write("associations.txt", pairs);
    coarse.remove("rgb.txt");
    EXPECT_CONTAINS(errorOf([&] { coarse.open(); }), "associations.txt" + expected);
    some[3] = some[2];
    some[7] = some[6];
    const std::string summary = StampedFolder(some).open().summary();
    EXPECT_CONTAINS(summary,
                    "8 frames matched, 0 colour and 0 depth images dropped, 4 repeated stamps left out");
    EXPECT_CONTAINS(summary, "warning: 2 of 10 lines of rgb.txt repeat a time stamp and are left out");
    EXPECT_CONTAINS(summary, "warning: 2 of 10 lines of depth.txt repeat");
}

TEST(ImageTimes, NumbersOfFramesInALineNeedARate) {
    const StampedFolder folder(stamps(0, 1, 40, 0));
    EXPECT_CONTAINS(folder.open().summary(),
                    "warning: times of the images are whole numbers, which are taken as seconds: if they "
                    "count frames, --frame-rate says how many come in a second");
    EXPECT_EQ(folder.open().entry(3).timestamp, 3);
    const DatasetReader chosen = folder.open(50);
    EXPECT_EQ(chosen.entry(3).timestamp, 0.06);
    EXPECT_EQ(chosen.entry(3).depth_timestamp, 0.06);
    EXPECT_CONTAINS(chosen.summary(), "times are frame numbers at 50 Hz");
    EXPECT_CONTAINS(chosen.summary(), "50.0 Hz");
    EXPECT_EQ(chosen.summary().find("warning"), std::string::npos) << chosen.summary();
    folder.writeTruth(0, 1, 40, 0);
    EXPECT_NEAR(folder.open(50).groundTruth().poses[3].timestamp, 0.06, 1e-9) << "it counts them, too";
    folder.writeTruth(-0.5, 0.01, 200);
    EXPECT_NEAR(folder.open(50).groundTruth().poses[3].timestamp, -0.47, 1e-9);
    folder.writeCamera("5000", "frame_rate: 20\n");
    EXPECT_EQ(folder.open().entry(3).timestamp, 0.15);
    const StampedFolder epoch(stamps(1305031105, 1, 4, 0));
    EXPECT_EQ(epoch.open().summary().find("warning"), std::string::npos) << "which count seconds since 1970";
    EXPECT_CONTAINS(errorOf([&] { epoch.open(30); }), " have times");
}

}  // namespace
}  // namespace roevo
