#pragma once
#include <map>
#include <string>

#include "recordings/dataset_reader.h"

namespace roevo {

/// A rigid 4x4 matrix in a text file. @throws std::runtime_error naming it
Pose readPoseFile(const std::string& file);

/// The ground truth of poses in a file of their own each: those that cannot be used are left out and counted
/// in its note, with the first fault.
/// @param files  by time (s). @param place  for GroundTruth::file. @param T_posed_colour  from the colour
/// camera to what the files speak of
GroundTruth readPoseFiles(const std::map<double, std::string>& files, const std::string& place,
                          const Pose& T_posed_colour);

}  // namespace roevo
