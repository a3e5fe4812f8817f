#pragma once
/// What the tests of rgbd2rawlog and rawlog2rgbd share.

#include <mrpt/io/CFileGZOutputStream.h>
#include <mrpt/obs/CObservation3DRangeScan.h>
#include <mrpt/serialization/CArchive.h>

#include <cmath>
#include <opencv2/core.hpp>

#include "mrpt/synthetic_scan.h"
#include "mrpt/test_helpers.h"
#include "recordings/dataset_reader.h"
#include "roevo_mrpt/observation_converter.h"
#include "roevo_mrpt/rawlog_reader.h"
#include "support/data_folder.h"

#define EXPECT_CONTAINS(text, part) EXPECT_NE((text).find(part), std::string::npos) << (text)

namespace roevo::test {

inline ProgramResult convert(const std::string& input, const std::string& output,
                             const std::vector<std::string>& more = {}) {
    std::vector<std::string> arguments = {"--input", input, "--output", output};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return runProgram("rgbd2rawlog", arguments);
}

inline ProgramResult convertBack(const std::string& input, const std::string& output,
                                 const std::vector<std::string>& more = {}) {
    std::vector<std::string> arguments = {"--input", input, "--output", output};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return runProgram("rawlog2rgbd", arguments);
}

/// Runs a program as somebody whom file permissions stop, which they do not stop root.
inline ProgramResult runUnprivileged(const std::string& name, std::vector<std::string> arguments) {
    if (geteuid() != 0) return runProgram(name, arguments);
    arguments.insert(arguments.begin(), {"--reuid=65534", "--regid=65534", "--clear-groups",
                                         std::string(ROEVO_BIN_DIR) + "/" + name});
    return runProgram("/usr/bin/setpriv", arguments);
}

inline bool sameImage(const cv::Mat& a, const cv::Mat& b) {
    return a.size() == b.size() && a.type() == b.type() && (a.empty() || cv::norm(a, b, cv::NORM_INF) == 0);
}

/// The rawlog holds these frames of the folder, and no others.
inline void expectFrames(const std::string& rawlog, const std::string& folder,
                         const std::vector<std::size_t>& frames) {
    const DatasetReader dataset = openDataset(folder);
    RawlogReader reader(rawlog);
    for (const std::size_t i : frames) {
        const auto scan = reader.next();
        ASSERT_TRUE(scan);
        const RgbdFrame a = toRgbdFrame(*scan), b = dataset.readFrame(i);
        EXPECT_EQ(a.timestamp, b.timestamp);
        EXPECT_TRUE(sameImage(a.depth, b.depth));
        EXPECT_TRUE(sameImage(a.grey, b.grey));
        EXPECT_EQ(colourCameraOf(*scan), dataset.camera());
    }
    EXPECT_FALSE(reader.next());
}

/// Frame i's depth in the units of its dataset, as in a folder that has one camera.
inline cv::Mat registeredDepth(const DatasetReader& dataset, std::size_t i) {
    if (!dataset.description().registration) return dataset.readDepth(i);
    const cv::Mat metres = dataset.readFrame(i).depth;
    cv::Mat units(metres.size(), CV_16UC1);
    for (int v = 0; v < metres.rows; v++)
        for (int u = 0; u < metres.cols; u++)
            units.at<std::uint16_t>(v, u) = static_cast<std::uint16_t>(
                std::round(static_cast<double>(metres.at<float>(v, u)) * dataset.depthScale()));
    return units;
}

/// Both folders hold the same frames at the same times from the same camera, colour byte for byte.
inline void expectSameDataset(const std::string& a_folder, const std::string& b_folder) {
    const DatasetReader a = openDataset(a_folder), b = openDataset(b_folder);
    EXPECT_EQ(a.camera(), b.camera());
    EXPECT_EQ(a.depthUnit(), b.depthUnit());
    ASSERT_EQ(a.size(), b.size());
    for (std::size_t i = 0; i < a.size(); i++) {
        EXPECT_EQ(a.entry(i).timestamp, b.entry(i).timestamp);
        EXPECT_EQ(a.entry(i).depth_timestamp, b.entry(i).depth_timestamp);
        ASSERT_TRUE(sameImage(registeredDepth(a, i), registeredDepth(b, i))) << i;
        ASSERT_TRUE(readFile(a.entry(i).image) == readFile(b.entry(i).image)) << i;
    }
}

/// Frame i of a made-up recording at 10 Hz; its noise is some three metres away in the middle.
inline mrpt::obs::CObservation3DRangeScan::Ptr scanAt(int i, const cv::Mat& image,
                                                      const std::string& label = "RGBD") {
    auto scan = makeScan(1000 + 0.1 * i, smallCamera(), patternDepth(smallCamera(), i), image, label);
    scan->rangeUnits = 0.0001f;
    return scan;
}
inline mrpt::obs::CObservation3DRangeScan::Ptr scanAt(int i, const std::string& label = "RGBD") {
    return scanAt(i, patternColour(smallCamera(), i), label);
}

/// Streams objects into a rawlog as other programs do.
inline void writeObjects(const std::string& path,
                         const std::vector<mrpt::serialization::CSerializable::Ptr>& objects) {
    mrpt::io::CFileGZOutputStream stream(path);
    auto archive = mrpt::serialization::archiveFrom(stream);
    for (const auto& object : objects) archive << *object;
}

}  // namespace roevo::test
