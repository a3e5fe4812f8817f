#pragma once
#include <vector>

#include "recordings/dataset_reader.h"

namespace roevo {

/// Turns poses of a camera with y up in a left-handed world into those of the optical camera (y down) in a
/// right-handed one: T -> M T M with M = diag(1, -1, 1).
void mirrorY(std::vector<StampedPose>& poses);

struct HandednessResult {
    bool mirrored = true;    ///< the ground truth needs mirrorY()
    bool decided = false;    ///< told by the depth images, not assumed
    double error_as_is = 0;  ///< mean relative error of depth predicted from another frame, cut at 0.1
    double error_mirrored = 0;
};

/// Tells whether `dataset.ground_truth` has the handedness of the images: depth images are moved into other
/// frames by either version of the poses, and the wrong one misses. Assumes the published convention
/// (left-handed, to be mirrored) where frames are too few or motion too small to tell.
HandednessResult compareHandedness(const DatasetDescription& dataset);

}  // namespace roevo
