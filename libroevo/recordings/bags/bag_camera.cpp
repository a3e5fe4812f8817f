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

void setDistortion(const CameraInfoMessage& message, PinholeCamera& camera) {
    const bool inverse = message.distortion_model == "Inverse Brown Conrady";  // of RealSense
    const auto zero = [](double k) { return k == 0; };
    if (!inverse)
        setLens(message.distortion_model, message.D, camera);
    else if (!std::all_of(message.D.begin(), message.D.end(), zero))
        camera.distortion = distortionOfInverse(camera, message.D);
}

}  // namespace

PinholeCamera cameraOf(const CameraInfoMessage& message, bool rectified) {
    PinholeCamera camera;
    camera.width = static_cast<int>(message.width);
    camera.height = static_cast<int>(message.height);
    if (rectified) {
        const auto& P = message.P;
        camera.fx = P[0], camera.cx = P[2], camera.fy = P[5], camera.cy = P[6];
    } else {
        const auto& K = message.K;
        camera.fx = K[0], camera.cx = K[2], camera.fy = K[4], camera.cy = K[5];
        if (camera.check().empty()) setDistortion(message, camera);
    }
    if (camera.fx == 0 || camera.fy == 0)
        throw std::runtime_error(std::string("the camera is not calibrated: ") + (rectified ? "P" : "K") +
                                 " is zero");
    if (const std::string fault = camera.check(); !fault.empty()) throw std::runtime_error(fault);
    return camera;
}

BagCamera readCamera(const BagFile& bag, const std::string& info_topic, const BagTopic& images) {
    const std::string base = imageTopicBase(images.name);
    const bool rectified = base.substr(base.rfind('/') + 1).find("rect") != std::string::npos;
    BagCamera out;
    std::size_t others = 0;
    const std::size_t all = bag.count(info_topic);
    std::optional<PinholeCamera> first;
    std::string fault = "it has no message";
    for (std::size_t i = 0; i < all; i++) {
        try {
            const PinholeCamera camera = cameraOf(parseCameraInfo(bag.message(info_topic, i)), rectified);
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
