#pragma once
/// Ray-cast RGB-D sequences with exact depth and exact poses. No file I/O, no printing.

#include <array>
#include <memory>
#include <opencv2/core/mat.hpp>
#include <optional>
#include <string>
#include <vector>

#include "roevo/camera/pinhole_camera.h"
#include "roevo/types.h"
#include "roevo_simulator/scene.h"

namespace roevo::simulator {

enum class PathKind { kHandheld, kWalk, kBackAndForth, kLoop };

/// A depth sensor with a camera of its own, beside the colour camera.
struct DepthSensor {
    PinholeCamera camera;
    Pose T_colour_depth = Pose::Identity();
};

struct SimulationOptions {
    std::string scene = "livingroom";
    int frames = 300;
    double fps = 30;        ///< frames per second
    unsigned seed = 1;      ///< of hand tremor and noise
    double start_time = 1;  ///< seconds, stamp of frame 0
    PathKind path = PathKind::kHandheld;
    double speed = 0.45;                 ///< m/s, top speed of the camera; it slows down where it turns fast
    int width = 640, height = 480;       ///< pixels
    std::array<double, 4> intrinsics{};  ///< fx fy cx cy, pixels; all 0: f = 525 at 640x480, scaled
    std::optional<DepthSensor> depth_sensor;  ///< absent: depth is seen by the colour camera
    std::array<double, 5> distortion{};       ///< k1 k2 p1 p2 k3 of the simulated lens
    double depth_noise = 0;                   ///< 0: exact; 1: as a Kinect; other values scale it
    bool holes = false;  ///< depth missing in the projector's shadow, at grazing angles, too near, too far
    double image_noise = 0;      ///< grey levels, standard deviation
    double motion_blur = 0;      ///< seconds of exposure
    int blur_samples = 5;        ///< sub-exposures averaged when motion_blur > 0
    double exposure_drift = 0;   ///< amplitude of the slow relative change of gain, 0..0.9
    double rolling_shutter = 0;  ///< seconds from the first row's read-out to the last's
    int threads = 0;             ///< 0: as many as there are processors; has no influence on the result

    /// Sets depth_noise, holes and image_noise as on a Kinect.
    void useKinectNoise();

    /// Empty when usable, else one line naming the option, its value and what is allowed.
    std::string check() const;
};

/// "handheld", "walk", "back-and-forth", "loop". @throws std::runtime_error for another name.
PathKind pathKindFromName(const std::string& name);

struct SimulatedFrame {
    double timestamp = 0;                    ///< seconds: middle of the exposure of the middle row
    Pose T_world_camera = Pose::Identity();  ///< exact, at `timestamp`
    cv::Mat colour;                          ///< CV_8UC3, BGR, anti-aliased
    cv::Mat grey;                            ///< CV_8UC1, cv::cvtColor of `colour`
    cv::Mat depth;  ///< CV_32FC1, metres along the optical axis through the pixel's centre, exact; 0: nothing
                    ///< hit; in the pixels of the depth sensor if there is one
    cv::Mat depth_noisy;  ///< CV_32FC1, as the simulated sensor measures it; `depth` itself without noise and
                          ///< holes
    cv::Mat objects;      ///< CV_32SC1, index of the primitive seen at the pixel's centre, -1: nothing
    cv::Mat shadow_border;  ///< CV_8UC1, 1 within 2 pixels of the border of a moving cast shadow
};

/// Depth as TUM and rawlog store it: CV_16UC1 in units of 1/5000 m, rounded, 0 where unknown or beyond 13.1
/// m.
cv::Mat quantiseDepth(const cv::Mat& depth_metres);

class Simulator {
  public:
    /// @throws std::runtime_error with SimulationOptions::check()'s line, or if the scene has no such path.
    explicit Simulator(const SimulationOptions& options);
    ~Simulator();
    Simulator(Simulator&&) noexcept;

    int numFrames() const;
    const PinholeCamera& camera() const;
    const Scene& scene() const;

    /// Frame `index` in [0, numFrames()); depends only on the options and the index. Safe to call from
    /// several threads.
    SimulatedFrame frame(int index) const;

    /// Camera pose at any time, seconds after frame 0.
    Pose poseAt(double seconds) const;

    /// Seconds after which the path starts over: the pose is the same again but for the hand tremor.
    double circuitTime() const;

    /// Stamp of frame `index`, seconds.
    double timestamp(int index) const;

  private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace roevo::simulator
