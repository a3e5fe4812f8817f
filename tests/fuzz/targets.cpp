#include "fuzz/targets.h"

namespace roevo::fuzz {

const std::vector<Target>& targets() {
    static const std::vector<Target> all = {
        {"dataset_folder", runDatasetFolder, datasetFolderSeeds},
        {"camera_file", runCameraFile, cameraFileSeeds},
        {"calibration_file", runCalibrationFile, calibrationFileSeeds},
        {"array", runArray, arraySeeds},
        {"other_folder", runOtherFolder, otherFolderSeeds},
        {"options", runOptions, optionsSeeds},
        {"trajectory", runTrajectory, trajectorySeeds},
        {"rawlog", runRawlog, rawlogSeeds},
        {"bag", runBag, bagSeeds},
        {"map", runMap, mapSeeds},
        {"frames", runFrames, framesSeeds},
    };
    return all;
}

}  // namespace roevo::fuzz
