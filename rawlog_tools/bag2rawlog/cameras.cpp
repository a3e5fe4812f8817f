#include <cstdio>
#include <stdexcept>

#include "bag2rawlog/convert.h"
#include "bag2rawlog/ros_camera.h"
#include "bag2rawlog/static_transforms.h"
#include "input/excerpt.h"

namespace roevo {
namespace {

std::string sizeText(const PinholeCamera& camera) {
    return std::to_string(camera.width) + "x" + std::to_string(camera.height);
}

}  // namespace

BagCameras readCameras(const BagFile& bag, const BagTopicNames& topics) {
    const BagTopic &colour = *bag.find(topics.colour), &depth = *bag.find(topics.depth);
    BagCameras out;
    const auto use = [&](const std::string& info, const std::string& images, const char* what) {
        BagCamera found = readCamera(bag, info, images);
        out.notes.push_back(std::string(what) + ": " + sizeText(found.camera) + ", intrinsics from " +
                            found.source);
        if (!found.warning.empty()) out.notes.push_back("warning: " + found.warning);
        return found.camera;
    };
    out.colour = use(topics.colour_info, topics.colour, "colour camera");
    out.label = colour.frame_id.empty() ? colour.name : colour.frame_id;
    const bool same_frame = depth.frame_id == colour.frame_id;
    if (topics.depth_info.empty()) {
        if (!same_frame)
            throw std::runtime_error(bag.path() + ": " + depth.name + " is in frame '" +
                                     excerpt(depth.frame_id) + "', not in that of " + colour.name +
                                     ", and has no camera_info: record it, "
                                     "choose it by --depth-info-topic, or record aligned depth");
        out.depth = out.colour;
    } else {
        out.depth = use(topics.depth_info, topics.depth, "depth camera");
    }
    if (!same_frame) {
        const auto found = StaticTransforms(bag).find(depth.frame_id, colour.frame_id);
        if (!found)
            throw std::runtime_error(bag.path() +
                                     ": depth is not aligned to colour, and /tf_static does not join "
                                     "their frames '" +
                                     excerpt(depth.frame_id) + "' and '" + excerpt(colour.frame_id) +
                                     "': record /tf_static, or aligned depth");
        out.T_depth_colour = *found;
    }
    out.aligned = out.depth == out.colour && out.T_depth_colour.isApprox(Pose::Identity(), 1e-9);
    if (!out.aligned) {
        char text[128];
        std::snprintf(text, sizeof text, "%.1f mm", 1e3 * out.T_depth_colour.translation().norm());
        out.notes.push_back(
            std::string("depth is not aligned to colour; both cameras are written, ") + text + " apart" +
            (same_frame ? ": same frame, other intrinsics (should its pixels be those of colour all "
                          "the same: --depth-info-topic " +
                              topics.colour_info + ")"
                        : " by /tf_static"));
    } else {
        out.notes.emplace_back("depth is aligned to colour");
    }
    return out;
}

}  // namespace roevo
