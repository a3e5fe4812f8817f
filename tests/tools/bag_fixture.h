#pragma once
/// Runs bag2rawlog on bags of the test's own.

#include <mrpt/obs/CObservation3DRangeScan.h>

#include <functional>

#include "mrpt/test_helpers.h"
#include "roevo_mrpt/observation_converter.h"
#include "roevo_mrpt/rawlog_reader.h"
#include "support/images.h"
#include "tools/bag_writer.h"

namespace roevo::test {

class Bag2Rawlog : public testing::Test {
  protected:
    static constexpr const char* kName = "bag2rawlog";
    using Scan = std::shared_ptr<mrpt::obs::CObservation3DRangeScan>;

    std::string bagPath() const { return folder_ / "recording.bag"; }
    std::string rawlogPath() const { return folder_ / "out.rawlog"; }

    void write(const std::function<void(BagWriter&)>& content) const {
        BagWriter writer(bagPath());
        content(writer);
    }
    ProgramResult run(const std::vector<std::string>& more = {}) const {
        std::vector<std::string> arguments{"--input", bagPath(), "--output", rawlogPath()};
        arguments.insert(arguments.end(), more.begin(), more.end());
        return runProgram(kName, arguments);
    }
    /// Converts and reads the rawlog; the run must succeed.
    std::vector<Scan> scans(const std::vector<std::string>& more = {}) {
        result_ = run(more);
        EXPECT_EQ(result_.exit_code, 0) << result_.all();
        std::vector<Scan> out;
        if (result_.exit_code != 0) return out;
        RawlogReader reader(rawlogPath());
        while (const auto scan = reader.next()) out.push_back(scan);
        EXPECT_EQ(reader.report().fault, "");
        return out;
    }
    /// The run fails with one line that has these words, and leaves nothing behind.
    void expectRefusal(const std::vector<std::string>& words,
                       const std::vector<std::string>& more = {}) const {
        const auto before = countEntries(folder_.path());
        expectError(run(more), 1, kName, words);
        EXPECT_EQ(countEntries(folder_.path()), before) << "something half-written is left";
    }
    bool said(const std::string& words) const { return result_.out.find(words) != std::string::npos; }

    TemporaryFolder folder_;
    ProgramResult result_;
};

inline cv::Mat rangeImageOf(const mrpt::obs::CObservation3DRangeScan& scan) {
    const auto& range = scan.rangeImage;
    return cv::Mat(static_cast<int>(range.rows()), static_cast<int>(range.cols()), CV_16UC1,
                   const_cast<std::uint16_t*>(&range(0, 0)))
        .clone();
}

}  // namespace roevo::test
