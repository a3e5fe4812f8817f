// Bags that are cut, changed, foreign or contradict themselves.
#include <gtest/gtest.h>

#include <filesystem>
#include <random>

#include "mrpt/test_helpers.h"
#include "recordings/bags/message_store.h"
#include "tools/ros_recording.h"
#include "tools/small_dataset.h"

namespace roevo {
namespace {

namespace fs = std::filesystem;
using namespace test;

/// Reads all that can be read. @return number of frames; what is thrown at opening goes through
std::size_t readAll(const std::string& path) {
    const DatasetReader bag = openDataset(path);
    std::size_t good = 0;
    for (std::size_t i = 0; i < bag.size(); i++) {
        try {
            bag.readFrame(i);
            good++;
        } catch (const std::runtime_error& error) {
            EXPECT_CONTAINS(std::string(error.what()), path);
        }
    }
    return good;
}

/// One line that names the file, or "" when it can be read.
std::string faultOf(const std::string& path) {
    try {
        readAll(path);
        return {};
    } catch (const std::runtime_error& error) {
        const std::string text = error.what();
        EXPECT_CONTAINS(text, path);
        EXPECT_EQ(text.find('\n'), std::string::npos) << text;
        return text;
    }
}

class BadBags : public testing::TestWithParam<BagKind> {
  protected:
    void SetUp() override {
        path_ = GetParam().write(folder_ / (std::string("x") + GetParam().ending),
                                 tinyRecording(GetParam().encoding, 3));
        file_ = path_;
        if (fs::is_directory(path_))
            file_ += std::string(GetParam().name) == "McapFolder" ? "/walk_1.mcap" : "/walk_1.db3";
        whole_ = readFile(file_);
        ASSERT_EQ(readAll(path_), 3u);
    }
    TemporaryFolder folder_;
    std::string path_, file_, whole_;  ///< the input, a file of it and its bytes
};
INSTANTIATE_TEST_SUITE_P(Ros, BadBags, testing::ValuesIn(kBagKinds),
                         [](const auto& info) { return info.param.name; });

TEST_P(BadBags, CutAnywhereAreRefused) {
    std::vector<std::size_t> sizes{0, 1, 8, 13, 16, 20, 100, whole_.size() - 1, whole_.size() - 8};
    for (std::size_t share = 1; share < 20; share++) sizes.push_back(share * whole_.size() / 20);
    for (const std::size_t size : sizes) {
        writeFile(file_, whole_.substr(0, size));
        const std::string fault = faultOf(path_);
        EXPECT_NE(fault, "") << size << " of " << whole_.size();
    }
    writeFile(file_, whole_.substr(0, whole_.size() / 2));
    EXPECT_CONTAINS(faultOf(path_), "truncated or damaged");
    EXPECT_CONTAINS(faultOf(path_), "copy it again");
}

// Whatever the bytes are: one line, or the frames that are left. A fixed seed; what it finds is found again.
TEST_P(BadBags, ChangedAnywhereNeverEndTheProgram) {
    std::mt19937 random(7);
    std::size_t refused = 0, read = 0;
    for (int round = 0; round < 60; round++) {
        std::string bytes = whole_;
        for (std::size_t changes = 1 + random() % 3; changes > 0; changes--) {
            const bool at_head = random() % 4 == 0;  // where lengths are
            const std::size_t at =
                random() % (at_head ? std::min<std::size_t>(bytes.size(), 700) : bytes.size());
            bytes[at] = static_cast<char>(random() % 3 == 0 ? 0xFF : random());
        }
        writeFile(file_, bytes);
        (faultOf(path_).empty() ? read : refused)++;
    }
    EXPECT_GT(read, 0u);
    EXPECT_GT(refused, 0u);
}

TEST(RosBagFolders, MissingOrForeignPartsAreNamed) {
    const TemporaryFolder folder;
    const std::string path = writeFolder<false>(folder / "walk", tinyRecording(Encoding::kCdrLittle, 3));
    fs::remove(path + "/walk_1.db3");
    EXPECT_CONTAINS(faultOf(path),
                    "metadata.yaml lists walk_1.db3, which is not there: copy the whole folder");
    writeFile(path + "/walk_1.db3", "something else");
    EXPECT_CONTAINS(faultOf(path), "walk_1.db3");
    writeFile(path + "/metadata.yaml", "  relative_file_paths:\n    - \"walk/walk_0.db3.zstd\"\n");
    EXPECT_CONTAINS(faultOf(path), "unzstd");
    fs::remove(path + "/metadata.yaml"), fs::remove(path + "/walk_1.db3");
    EXPECT_GT(readAll(path), 0u) << "the files say it all";
}

TEST(RosBagFiles, ForeignOnesAreNamed) {
    const TemporaryFolder folder;
    const std::string db3 = folder / "x.db3";
    sqlite3* database = nullptr;
    sqlite3_open(db3.c_str(), &database);
    sqlite3_exec(
        database,
        "CREATE TABLE topics(id, name, type, serialization_format); CREATE VIEW messages AS SELECT 1",
        nullptr, nullptr, nullptr);
    sqlite3_close(database);
    EXPECT_CONTAINS(faultOf(db3), "no table 'messages'");
    fs::remove(db3);
    writeSqliteBag(db3, tinyRecording(Encoding::kCdrLittle), "protobuf");
    EXPECT_CONTAINS(faultOf(db3), "is written as 'protobuf'");
    writeFile(folder / "x.mcap", McapBytes(tinyRecording(Encoding::kCdrLittle), "", "protobuf").bytes());
    EXPECT_CONTAINS(faultOf(folder / "x.mcap"), "is written as 'protobuf'");
    for (const char* name : {"y.bag", "y.db3", "y.mcap"}) {
        writeFile(folder / name, "just a text");
        EXPECT_CONTAINS(faultOf(folder / name), "is not a ROS bag");
    }
    writeFile(folder / "old.bag", "#ROSBAG V1.2\n and so on");
    EXPECT_CONTAINS(faultOf(folder / "old.bag"), "rosbag migrate");
}

TEST(RosBagFiles, WhatADamagedSchemaHoldsIsNotEchoed) {
    const TemporaryFolder folder;
    const std::string db3 = folder / "x.db3";
    writeSqliteBag(db3, tinyRecording(Encoding::kCdrLittle));
    sqlite3* database = nullptr;
    sqlite3_open(db3.c_str(), &database);
    sqlite3_exec(database,
                 "PRAGMA writable_schema=ON; UPDATE sqlite_master SET name='V2.0'||char(10), sql='none' "
                 "WHERE name='topics'",
                 nullptr, nullptr, nullptr);
    sqlite3_close(database);
    EXPECT_CONTAINS(faultOf(db3), "malformed database schema");
}

// A database that was not closed has its last messages in a journal beside it.
TEST(RosBagFiles, AJournalBesideADatabaseIsRead) {
    const TemporaryFolder folder;
    const std::string path = folder / "x.db3", live = folder / "live.db3";
    writeSqliteBag(path, tinyRecording(Encoding::kCdrLittle, 2));
    sqlite3* database = nullptr;
    sqlite3_open(path.c_str(), &database);
    sqlite3_exec(database, "PRAGMA journal_mode=WAL; DELETE FROM messages WHERE id > 4", nullptr, nullptr,
                 nullptr);
    for (const char* ending : {"", "-wal"}) fs::copy_file(path + ending, live + ending);
    sqlite3_close(database);
    EXPECT_EQ(readAll(live), 1u);
}

TEST(RosBagFiles, NothingIsLeftBesideADatabase) {
    const TemporaryFolder folder;
    writeSqliteBag(folder / "x.db3", tinyRecording(Encoding::kCdrLittle));
    readAll(folder / "x.db3");
    EXPECT_EQ(countEntries(folder.path()), 1u);
}

/// The programs' words for recordings that contradict themselves.
class Contradictions : public testing::Test {
  protected:
    void expectRefusal(const std::vector<std::string>& words) {
        const std::string path = writeMcap<'n'>(folder_ / "x.mcap", recording_);
        expectError(runProgram("roevo-odometry", {"--input", path, "--output", folder_ / "out"}), 1,
                    "roevo-odometry", words);
        EXPECT_FALSE(fs::exists(folder_ / "out")) << "something half-written is left";
    }
    RecordedMessage image(double stamp, const cv::Mat& pixels, const std::string& encoding) {
        return {encoding == "bgr8" ? kColour : kDepth, "sensor_msgs/Image",
                imageMessage(Encoding::kCdrLittle, stamp, "rgb", pixels, encoding)};
    }
    RecordedMessage info(const PinholeCamera& camera) {
        return {kColourInfo, "sensor_msgs/CameraInfo", infoMessage(Encoding::kCdrLittle, "rgb", camera)};
    }
    TemporaryFolder folder_;
    Recording recording_;
};

TEST_F(Contradictions, StampsThatDoNotOverlap) {
    recording_ = {info(tinyCamera()), image(5, tinyColour(0), "bgr8"), image(900, tinyDepth(0), "16UC1")};
    expectRefusal({"x.mcap", "within 0.02 s", "closest pair 895 s apart"});
}

TEST_F(Contradictions, ImagesOfAnotherSizeThanTheirCamera) {
    PinholeCamera large = tinyCamera();
    large.width = 640, large.height = 480;
    recording_ = {info(large), image(5, tinyColour(0), "bgr8"), image(5, tinyDepth(0), "16UC1")};
    expectRefusal({"x.mcap", kColour, "40x32", kColourInfo, "640x480", "--info-topic"});
}

TEST_F(Contradictions, SizesAndCamerasThatChangeCostTheFramesOrAreTold) {
    recording_ = tinyRecording(Encoding::kCdrLittle, 4);
    recording_.push_back(image(tinyStamp(9), cv::Mat(tinyColour(0), cv::Rect(0, 0, 20, 20)).clone(), "bgr8"));
    recording_.push_back(image(tinyStamp(9), tinyDepth(0), "16UC1"));
    recording_.push_back(info(tinyCamera(77)));
    const std::string path = writeMcap<'z'>(folder_ / "x.mcap", recording_);
    const auto result =
        runProgram("rgbd2rawlog", {"--input", path, "--output", folder_ / "o.rawlog", "--skip-bad"});
    EXPECT_EQ(result.exit_code, 0) << result.all();
    for (const std::string words :
         {"1 of 2 messages differ from the first", "an image of 20x20", "message 5", "4 frames written"})
        EXPECT_CONTAINS(result.out, words);
    expectError(runProgram("rgbd2rawlog", {"--input", path, "--output", folder_ / "p.rawlog"}), 1,
                "rgbd2rawlog", {"x.mcap", "an image of 20x20", "message 5", "--skip-bad"});
}

TEST_F(Contradictions, DepthOfNoPlausibleScale) {
    recording_ = {info(tinyCamera()), image(5, tinyColour(0), "bgr8"),
                  image(5, cv::Mat(32, 40, CV_16UC1, cv::Scalar(3)), "16UC1")};
    expectRefusal({"x.mcap", kDepth, "median depth 0.003 m", "--depth-topic"});
}

}  // namespace
}  // namespace roevo
