#pragma once
#include <string>

#include "recordings/dataset_reader.h"

namespace roevo {

/// Whether the folder is an ICL-NUIM sequence in its TUM-compatible form: images are numbered, and so are the
/// entries of associations.txt, or a ground truth *.gt.freiburg lies beside numbered images.
bool isIclFolder(const std::string& folder);

/// Reads an ICL-NUIM sequence in its TUM-compatible form (rgb/N.png, depth/N.png, associations.txt, depth in
/// 1/5000 m, N at 30 Hz). The published camera has fy = -480: its y axis points up and its ground truth lives
/// in a left-handed world. Both are turned to optical axes; whether a trajectory needs that is told by the
/// depth images where they can tell. A camera.txt overrides calibration and depth scale. The
/// ground truth is left as its file has it: convertIclTruth().
/// @throws std::runtime_error naming the file and the fault.
DatasetDescription loadIcl(const std::string& folder, const DatasetOptions& options);

/// Turns the poses of `dataset.ground_truth`, one at least, as loadIcl() says: numbers of frames become
/// times, a left-handed world a right-handed one.
void convertIclTruth(DatasetDescription& dataset);

}  // namespace roevo
