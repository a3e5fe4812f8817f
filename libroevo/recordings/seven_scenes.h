#pragma once
#include <string>

#include "recordings/dataset_reader.h"

namespace roevo {

/// Whether the folder is a sequence (seq-XX) of the 7-Scenes dataset: frame-000000.color.png and so on.
bool isSevenScenesFolder(const std::string& folder);

/// The cameras that users of 7-Scenes agree on, none being published with it but the depth camera's
/// f = 585, c = (320, 240): colour f = 525, c = (320, 240), and the pose of one to the other from a
/// calibration of another Kinect v1 (LIRIS, University of Lyon), as in the relocalisation literature.
PinholeCamera sevenScenesColourCamera();
DepthRegistration sevenScenesRegistration();

/// Reads a 7-Scenes sequence: frame-N.color.png, .depth.png (mm, 65535 = unknown, of the depth camera),
/// .pose.txt (4x4, depth camera to world), N at 30 Hz. Frames have depth registered to colour, and poses are
/// moved to the colour camera. A camera.txt says that depth is registered already: it overrides cameras and
/// depth scale, and poses stay.
/// @throws std::runtime_error naming the file and the fault.
DatasetDescription loadSevenScenes(const std::string& folder, const DatasetOptions& options);

}  // namespace roevo
