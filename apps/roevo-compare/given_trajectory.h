#pragma once
#include <cstddef>
#include <string>
#include <vector>

#include "method.h"
#include "method_run.h"

namespace roevo {

/// What another program made of a recording, as if it were a method: each frame has the pose of its time,
/// where the trajectory has one within 0.02 s. So it is judged on the frames of all others.
class GivenTrajectory : public Method {
  public:
    /// @param poses  sorted by time, not empty
    GivenTrajectory(std::string file, std::vector<StampedPose> poses);

    std::vector<std::string> stages() const override { return {}; }
    MethodFrame processFrame(const RgbdFrame& frame) override;
    /// Those of its poses that belong to frames, with their own stamps.
    /// @throws std::runtime_error with both time ranges when there is none
    std::optional<std::vector<StampedPose>> finalTrajectory() override;

  private:
    std::string file_;
    std::vector<StampedPose> poses_, used_;
    std::size_t next_ = 0;  // none before it is left
    double first_frame_ = 0, last_frame_ = 0;
    bool has_frames_ = false;
};

/// Trajectories from the command line, NAME=FILE each, as methods in the order of their names.
/// @throws UsageError for a name that is missing, there twice, a method's, or not fit for tables and folders
std::vector<MethodInfo> givenTrajectories(const std::vector<std::string>& arguments);

/// Reads such a file, of any format of readTrajectory(); rows without times have those of the ground truth's
/// rows.
/// @throws std::runtime_error
std::vector<StampedPose> readGivenTrajectory(const std::string& file,
                                             const std::vector<StampedPose>& reference,
                                             const std::string& reference_file);

/// Of a run that only looked poses up: its times and its memory are not those of whoever made them.
void forgetCosts(MethodRun& run);

/// Whether a name may be that of a folder, or the last part of one.
bool isNameOfAFolder(const std::string& name);

}  // namespace roevo
