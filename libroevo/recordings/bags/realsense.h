#pragma once
/// Recordings of realsense-viewer are bags of ROS 1 with conventions of their own: every stream has a folder
/// of topics ("/device_0/sensor_0/Depth_0") with image/data, info/camera_info and tf/<group>; frames have no
/// names, so here the folder's is taken for it; depth is called mono16.

#include <string>

namespace roevo {
struct BagTopic;
class BagFile;
}  // namespace roevo

namespace roevo::realsense {

/// Frame and kind of a topic of such a recording; others are left as they are.
void describe(BagTopic& topic);

/// The topic of camera_info of these images, or "" where they are of another kind of recording.
std::string infoTopic(const std::string& images);

/// The folder of a topic "<folder>/tf/<group>" or "", and the name for the group's reference frame.
std::string transformStream(const std::string& topic);
std::string referenceFrame(const std::string& topic);

/// Metres per unit of the depth images, 0 where the recording does not tell.
double depthUnit(const BagFile& bag, const std::string& images);

}  // namespace roevo::realsense
