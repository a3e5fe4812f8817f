#include "layout.h"

#include <cmath>

#include "evaluation/trajectory_io.h"
#include "recordings/seven_scenes.h"

namespace roevo {
namespace {

constexpr double kRate = 30;  // Hz

bool isDistorted(const simulator::SimulationOptions& options) {
    return options.distortion != std::array<double, 5>{};
}

bool hasIntrinsics(const simulator::SimulationOptions& options) {
    return options.intrinsics != std::array<double, 4>{};
}

}  // namespace

const char kTruthHeader[] = "# timestamp tx ty tz qx qy qz qw\n";

const std::vector<std::string>& layoutNames() {
    static const std::vector<std::string> names = {"rawlog", "tum", "icl", "eth3d", "7scenes", "plain"};
    return names;
}

PinholeCamera iclCamera(int width, int height) {
    const double sx = width / 640., sy = height / 480.;
    return {width, height, 481.2 * sx, 480 * sy, 320 * sx - 0.5, 240 * sy - 0.5, {}};
}

long frameNumber(double timestamp) {
    return std::lround(timestamp * kRate);
}

std::string truthLine(double timestamp, const Pose& T_world_camera) {
    return toTumLine({timestamp, T_world_camera}) + "\n";
}

std::string applyLayout(const std::string& layout, simulator::SimulationOptions& options) {
    const std::string name = "--layout " + layout;
    if (layout == "icl" || layout == "7scenes") {
        if (options.fps != kRate) return name + " counts frames at 30 Hz: leave out --fps";
        if (std::abs(options.start_time * kRate - static_cast<double>(frameNumber(options.start_time))) >
            1e-6)
            return name + " counts frames at 30 Hz: --start-time must be a multiple of 1/30 s";
    }
    if (layout == "icl" && !hasIntrinsics(options)) {
        const PinholeCamera camera = iclCamera(options.width, options.height);
        options.intrinsics = {camera.fx, camera.fy, camera.cx, camera.cy};
    }
    if (layout == "eth3d" && isDistorted(options))
        return name + " has no place for a lens: leave out --distortion";
    if (layout == "7scenes") {
        if (hasIntrinsics(options) || isDistorted(options) || options.width != 640 || options.height != 480)
            return name + " has one camera, 640x480: leave out --size, --intrinsics and --distortion";
        const PinholeCamera camera = sevenScenesColourCamera();
        const DepthRegistration registration = sevenScenesRegistration();
        options.intrinsics = {camera.fx, camera.fy, camera.cx, camera.cy};
        options.depth_sensor = {registration.depth_camera, registration.T_colour_depth};
    }
    return {};
}

}  // namespace roevo
