#include "recordings/bags/realsense.h"

#include <stdexcept>

#include "recordings/bags/bag_file.h"

namespace roevo::realsense {
namespace {

constexpr char kImages[] = "/image/data", kInfo[] = "/info/camera_info", kTransforms[] = "/tf/";

/// What comes before `ending`, in names of such topics; else "".
std::string folderOf(const std::string& topic, const std::string& ending) {
    if (topic.rfind("/device_", 0) != 0 || topic.size() < ending.size()) return {};
    const std::size_t at = topic.size() - ending.size();
    return topic.compare(at, ending.size(), ending) == 0 ? topic.substr(0, at) : std::string();
}

}  // namespace

void describe(BagTopic& topic) {
    const std::string folder = folderOf(topic.name, topic.isCameraInfo() ? kInfo : kImages);
    if (folder.empty()) return;
    topic.frame_id = folder;
    if (topic.encoding == "mono16" && folder.find("/Depth_") != std::string::npos)
        topic.kind = ImageKind::kDepth;
}

std::string infoTopic(const std::string& images) {
    const std::string folder = folderOf(images, kImages);
    return folder.empty() ? folder : folder + kInfo;
}

std::string transformStream(const std::string& topic) {
    const std::size_t at = topic.rfind(kTransforms);
    return topic.rfind("/device_", 0) == 0 && at != std::string::npos ? topic.substr(0, at) : std::string();
}

std::string referenceFrame(const std::string& topic) {
    return topic.substr(0, topic.find('/', 1)) + topic.substr(topic.rfind(kTransforms));
}

double depthUnit(const BagFile& bag, const std::string& images) {
    const std::string folder = folderOf(images, kImages);
    const std::string sensor = folder.substr(0, folder.rfind('/'));
    for (const char* option : {"/option/Depth Units/value", "/option/Depth_Units/value"}) {
        const BagTopic* topic = folder.empty() ? nullptr : bag.find(sensor + option);
        if (topic == nullptr || topic->type != "std_msgs/Float32" || topic->messages == 0) continue;
        const double unit = parseFloat(bag.message(topic->name, 0));
        if (!(unit >= 1e-6 && unit <= 1))
            throw std::runtime_error(topic->name + " is " + std::to_string(unit) +
                                     ": a depth unit of 0.001 (m) or so was expected");
        return unit;
    }
    return 0;
}

}  // namespace roevo::realsense
