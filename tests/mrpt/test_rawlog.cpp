#include <gtest/gtest.h>
#include <mrpt/io/CFileGZInputStream.h>
#include <mrpt/io/CFileGZOutputStream.h>
#include <mrpt/io/CFileOutputStream.h>
#include <mrpt/obs/CActionCollection.h>
#include <mrpt/obs/CObservation2DRangeScan.h>
#include <mrpt/obs/CObservationImage.h>
#include <mrpt/obs/CSensoryFrame.h>
#include <mrpt/serialization/CArchive.h>

#include <cstdlib>
#include <fstream>
#include <opencv2/imgcodecs.hpp>

#include "mrpt/synthetic_scan.h"
#include "mrpt/test_helpers.h"
#include "roevo_mrpt/observation_converter.h"
#include "roevo_mrpt/rawlog_reader.h"
#include "roevo_mrpt/rawlog_writer.h"
#include "support/images.h"

namespace roevo {
namespace {

namespace fs = std::filesystem;
using test::countEntries;
using test::errorOf;
using test::makeScan;
using test::patternColour;
using test::patternDepth;
using test::same;
using test::smallCamera;

constexpr double kStart = 1305031453.359684;

double stamp(int i) {
    return roundToMicroseconds(kStart + i / 30.0);
}

void writeFrames(const std::string& path, int count, RawlogWriterOptions options = {}) {
    RawlogWriter writer(path, smallCamera(), options);
    for (int i = 0; i < count; i++)
        writer.add(stamp(i), patternDepth(smallCamera(), i), patternColour(smallCamera(), i));
    writer.finish();
}

void expectFrame(const mrpt::obs::CObservation3DRangeScan& scan, int i, float units) {
    EXPECT_EQ(colourCameraOf(scan), smallCamera());
    const RgbdFrame frame = toRgbdFrame(scan);
    EXPECT_EQ(frame.timestamp, stamp(i));
    EXPECT_TRUE(same(frame.colour, patternColour(smallCamera(), i)));
    const cv::Mat depth = patternDepth(smallCamera(), i);
    for (int v = 0; v < depth.rows; v++)
        for (int u = 0; u < depth.cols; u++)
            ASSERT_EQ(frame.depth.at<float>(v, u), static_cast<float>(depth.at<std::uint16_t>(v, u)) * units);
}

std::size_t countScans(RawlogReader& reader) {
    std::size_t count = 0;
    while (reader.next()) count++;
    return count;
}

class RawlogRoundTrip : public ::testing::TestWithParam<int> {};

TEST_P(RawlogRoundTrip, IsLosslessAtEveryCompressionLevel) {
    const test::TemporaryFolder folder;
    RawlogWriterOptions options;
    options.gz_level = GetParam();
    options.range_units = 0.001f;
    options.sensor_label = "front camera/left";
    writeFrames(folder / "a.rawlog", 4, options);
    EXPECT_EQ(countEntries(folder.path()), 2);  // the rawlog and its images, nothing temporary
    RawlogReader reader(folder / "a.rawlog");
    for (int i = 0; i < 4; i++) {
        const auto scan = reader.next();
        ASSERT_TRUE(scan);
        EXPECT_EQ(scan->sensorLabel, options.sensor_label);
        EXPECT_TRUE(scan->doDepthAndIntensityCamerasCoincide());
        EXPECT_TRUE(scan->range_is_depth);
        expectFrame(*scan, i, 0.001f);
        EXPECT_NEAR(reader.progress(), (i + 1) / 4.0, 0.02);
    }
    EXPECT_FALSE(reader.next());
    EXPECT_EQ(reader.report().warning(), "");
    EXPECT_EQ(reader.report().entries, 4u);
}

INSTANTIATE_TEST_SUITE_P(Levels, RawlogRoundTrip, ::testing::Values(0, 1, 9));

TEST(RawlogWriter, KeepsImageFilesByteForByteAndCanBeMoved) {
    const test::TemporaryFolder folder;
    fs::create_directories(folder / "source");
    cv::imwrite(folder / "source/x.png", patternColour(smallCamera(), 0), {cv::IMWRITE_PNG_COMPRESSION, 9});
    const std::uintmax_t size = fs::file_size(folder / "source/x.png");
    fs::create_symlink("x.png", folder / "source/link.png");
    {
        RawlogWriter writer(folder / "a.rawlog", smallCamera());
        writer.addFile(stamp(0), patternDepth(smallCamera(), 0), folder / "source/x.png");
        writer.addFile(stamp(0), patternDepth(smallCamera(), 0),
                       folder / "source/link.png");  // a repeated stamp, too
        writer.finish();
    }
    fs::remove_all(folder / "source");
    fs::create_directories(folder / "elsewhere");
    fs::rename(folder / "a.rawlog", folder / "elsewhere/a.rawlog");
    fs::rename(folder / "a_Images", folder / "elsewhere/a_Images");
    for (const auto& image : fs::directory_iterator(folder / "elsewhere/a_Images"))
        EXPECT_EQ(image.file_size(), size);
    RawlogReader reader(folder / "elsewhere/a.rawlog");
    while (const auto scan = reader.next()) expectFrame(*scan, 0, 1.f / 5000);
    EXPECT_EQ(reader.report().range_images, 2u);
}

TEST(RawlogWriter, WithoutFinishLeavesNothing) {
    const test::TemporaryFolder folder;
    {
        RawlogWriter writer(folder / "a.rawlog", smallCamera());
        writer.add(stamp(0), patternDepth(smallCamera(), 0), patternColour(smallCamera(), 0));
        EXPECT_FALSE(fs::exists(folder / "a.rawlog"));
    }
    EXPECT_EQ(countEntries(folder.path()), 0);
}

TEST(RawlogWriter, ReplacesAnOlderRawlogOnlyWhenFinished) {
    const test::TemporaryFolder folder;
    writeFrames(folder / "a.rawlog", 3);
    {
        RawlogWriter abandoned(folder / "a.rawlog", smallCamera());
        abandoned.add(stamp(0), patternDepth(smallCamera(), 0), patternColour(smallCamera(), 0));
    }
    RawlogReader old_one(folder / "a.rawlog");
    EXPECT_EQ(countScans(old_one), 3u);
    writeFrames(folder / "a.rawlog", 2);
    RawlogReader new_one(folder / "a.rawlog");
    EXPECT_EQ(countScans(new_one), 2u);
    EXPECT_EQ(countEntries(folder / "a_Images"), 2);
}

TEST(RawlogWriter, RefusesWhatItCannotWrite) {
    const test::TemporaryFolder folder;
    const auto open = [&](const std::string& path) {
        return errorOf([&] { RawlogWriter(path, smallCamera()); });
    };
    const std::string file = folder / "none/a.rawlog";
    EXPECT_EQ(open(file).find("cannot write " + file + ": "), 0u);
    fs::create_directories(folder / "b_Images");
    EXPECT_NE(open(folder / "b.rawlog").find("b_Images"), std::string::npos);
    RawlogWriter writer(folder / "c.rawlog", smallCamera());
    const cv::Mat depth = patternDepth(smallCamera(), 0), colour = patternColour(smallCamera(), 0);
    EXPECT_NE(errorOf([&] { writer.add(0, depth(cv::Rect(0, 0, 10, 10)), colour); }).find("10x10"),
              std::string::npos);
    EXPECT_NE(errorOf([&] { writer.add(0, colour, colour); }).find("16-bit"), std::string::npos);
    EXPECT_NE(errorOf([&] { writer.addFile(0, depth, folder / "no.png"); }).find("no.png"),
              std::string::npos);
}

TEST(RawlogWriter, IsAcceptedByRawlogEdit) {
    if (std::system("command -v rawlog-edit >/dev/null 2>&1") != 0)
        GTEST_SKIP() << "rawlog-edit (package mrpt-apps) not installed";
    const test::TemporaryFolder folder;
    writeFrames(folder / "a.rawlog", 5);
    // From its own folder: MRPT 2.5 looks for the images in the wrong place when the path has a folder in it.
    const std::string command =
        "cd '" + folder.path().string() + "' && rawlog-edit --info -i a.rawlog > info.txt 2>&1";
    EXPECT_EQ(std::system(command.c_str()), 0);
    std::ifstream in(folder / "info.txt");
    const std::string info((std::istreambuf_iterator<char>(in)), std::istreambuf_iterator<char>());
    EXPECT_NE(info.find("a_Images"), std::string::npos) << info;
    EXPECT_NE(info.find("RGBD /      5"), std::string::npos) << info;
}

/// Streams objects into a rawlog as other programs do, gz or plain.
template <class Stream>
void writeObjects(Stream&& stream, const std::vector<mrpt::serialization::CSerializable::Ptr>& objects) {
    auto archive = mrpt::serialization::archiveFrom(stream);
    for (const auto& object : objects) archive << *object;
}

TEST(RawlogReader, ReadsActionAndSensoryFramePairsWithEmbeddedImages) {
    const test::TemporaryFolder folder;
    const PinholeCamera camera = smallCamera();
    std::vector<mrpt::serialization::CSerializable::Ptr> objects;
    for (int i = 0; i < 3; i++) {
        cv::Mat grey;
        cv::extractChannel(patternColour(camera, i), grey, 0);
        auto frame = mrpt::obs::CSensoryFrame::Create();
        frame->insert(mrpt::obs::CObservation2DRangeScan::Create());
        frame->insert(makeScan(stamp(i), camera, patternDepth(camera, i), grey));
        objects.push_back(mrpt::obs::CActionCollection::Create());
        objects.push_back(frame);
    }
    writeObjects(mrpt::io::CFileOutputStream(folder / "plain.rawlog"), objects);
    writeObjects(mrpt::io::CFileGZOutputStream(folder / "gz.rawlog"), objects);
    for (const char* name : {"plain.rawlog", "gz.rawlog"}) {
        RawlogReader reader(folder / name);
        for (int i = 0; i < 3; i++) {
            const auto scan = reader.next();
            ASSERT_TRUE(scan);
            const RgbdFrame frame = toRgbdFrame(*scan);
            EXPECT_EQ(frame.timestamp, stamp(i));
            cv::Mat grey;
            cv::extractChannel(patternColour(camera, i), grey, 0);
            EXPECT_TRUE(same(frame.grey, grey));
            EXPECT_TRUE(frame.colour.empty());
        }
        EXPECT_FALSE(reader.next());
        EXPECT_EQ(reader.report().warning(), "");
        EXPECT_EQ(reader.report().entries, 6u);
        EXPECT_EQ(reader.report().classes.at("mrpt::obs::CObservation2DRangeScan"), 3u);
        EXPECT_EQ(reader.report().classes.at("mrpt::obs::CActionCollection"), 3u);
        EXPECT_NEAR(reader.progress(), 1, 0.02);
    }
}

TEST(RawlogReader, ChoosesASensorByLabel) {
    const test::TemporaryFolder folder;
    const PinholeCamera camera = smallCamera();
    std::vector<mrpt::serialization::CSerializable::Ptr> objects;
    for (int i = 0; i < 4; i++)
        for (const char* label : {"left", "right"})
            objects.push_back(
                makeScan(stamp(i), camera, patternDepth(camera, i), patternColour(camera, i), label));
    writeObjects(mrpt::io::CFileGZOutputStream(folder / "a.rawlog"), objects);

    RawlogReader right(folder / "a.rawlog", "right");
    EXPECT_EQ(right.next()->sensorLabel, "right");
    EXPECT_EQ(countScans(right), 3u);
    RawlogReader any(folder / "a.rawlog");
    EXPECT_NE(errorOf([&] {
                  countScans(any);
              }).find("several sensors have range images (4 left, 4 right): choose one with --sensor-label"),
              std::string::npos);
    RawlogReader none(folder / "a.rawlog", "top");
    const std::string error = errorOf([&] { none.next(); });
    EXPECT_NE(error.find("4 left, 4 right"), std::string::npos) << error;
}

TEST(RawlogReader, TellsATruncatedFileFromAProperEnd) {
    const test::TemporaryFolder folder;
    writeFrames(folder / "a.rawlog", 6);
    const auto size = fs::file_size(folder / "a.rawlog");
    for (const double share : {0.3, 0.6, 0.9}) {
        fs::copy_file(folder / "a.rawlog", folder / "cut.rawlog", fs::copy_options::overwrite_existing);
        fs::resize_file(folder / "cut.rawlog",
                        static_cast<std::uintmax_t>(share * static_cast<double>(size)));
        RawlogReader reader(folder / "cut.rawlog");
        const std::size_t read = countScans(reader);
        EXPECT_GE(read, static_cast<std::size_t>(share * 6) - 1);
        EXPECT_LT(read, 6u);
        EXPECT_NE(reader.report().fault.find("truncated"), std::string::npos) << reader.report().fault;
        EXPECT_NE(reader.report().fault.find("entry " + std::to_string(read + 1)), std::string::npos)
            << reader.report().fault;
    }
}

TEST(RawlogReader, EveryCutOfAPlainFileIsReportedExceptBetweenObjects) {
    const test::TemporaryFolder folder;
    const PinholeCamera camera = smallCamera();
    const auto scan = makeScan(stamp(0), camera, patternDepth(camera, 0), patternColour(camera, 0));
    writeObjects(mrpt::io::CFileOutputStream(folder / "one.rawlog"), {scan});
    writeObjects(mrpt::io::CFileOutputStream(folder / "two.rawlog"), {scan, scan});
    const auto one = fs::file_size(folder / "one.rawlog");
    for (const std::uintmax_t length : {one, one + 1, one + 8, one + 200, 2 * one - 1, 2 * one}) {
        fs::copy_file(folder / "two.rawlog", folder / "cut.rawlog", fs::copy_options::overwrite_existing);
        fs::resize_file(folder / "cut.rawlog", length);
        RawlogReader reader(folder / "cut.rawlog");
        EXPECT_EQ(countScans(reader), length == 2 * one ? 2u : 1u);
        EXPECT_EQ(reader.report().fault.empty(), length % one == 0) << length << " of " << 2 * one;
    }
}

TEST(RawlogReader, ADamagedMiddleIsReported) {
    const test::TemporaryFolder folder;
    writeFrames(folder / "a.rawlog", 6);
    {
        std::fstream file(folder / "a.rawlog", std::ios::in | std::ios::out | std::ios::binary);
        file.seekp(static_cast<std::streamoff>(fs::file_size(folder / "a.rawlog") / 2));
        file << std::string(300, '\xff');
    }
    RawlogReader reader(folder / "a.rawlog");
    EXPECT_LT(countScans(reader), 6u);
    EXPECT_FALSE(reader.report().fault.empty());
}

TEST(RawlogReader, SaysWhatIsWrongWithOtherFiles) {
    const test::TemporaryFolder folder;
    std::ofstream(folder / "text.rawlog") << "timestamp filename\n";
    std::ofstream(folder / "empty.rawlog");
    writeObjects(
        mrpt::io::CFileGZOutputStream(folder / "laser.rawlog"),
        {mrpt::obs::CObservation2DRangeScan::Create(), mrpt::obs::CObservation2DRangeScan::Create()});
    const auto read = [&](const std::string& name) {
        return errorOf([&] {
            RawlogReader reader(folder / name);
            reader.next();
        });
    };
    EXPECT_NE(read("none.rawlog").find("not found"), std::string::npos);
    EXPECT_NE(read("").find("folder"), std::string::npos);
    EXPECT_NE(read("text.rawlog").find("not a rawlog"), std::string::npos);
    EXPECT_NE(read("empty.rawlog").find("empty"), std::string::npos);
    EXPECT_NE(read("laser.rawlog").find("2 mrpt::obs::CObservation2DRangeScan"), std::string::npos)
        << read("laser.rawlog");
}

TEST(RawlogReader, AMissingExternalImageIsNamedAndTheOthersStillWork) {
    const test::TemporaryFolder folder;
    writeFrames(folder / "a.rawlog", 3);
    const std::string lost = "RGBD_" + std::to_string(stamp(1)) + ".png";
    ASSERT_TRUE(fs::remove(folder / ("a_Images/" + lost)));
    RawlogReader reader(folder / "a.rawlog");
    int i = 0;
    while (const auto scan = reader.next()) {
        const std::string error = errorOf([&] { toRgbdFrame(*scan); });
        EXPECT_EQ(error.find(lost) != std::string::npos, i == 1) << error;
        EXPECT_EQ(error.empty(), i != 1);
        i++;
    }
    EXPECT_EQ(i, 3);
}

}  // namespace
}  // namespace roevo
