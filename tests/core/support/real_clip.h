#pragma once
/// Frames of a real clip held in memory.

#include <algorithm>
#include <filesystem>
#include <map>
#include <opencv2/imgproc.hpp>
#include <optional>
#include <string>
#include <vector>

#include "evaluation/trajectory_io.h"
#include "recordings/dataset_reader.h"
#include "support/data_folder.h"

namespace roevo::testing {

struct RealFrames {
    PinholeCamera camera;
    std::vector<RgbdFrame> frames;
    std::vector<StampedPose> truth;
};

/// Its images are decoded once and shared by all who ask for them: who changes one copies it.
/// @param count  frames at most. @return nothing where there is no such clip
inline std::optional<RealFrames> realClip(const std::string& name, std::size_t count) {
    const std::string folder = test::dataFolder() + "/" + name;
    if (!std::filesystem::exists(folder)) return std::nullopt;
    static std::map<std::string, RealFrames> known;
    const DatasetReader reader = openDataset(folder);
    constexpr std::size_t kMost = 2;  // some 300 MB each
    if (known.size() == kMost && known.count(name) == 0) known.clear();
    RealFrames& whole = known[name];
    while (whole.frames.size() < std::min(count, reader.size()))
        whole.frames.push_back(reader.readFrame(whole.frames.size()));
    const auto end = whole.frames.begin() + static_cast<std::ptrdiff_t>(std::min(count, whole.frames.size()));
    return RealFrames{
        reader.camera(), {whole.frames.begin(), end}, readTumTrajectory(reader.groundTruthPath())};
}

/// The same backwards in time.
inline RealFrames reversed(RealFrames clip) {
    std::reverse(clip.frames.begin(), clip.frames.end());
    std::reverse(clip.truth.begin(), clip.truth.end());
    for (RgbdFrame& frame : clip.frames) frame.timestamp *= -1;
    for (StampedPose& pose : clip.truth) pose.timestamp *= -1;
    return clip;
}

/// As a camera with so many times the pixels in each direction might have seen it, and its frame.
inline PinholeCamera enlarged(const PinholeCamera& camera, int times) {
    PinholeCamera out = camera;
    out.width *= times;
    out.height *= times;
    out.fx *= times;
    out.fy *= times;
    out.cx = (camera.cx + 0.5) * times - 0.5;
    out.cy = (camera.cy + 0.5) * times - 0.5;
    return out;
}
inline RgbdFrame enlarged(const RgbdFrame& frame, int times) {
    RgbdFrame out;
    out.timestamp = frame.timestamp;
    const auto factor = static_cast<double>(times);
    cv::resize(frame.grey, out.grey, cv::Size(), factor, factor, cv::INTER_CUBIC);
    cv::resize(frame.depth, out.depth, cv::Size(), factor, factor, cv::INTER_NEAREST);
    return out;
}

}  // namespace roevo::testing
