#include "range_file.h"

#include <mrpt/io/CFileGZInputStream.h>
#include <mrpt/io/lazy_load_path.h>
#include <mrpt/obs/CObservation3DRangeScan.h>

#include <array>
#include <cstdint>
#include <filesystem>

#include "input/regular_file.h"

namespace roevo {
namespace {

enum class Outcome { kWhole, kDamaged, kOtherFormat };

/// MRPT 2's binary format: rows and columns (uint32), then the values (uint16), little-endian, gz-compressed.
Outcome readBinary(const std::string& file, mrpt::obs::CObservation3DRangeScan& scan) {
    constexpr std::uint32_t kLargest = 1 << 14;  // pixels
    mrpt::io::CFileGZInputStream stream;
    std::array<std::uint32_t, 2> size{};
    if (!otherThanFile(file).empty()) return Outcome::kDamaged;
    if (!stream.open(file) || stream.Read(size.data(), sizeof size) != sizeof size) return Outcome::kDamaged;
    const auto [rows, cols] = size;
    if (rows == 0 || cols == 0 || rows > kLargest || cols > kLargest) return Outcome::kOtherFormat;
    // Not rangeImage.setSize(): the scan gives its memory back to a pool, which only this takes it from
    scan.rangeImage_setSize(static_cast<int>(rows), static_cast<int>(cols));
    const std::size_t bytes = sizeof(std::uint16_t) * rows * cols;
    char one_more = 0;
    const bool whole = stream.Read(&scan.rangeImage(0, 0), bytes) == bytes &&
                       stream.Read(&one_more, 1) == 0;  // also where the checksum is compared
    return whole ? Outcome::kWhole : Outcome::kDamaged;
}

}  // namespace

void loadRangeFile(mrpt::obs::CObservation3DRangeScan& scan, const std::string& folder) {
    mrpt::io::setLazyLoadPathBase(folder);
    Outcome outcome = Outcome::kOtherFormat;
    try {
        const std::string file = scan.rangeImage_getExternalStorageFileAbsolutePath("");
        if (std::filesystem::path(file).extension() != ".txt" || !otherThanFile(file).empty())
            outcome = readBinary(file, scan);
        if (outcome == Outcome::kOtherFormat) {
            scan.hasPoints3D = false;  // load() would want their file, too
            scan.points3D_overrideExternalStoredFlag(false);
            scan.rangeImage.setSize(0, 0);
            scan.load();
        }
    } catch (const std::exception&) {
        outcome = Outcome::kDamaged;
    }
    if (outcome == Outcome::kDamaged) scan.rangeImage.setSize(0, 0);  // what could be read of it
}

}  // namespace roevo
