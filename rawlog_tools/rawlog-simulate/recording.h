#pragma once
#include <memory>
#include <string>

#include "roevo_simulator/simulator.h"

namespace roevo {

/// Where simulated frames go. Nothing appears under its final name before finish().
class Recording {
  public:
    virtual ~Recording() = default;
    virtual void add(const simulator::SimulatedFrame& frame) = 0;
    virtual void finish() = 0;
};

/// F.rawlog with F_Images/ and F_groundtruth.txt beside it. @throws std::runtime_error when it cannot be
/// written
std::unique_ptr<Recording> recordRawlog(const std::string& path, const PinholeCamera& camera);

/// A folder in TUM's layout; must not exist yet, or be empty. @throws std::runtime_error when it cannot be
/// written
std::unique_ptr<Recording> recordTumFolder(const std::string& path, const PinholeCamera& camera);

}  // namespace roevo
