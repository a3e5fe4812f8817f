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

/// Opens a recording in one of layoutNames(): F.rawlog with F_Images/ and F_groundtruth.txt beside it, or a
/// folder, which must not exist yet, or be empty.
/// @param options  after applyLayout()
/// @throws std::runtime_error when it cannot be written
std::unique_ptr<Recording> openRecording(const std::string& layout, const std::string& path,
                                         const simulator::SimulationOptions& options,
                                         const PinholeCamera& camera);

/// The same for "tum", "icl", "eth3d", "7scenes" or "plain".
std::unique_ptr<Recording> recordFolder(const std::string& layout, const std::string& path,
                                        const simulator::SimulationOptions& options,
                                        const PinholeCamera& camera);

}  // namespace roevo
