#include "roevo_simulator/simulator.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <opencv2/imgproc.hpp>
#include <stdexcept>
#include <thread>

#include "camera_path.h"
#include "random.h"
#include "renderer.h"
#include "sensor.h"

namespace roevo::simulator {
namespace {

constexpr double kDriftPeriod = 7;  // seconds

bool hasIntrinsics(const SimulationOptions& options) {
    return options.intrinsics != std::array<double, 4>{};
}

PinholeCamera makeCamera(const SimulationOptions& options) {
    PinholeCamera camera;
    const double sx = options.width / 640., sy = options.height / 480.;
    camera.width = options.width, camera.height = options.height;
    camera.fx = camera.fy = 525 * sx;
    camera.cx = (319.5 + 0.5) * sx - 0.5;
    camera.cy = (239.5 + 0.5) * sy - 0.5;
    if (const auto& given = options.intrinsics; hasIntrinsics(options)) {
        camera.fx = given[0], camera.fy = given[1];
        camera.cx = given[2], camera.cy = given[3];
    }
    camera.distortion = options.distortion;
    return camera;
}

/// 1 within 2 pixels of a change of `shadow` between neighbours that show the same object.
cv::Mat borderOf(const cv::Mat& shadow, const cv::Mat& objects) {
    cv::Mat border(shadow.size(), CV_8UC1, cv::Scalar(0));
    for (int row = 0; row < shadow.rows; ++row)
        for (int col = 0; col < shadow.cols; ++col)
            for (const auto& [r, c] : {std::pair(row, col + 1), std::pair(row + 1, col)}) {
                if (r >= shadow.rows || c >= shadow.cols) continue;
                if (objects.at<int>(row, col) != objects.at<int>(r, c)) continue;
                if (shadow.at<uchar>(row, col) == shadow.at<uchar>(r, c)) continue;
                border.at<uchar>(row, col) = border.at<uchar>(r, c) = 1;
            }
    cv::dilate(border, border, cv::getStructuringElement(cv::MORPH_ELLIPSE, {3, 3}));
    return border;
}

const std::vector<Waypoint>& waypointsOf(const Scene& scene, PathKind kind) {
    if (kind == PathKind::kWalk) return scene.walk_loop;
    if (kind != PathKind::kLoop) return scene.handheld_loop;
    if (scene.round_loop.empty())
        throw std::runtime_error("scene '" + scene.name +
                                 "' has no path 'loop': there is no way round in it, as in 'block'");
    return scene.round_loop;
}

std::string complain(const std::string& option, const std::string& value, const std::string& allowed) {
    return option + " = " + value + ": must be " + allowed;
}

}  // namespace

void SimulationOptions::useKinectNoise() {
    depth_noise = 1;
    holes = true;
    image_noise = 1;
}

std::string SimulationOptions::check() const {
    const std::vector<std::string>& names = sceneNames();
    if (std::find(names.begin(), names.end(), scene) == names.end()) {
        std::string known;
        for (const std::string& name : names) known += (known.empty() ? "" : ", ") + name;
        return complain("scene", "'" + scene + "'", "one of " + known);
    }
    const auto outside = [](double value, double low, double high) {
        return !(value >= low && value <= high);
    };
    struct Range {
        const char* name;
        double value, low, high;
        const char* allowed;
    };
    const double frame_time = 1 / std::max(fps, 1e-9);
    const Range ranges[] = {{"frames", double(frames), 1, 1e7, "1..10000000"},
                            {"fps", fps, 0.1, 1000, "0.1..1000 frames per second"},
                            {"start_time", start_time, 0, 1e10, "0..1e10 s"},
                            {"speed", speed, 0.01, 3, "0.01..3 m/s"},
                            {"width", double(width), 32, 4096, "32..4096 pixels"},
                            {"height", double(height), 24, 4096, "24..4096 pixels"},
                            {"depth_noise", depth_noise, 0, 10, "0..10 (1: as a Kinect)"},
                            {"image_noise", image_noise, 0, 50, "0..50 grey levels"},
                            {"motion_blur", motion_blur, 0, frame_time, "0..1/fps s"},
                            {"blur_samples", double(blur_samples), 2, 64, "2..64"},
                            {"exposure_drift", exposure_drift, 0, 0.9, "0..0.9"},
                            {"rolling_shutter", rolling_shutter, 0, frame_time, "0..1/fps s"},
                            {"threads", double(threads), 0, 1024, "0..1024"}};
    for (const Range& range : ranges)
        if (outside(range.value, range.low, range.high))
            return complain(range.name, cv::format("%g", range.value), range.allowed);
    for (const double k : distortion)
        if (outside(k, -1.5, 1.5)) return complain("distortion", cv::format("%g", k), "-1.5..1.5");
    if (hasIntrinsics(*this))
        if (const std::string fault = makeCamera(*this).check(); !fault.empty())
            return "intrinsics: " + fault;
    if (depth_sensor)
        if (const std::string fault = depth_sensor->camera.check(); !fault.empty())
            return "depth_sensor: " + fault;
    return {};
}

PathKind pathKindFromName(const std::string& name) {
    if (name == "handheld") return PathKind::kHandheld;
    if (name == "walk") return PathKind::kWalk;
    if (name == "back-and-forth") return PathKind::kBackAndForth;
    if (name == "loop") return PathKind::kLoop;
    throw std::runtime_error("unknown path '" + name + "'; there are: handheld, walk, back-and-forth, loop");
}

cv::Mat quantiseDepth(const cv::Mat& depth_metres) {
    cv::Mat result(depth_metres.size(), CV_16UC1);
    for (int row = 0; row < depth_metres.rows; ++row)
        for (int col = 0; col < depth_metres.cols; ++col) {
            const double units = std::round(5000. * depth_metres.at<float>(row, col));
            result.at<uint16_t>(row, col) =
                units > 0 && units <= 65535 ? static_cast<uint16_t>(units) : uint16_t{0};
        }
    return result;
}

struct Simulator::Impl {
    explicit Impl(const SimulationOptions& o)
        : options(o),
          scene(makeScene(o.scene)),
          camera(makeCamera(o)),
          path(waypointsOf(scene, o.path), o.path, o.speed, o.seed),
          renderer(scene, camera, numThreads(o)) {
        if (o.depth_sensor)
            depth_renderer = std::make_unique<Renderer>(scene, o.depth_sensor->camera, numThreads(o));
    }

    static int numThreads(const SimulationOptions& o) {
        return o.threads > 0 ? o.threads : std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
    }

    /// When a row is seen, and from where. @param T_path_eye  where the camera sits on the one that travels
    std::function<Instant(double)> instants(double seconds, double height, const Pose& T_path_eye) const {
        return [this, seconds, height, T_path_eye](double row) {
            const double moment = seconds + options.rolling_shutter * ((row + 0.5) / height - 0.5);
            return Instant{path.pose(moment) * T_path_eye, moment};
        };
    }
    Rendering renderAt(double seconds) const {
        return renderer.render(instants(seconds, camera.height, Pose::Identity()),
                               options.rolling_shutter > 0);
    }
    cv::Mat depthAt(double seconds, const cv::Mat& depth_of_colour) const {
        if (!depth_renderer) return depth_of_colour;
        const DepthSensor& sensor = *options.depth_sensor;
        return depth_renderer
            ->renderDepth(instants(seconds, sensor.camera.height, sensor.T_colour_depth),
                          options.rolling_shutter > 0)
            .depth;
    }

    SimulationOptions options;
    Scene scene;
    PinholeCamera camera;
    CameraPath path;
    Renderer renderer;
    std::unique_ptr<Renderer> depth_renderer;  ///< of the depth sensor, if there is one
};

namespace {

const SimulationOptions& checked(const SimulationOptions& options) {
    const std::string problem = options.check();
    if (!problem.empty()) throw std::runtime_error("simulation option " + problem);
    return options;
}

}  // namespace

Simulator::Simulator(const SimulationOptions& options) : impl_(std::make_unique<Impl>(checked(options))) {}
Simulator::~Simulator() = default;
Simulator::Simulator(Simulator&&) noexcept = default;

int Simulator::numFrames() const {
    return impl_->options.frames;
}
const PinholeCamera& Simulator::camera() const {
    return impl_->camera;
}
const Scene& Simulator::scene() const {
    return impl_->scene;
}
Pose Simulator::poseAt(double seconds) const {
    return impl_->path.pose(seconds);
}
double Simulator::circuitTime() const {
    return impl_->path.circuitTime();
}
double Simulator::timestamp(int index) const {
    return impl_->options.start_time + index / impl_->options.fps;
}

SimulatedFrame Simulator::frame(int index) const {
    if (index < 0 || index >= numFrames())
        throw std::runtime_error(
            cv::format("simulated frame %d asked for, but there are %d", index, numFrames()));
    const SimulationOptions& options = impl_->options;
    const double seconds = index / options.fps;
    const uint64_t key = hashOf(options.seed, static_cast<uint64_t>(index), 17);

    Rendering rendering = impl_->renderAt(seconds);
    if (options.motion_blur > 0) {
        rendering.colour.setTo(0);
        for (int i = 0; i < options.blur_samples; ++i) {
            const double share = (i + 0.5) / options.blur_samples - 0.5;
            rendering.colour += impl_->renderAt(seconds + share * options.motion_blur).colour;
        }
        rendering.colour /= options.blur_samples;
    }

    SimulatedFrame frame;
    frame.timestamp = timestamp(index);
    frame.T_world_camera = poseAt(seconds);
    const double phase = 6.283185307179586 * uniformOf(hashOf(options.seed, 31));
    const double gain =
        1 + options.exposure_drift * std::sin(6.283185307179586 * seconds / kDriftPeriod + phase);
    cv::Mat levels = rendering.colour * (255 * gain);
    if (options.image_noise > 0) addImageNoise(levels, options.image_noise, key);
    levels.convertTo(frame.colour, CV_8UC3);
    cv::cvtColor(frame.colour, frame.grey, cv::COLOR_BGR2GRAY);
    frame.depth = impl_->depthAt(seconds, rendering.depth);
    frame.objects = rendering.objects;
    frame.shadow_border = borderOf(rendering.moving_shadow, rendering.objects);
    const bool ideal = options.depth_noise <= 0 && !options.holes;
    frame.depth_noisy =
        ideal ? frame.depth
              : measureDepth(frame.depth, options.depth_sensor ? options.depth_sensor->camera : impl_->camera,
                             {options.depth_noise, options.holes}, key);
    return frame;
}

}  // namespace roevo::simulator
