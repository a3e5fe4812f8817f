#pragma once
#include <map>
#include <string>
#include <vector>

namespace roevo {

struct ExportResult {
    std::size_t frames = 0, imu_samples = 0;
    std::vector<std::string> left_out;  ///< one line for each frame that could not be used
    std::size_t linked_images = 0;  ///< colour files taken over as they are; the others were written as PNG
    std::size_t resampled = 0;      ///< frames whose depth had to be registered or turned into depth
    std::string depth_note;         ///< why and to what precision, when there are such frames
    double depth_scale = 0;         ///< PNG units per metre
    std::string ground_truth;       ///< file it came from, or empty
    std::string depth_times;        ///< file with the depth images' own stamps, or empty
    std::string depth_times_fault;  ///< why it was not used and both images have the frame's stamp, or empty
    std::string warning;            ///< about the rawlog, one line, or empty
    double seconds = 0;             ///< reading and writing
    double decode_seconds = 0;      ///< reading the rawlog and decoding its frames alone
};

/// The depth_scale (PNG units per metre) of range images in these units, such that reading the folder gives
/// the same metres to the last bit; where no number does, the closest.
/// @param range_units  m, above 0
double depthScaleOf(float range_units);

/// Writes a rawlog as a folder in TUM layout. Depth is what the rawlog holds, to the last unit, unless it has
/// to be registered to another colour camera or is a range along the ray. Frames that cannot be used are left
/// out.
/// @param sensor_label  as RawlogReader's
/// @throws std::runtime_error in one line, also when no frame can be used; nothing is written then
ExportResult exportRawlog(const std::string& rawlog, const std::string& sensor_label,
                          const std::string& folder);

}  // namespace roevo
