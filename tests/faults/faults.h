#pragma once
/// What cameras, cables, drivers and hands do to a recording: a layer between its reader and the odometry.
#include <functional>
#include <opencv2/core.hpp>
#include <string>
#include <vector>

#include "roevo/camera/pinhole_camera.h"
#include "roevo/camera/rgbd_frame.h"
#include "roevo/types.h"

namespace roevo::faults {

/// A recording held in memory, with where its camera was.
struct Recording {
    std::string name;
    PinholeCamera camera;
    std::vector<RgbdFrame> frames;
    std::vector<Pose> truth;  ///< T_world_camera of each
};

/// A frame as the odometry gets it.
struct Shown {
    RgbdFrame frame;
    Pose truth;           ///< of what the image shows
    bool faulty = false;  ///< something was done to it
};

/// What a faulty frame must come to.
enum class Expected {
    kTracked,  ///< ok, with a reason or without
    kNamed,    ///< not ok, or ok with a reason
    kAny,      ///< whatever it is: never a wrong pose without a word
    kSurvived  ///< no crash, no NaN, no status without a reason; more is not promised
};

/// Does something to the frames [from, to) of a stream that was made of a recording; may leave frames out or
/// put some in.
using Injection =
    std::function<void(const Recording&, std::vector<Shown>&, std::size_t from, std::size_t to, cv::RNG&)>;

struct Fault {
    std::string name;
    Expected expected;
    Injection inject;
};

/// All kinds.
const std::vector<Fault>& allFaults();

/// The recording with a fault from frame `from` on for `count` frames.
std::vector<Shown> inject(const Recording& recording, const Fault& fault, std::size_t from, std::size_t count,
                          std::uint64_t seed);

/// The recording with several faults of 1 to 5 frames each, some frames apart, drawn by the seed.
/// @param names  what was drawn, for people
std::vector<Shown> injectMix(const Recording& recording, std::uint64_t seed, std::string& names);

}  // namespace roevo::faults
