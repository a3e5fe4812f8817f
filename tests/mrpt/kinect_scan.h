#pragma once
#include <gtest/gtest.h>

#include <filesystem>

#include "roevo_mrpt/rawlog_reader.h"
#include "roevo_mrpt/roevo_odometry.h"
#include "roevo_mrpt/time_conversions.h"

namespace roevo::test {

/// One scan of a Kinect that MRPT ships; null where it is not installed.
inline mrpt::obs::CObservation3DRangeScan::Ptr kinectScan() {
    const char* const file = "/usr/share/mrpt/datasets/tests_rgbd.rawlog";
    return std::filesystem::exists(file) ? RawlogReader(file).next() : nullptr;
}

/// The same view at a later time.
inline mrpt::obs::CObservation3DRangeScan::Ptr laterScan(const mrpt::obs::CObservation3DRangeScan& scan,
                                                         double seconds) {
    auto later = mrpt::obs::CObservation3DRangeScan::Create(scan);
    later->timestamp = toMrptTime(fromMrptTime(scan.timestamp) + seconds);
    return later;
}

class RoevoOdometryTest : public ::testing::Test {
  protected:
    void SetUp() override {
        scan_ = kinectScan();
        if (!scan_) GTEST_SKIP() << "tests_rgbd.rawlog (package mrpt-common) not installed";
        odometry_.setMinLoggingLevel(mrpt::system::LVL_ERROR);
    }
    mrpt::obs::CObservation3DRangeScan::Ptr scan_;
    CRoevoOdometry odometry_;
};

}  // namespace roevo::test
