#pragma once
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "recordings/sensor_data.h"
#include "roevo/camera/rgbd_frame.h"
#include "roevo_mrpt/rawlog_reader.h"

namespace roevo {

/// A scan of a rawlog, decoded.
struct DecodedScan {
    std::shared_ptr<mrpt::obs::CObservation3DRangeScan> scan;  ///< null when inertial samples only are left
    RgbdFrame frame;                                           ///< empty when there is a fault
    std::string fault;           ///< why the odometry could not use it, one line, or empty
    std::vector<ImuSample> imu;  ///< that came before it, of the first inertial sensor
    double progress = 0;         ///< share of the rawlog that has been read
    double seconds = 0;          ///< spent on reading and decoding
};

/// Reads and decodes a rawlog's scans one by one, with the inertial samples between them.
class ScanReader {
  public:
    /// @throws std::runtime_error as RawlogReader
    ScanReader(const std::string& rawlog, const std::string& sensor_label);

    /// Nothing at the end. @throws std::runtime_error as RawlogReader::next()
    std::optional<DecodedScan> next();

    const RawlogReport& report() const { return reader_.report(); }

  private:
    void addOther(const mrpt::obs::CObservation& observation);

    RawlogReader reader_;
    std::vector<ImuSample> imu_;
    std::optional<std::string> imu_label_;
};

}  // namespace roevo
