#include "recordings/bags/bag_camera.h"

#include <algorithm>
#include <optional>
#include <stdexcept>

#include "input/excerpt.h"
#include "recordings/bags/inverse_lens.h"
#include "recordings/bags/topic_choice.h"
#include "recordings/lens.h"

namespace roevo {
namespace {

void setDistortion(const CameraInfoMessage& message, bool of_depth, PinholeCamera& camera) {
    const bool inverse = message.distortion_model == "Inverse Brown Conrady";
    const auto zero = [](double k) { return k == 0; };
    if (!inverse || !of_depth)
        setLens(inverse ? "" : message.distortion_model, message.D, camera);
    else if (!std::all_of(message.D.begin(), message.D.end(), zero))
        camera.distortion = distortionOfInverse(camera, message.D);
}

/// The message tells the camera of the whole sensor: of what of it the image is made, and in how many pixels.
void toImage(const CameraInfoMessage& message, PinholeCamera& camera) {
    const double x = std::max(1u, message.binning_x), y = std::max(1u, message.binning_y);
    const bool part = message.roi_width > 0 && message.roi_height > 0;
    camera.width = static_cast<int>((part ? message.roi_width : message.width) / x);
    camera.height = static_cast<int>((part ? message.roi_height : message.height) / y);
    camera.fx /= x, camera.cx = (camera.cx - (part ? message.roi_x : 0)) / x;
    camera.fy /= y, camera.cy = (camera.cy - (part ? message.roi_y : 0)) / y;
}

}  // namespace

PinholeCamera cameraOf(const CameraInfoMessage& message, bool rectified, bool of_depth) {
    PinholeCamera camera;
    camera.width = static_cast<int>(message.width);
    camera.height = static_cast<int>(message.height);
    if (rectified) {
        const auto& P = message.P;
        camera.fx = P[0], camera.cx = P[2], camera.fy = P[5], camera.cy = P[6];
    } else {
        const auto& K = message.K;
        camera.fx = K[0], camera.cx = K[2], camera.fy = K[4], camera.cy = K[5];
        if (camera.check().empty()) setDistortion(message, of_depth, camera);
    }
    if (camera.fx == 0 || camera.fy == 0)
        throw std::runtime_error(std::string("the camera is not calibrated: ") + (rectified ? "P" : "K") +
                                 " is zero");
    toImage(message, camera);
    if (const std::string fault = camera.check(); !fault.empty()) throw std::runtime_error(fault);
    return camera;
}

BagCamera readCamera(const BagFile& bag, const std::string& info_topic, const BagTopic& images,
                     bool of_depth) {
    const std::string base = imageTopicBase(images.name);
    const bool rectified = base.substr(base.rfind('/') + 1).find("rect") != std::string::npos;
    BagCamera out;
    std::size_t others = 0;
    const std::size_t all = bag.count(info_topic);
    std::optional<PinholeCamera> first;
    std::string fault = "it has no message";
    for (std::size_t i = 0; i < all; i++) {
        try {
            CameraInfoMessage info = parseCameraInfo(bag.message(info_topic, i));
            if (info.width == images.width && info.height == images.height)  // of the image as it is
                info.binning_x = info.binning_y = info.roi_width = info.roi_height = 0;
            const PinholeCamera camera = cameraOf(info, rectified, of_depth);
            if (!first) first = camera;
            if (camera != *first) others++;
        } catch (const std::runtime_error& error) {
            if (others++ == 0) fault = error.what();
        }
    }
    if (!first) throw std::runtime_error(bag.path() + ": " + info_topic + ": " + fault);
    out.camera = *first;
    const PinholeCamera& camera = out.camera;
    if (images.width > 0 &&
        (static_cast<int>(images.width) != camera.width || static_cast<int>(images.height) != camera.height))
        throw std::runtime_error(bag.path() + ": " + images.name + " has images of " +
                                 std::to_string(images.width) + "x" + std::to_string(images.height) +
                                 ", but its camera_info " + info_topic + " is for " +
                                 std::to_string(camera.width) + "x" + std::to_string(camera.height) +
                                 ": choose another one (--info-topic, --depth-info-topic)");
    out.source = info_topic + (rectified ? " (P, rectified images)" : "");
    if (others > 0)
        out.warning = info_topic + ": " + std::to_string(others) + " of " + std::to_string(all) +
                      " messages differ from the first that is whole, which is used";
    return out;
}

}  // namespace roevo
