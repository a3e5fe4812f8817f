#include "rgbd2rawlog/verify.h"

#include <mrpt/obs/CObservation3DRangeScan.h>

#include <cstring>
#include <stdexcept>

#include "roevo_mrpt/observation_converter.h"
#include "roevo_mrpt/rawlog_reader.h"
#include "support/progress.h"

namespace roevo {
namespace {

bool sameBytes(const cv::Mat& a, const cv::Mat& b) {
    if (a.size() != b.size() || a.type() != b.type()) return false;
    const std::size_t row_bytes = static_cast<std::size_t>(a.cols) * a.elemSize();
    for (int v = 0; v < a.rows; v++)
        if (std::memcmp(a.ptr(v), b.ptr(v), row_bytes) != 0) return false;
    return true;
}

/// What differs, or "".
std::string difference(const mrpt::obs::CObservation3DRangeScan& scan, const DatasetReader& dataset,
                       std::size_t i) {
    const RgbdFrame stored = toRgbdFrame(scan), original = dataset.readFrame(i);
    if (stored.timestamp != original.timestamp) return "time stamp";
    if (colourCameraOf(scan) != dataset.camera()) return "intrinsics";
    const cv::Mat raw = dataset.readDepth(i);
    const auto& range = scan.rangeImage;
    if (range.rows() != raw.rows || range.cols() != raw.cols) return "depth image size";
    if (std::memcmp(&range(0, 0), raw.ptr(), raw.total() * raw.elemSize()) != 0) return "depth values";
    if (!sameBytes(stored.depth, original.depth)) return "depth in metres";
    if (!sameBytes(stored.grey, original.grey)) return "grey image";
    return "";
}

}  // namespace

VerifyResult verifyRawlog(const DatasetReader& dataset, const std::vector<std::size_t>& written,
                          const std::string& rawlog) {
    RawlogReader reader(rawlog);
    Progress progress("verifying", written.size());
    VerifyResult result;
    while (const auto scan = reader.next()) {
        if (result.frames == written.size())
            throw std::runtime_error(rawlog + ": verification failed: it holds more frames than written");
        const std::size_t i = written[result.frames];
        if (const std::string what = difference(*scan, dataset, i); !what.empty())
            throw std::runtime_error(rawlog + ": verification failed: frame " +
                                     std::to_string(result.frames) + " differs in " + what + " from " +
                                     dataset.entry(i).depth);
        result.frames++;
        result.depth_values += scan->rangeImage.size().at(0) * scan->rangeImage.size().at(1);
        progress.update(result.frames);
    }
    if (!reader.report().fault.empty())
        throw std::runtime_error("verification failed: " + reader.report().fault);
    if (result.frames != written.size())
        throw std::runtime_error(rawlog + ": verification failed: it holds " + std::to_string(result.frames) +
                                 " of " + std::to_string(written.size()) + " frames");
    return result;
}

}  // namespace roevo
