#pragma once
#include <memory>
#include <optional>

#include "programs/atomic_file.h"
#include "recordings/frame_source.h"
#include "roevo/odometry.h"
#include "roevo_mrpt/rawlog_writer.h"
#include "run.h"

namespace roevo {

/// What MRPT's programs take: --simplemap and --rawlog-with-poses. Poses are those of the robot, as in
/// trajectory_robot.txt; without a mount in the input the camera looks along the robot's x axis.
class MrptOutputs {
  public:
    /// Before any work is done, so that a wrong name costs none. @throws UsageError, std::runtime_error
    MrptOutputs(const RunSettings& settings, const FrameSource& source);

    /// Under temporary names, once the map is final. Reads the input once more where its images are wanted.
    /// @throws std::runtime_error
    void write(const RunReport& report, const Odometry& odometry);

    /// Gives what was written its names. @throws std::runtime_error
    void commit();

  private:
    const RunSettings& settings_;
    std::optional<AtomicFile> simple_map_;
    std::optional<RawlogWriter> rawlog_;
    bool written_ = false;
};

}  // namespace roevo
