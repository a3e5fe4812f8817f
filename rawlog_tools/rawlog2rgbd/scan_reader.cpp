#include "rawlog2rgbd/scan_reader.h"

#include <mrpt/obs/CObservation3DRangeScan.h>
#include <mrpt/obs/CObservationIMU.h>

#include <chrono>
#include <stdexcept>
#include <utility>

#include "programs/program.h"
#include "roevo_mrpt/observation_converter.h"
#include "roevo_mrpt/time_conversions.h"

namespace roevo {

ScanReader::ScanReader(const std::string& rawlog, const std::string& sensor_label)
    : reader_(rawlog, sensor_label) {
    reader_.onOther([this](const mrpt::obs::CObservation& observation) { addOther(observation); });
}

std::optional<DecodedScan> ScanReader::next() {
    const auto start = std::chrono::steady_clock::now();
    DecodedScan out;
    out.scan = reader_.next();
    out.imu = std::exchange(imu_, {});
    if (!out.scan && out.imu.empty()) return std::nullopt;
    try {
        if (out.scan) out.frame = toRgbdFrame(*out.scan);  // finds every fault that the odometry would find
    } catch (const std::runtime_error& error) {
        out.fault = firstLine(error.what());
    }
    out.progress = reader_.progress();
    out.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    return out;
}

void ScanReader::addOther(const mrpt::obs::CObservation& observation) {
    using namespace mrpt::obs;
    const auto* imu = dynamic_cast<const CObservationIMU*>(&observation);
    if (imu == nullptr || !imu->has(IMU_X_ACC) || !imu->has(IMU_Y_ACC) || !imu->has(IMU_Z_ACC)) return;
    if (!imu_label_) imu_label_ = imu->sensorLabel;
    if (imu->sensorLabel != *imu_label_) return;
    ImuSample sample;
    sample.timestamp = fromMrptTime(imu->timestamp);
    sample.acceleration = {imu->get(IMU_X_ACC), imu->get(IMU_Y_ACC), imu->get(IMU_Z_ACC)};
    if (imu->has(IMU_WX) && imu->has(IMU_WY) && imu->has(IMU_WZ))
        sample.angular_velocity.emplace(imu->get(IMU_WX), imu->get(IMU_WY), imu->get(IMU_WZ));
    imu_.push_back(sample);
}

}  // namespace roevo
