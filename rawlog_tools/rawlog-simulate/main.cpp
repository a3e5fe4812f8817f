// rawlog-simulate: RGB-D sequences of made-up scenes with exact ground truth.
#include <CLI/CLI.hpp>
#include <cstdio>
#include <deque>
#include <filesystem>
#include <future>
#include <thread>

#include "layout.h"
#include "programs/interrupt.h"
#include "programs/program.h"
#include "programs/progress.h"
#include "programs/text.h"
#include "recording.h"

namespace roevo {
namespace {

constexpr char kName[] = "rawlog-simulate";

struct Arguments {
    simulator::SimulationOptions options;
    std::string output, noise = "none", path = "handheld", size = "640x480", layout = "rawlog";
    std::vector<double> distortion, intrinsics;
};

std::string joined(const std::vector<std::string>& names) {
    std::string all;
    for (const std::string& name : names) all += (all.empty() ? "" : ", ") + name;
    return all;
}

void addOptions(CLI::App& app, Arguments& a) {
    simulator::SimulationOptions& o = a.options;
    app.add_option("--scene", o.scene, "Scene: " + joined(simulator::sceneNames()))->required();
    app.add_option("--output", a.output,
                   "Rawlog to write (images and ground truth beside it), or folder for the other layouts")
        ->required();
    app.add_option("--frames", o.frames, "Number of frames")->capture_default_str();
    app.add_option("--fps", o.fps, "Frames per second")->capture_default_str();
    app.add_option("--seed", o.seed, "Seed of hand tremor and noise; the same seed gives the same bytes")
        ->capture_default_str();
    app.add_option("--noise", a.noise, "none, or kinect (depth noise, holes and image noise)")
        ->capture_default_str()
        ->check(CLI::IsMember({"none", "kinect"}));
    app.add_option("--depth-noise", o.depth_noise, "Depth noise, in units of a Kinect's");
    app.add_flag("--holes", o.holes, "Missing depth: projector shadow, grazing angles, too near, too far");
    app.add_option("--image-noise", o.image_noise, "Noise of the colour image, grey levels");
    app.add_option("--motion-blur", o.motion_blur, "Exposure time, s")->capture_default_str();
    app.add_option("--exposure-drift", o.exposure_drift, "Amplitude of the slow change of brightness, 0..0.9")
        ->capture_default_str();
    app.add_option("--rolling-shutter", o.rolling_shutter, "Read-out time from first to last row, s")
        ->capture_default_str();
    app.add_option(
           "--path", a.path,
           "Camera path. loop, in the scene block only, is once round the ring and on past its start: "
           "4255 frames a circuit, 2003 with --speed 1.2")
        ->capture_default_str()
        ->check(CLI::IsMember({"handheld", "walk", "back-and-forth", "loop"}));
    app.add_option("--speed", o.speed, "Top speed of the camera, m/s")->capture_default_str();
    app.add_option("--size", a.size, "Image size, WIDTHxHEIGHT")->capture_default_str();
    app.add_option("--intrinsics", a.intrinsics, "Camera: fx fy cx cy, pixels")->expected(4);
    app.add_option("--distortion", a.distortion, "Lens: k1 k2 p1 p2 k3")->expected(5);
    app.add_option("--start-time", o.start_time, "Time stamp of the first frame, s")->capture_default_str();
    app.add_option("--layout", a.layout,
                   "rawlog, or a folder as a benchmark packs it: " + joined(layoutNames()))
        ->capture_default_str()
        ->check(CLI::IsMember(layoutNames()));
    app.add_option("--threads", o.threads, "Threads, 0: one per processor; no influence on the result")
        ->capture_default_str();
    app.footer(
        "Examples:\n"
        "  rawlog-simulate --scene livingroom --frames 300 --noise kinect --output room.rawlog\n"
        "  rawlog-simulate --scene block --path loop --speed 1.2 --frames 2150 --noise kinect --output "
        "loop.rawlog");
}

void applyNames(Arguments& a) {
    if (a.noise == "kinect") {
        // Single kinds of noise given beside it keep the value given.
        const simulator::SimulationOptions given = a.options;
        a.options.useKinectNoise();
        if (given.depth_noise > 0) a.options.depth_noise = given.depth_noise;
        if (given.image_noise > 0) a.options.image_noise = given.image_noise;
    }
    a.options.path = simulator::pathKindFromName(a.path);
    int end = 0;
    if (std::sscanf(a.size.c_str(), "%dx%d%n", &a.options.width, &a.options.height, &end) != 2 ||
        a.size.size() != static_cast<size_t>(end))
        throw UsageError("--size must be WIDTHxHEIGHT, e.g. 640x480, not '" + a.size + "'");
    for (size_t i = 0; i < a.distortion.size(); ++i) a.options.distortion[i] = a.distortion[i];
    std::copy(a.intrinsics.begin(), a.intrinsics.end(), a.options.intrinsics.begin());
    std::string problem = a.options.check();
    if (problem.empty()) problem = applyLayout(a.layout, a.options);
    if (!problem.empty()) throw UsageError(problem);
    if (a.layout == "rawlog" && std::filesystem::path(a.output).extension() != ".rawlog")
        throw UsageError("--output must end in .rawlog: " + a.output);
}

int run(int argc, char** argv) {
    Arguments arguments;
    CLI::App app(
        "Simulates an RGB-D camera carried through a scene: rawlog or dataset folder and exact ground truth.",
        kName);
    addOptions(app, arguments);
    if (auto code = parseCommandLine(app, argc, argv)) return *code;
    applyNames(arguments);

    // Whole frames side by side use the processors better than the rows of one.
    const int workers = arguments.options.threads > 0
                            ? arguments.options.threads
                            : std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
    simulator::SimulationOptions options = arguments.options;
    options.threads = 1;
    const simulator::Simulator simulator(options);
    const InterruptGuard guard;
    const std::unique_ptr<Recording> recording =
        openRecording(arguments.layout, arguments.output, options, simulator.camera());
    Progress progress("simulating", static_cast<size_t>(simulator.numFrames()));
    std::deque<std::future<simulator::SimulatedFrame>> ahead;
    int started = 0;
    double length = 0;
    Eigen::Vector3d last = simulator.poseAt(0).translation();
    for (int i = 0; i < simulator.numFrames(); ++i) {
        for (; started < simulator.numFrames() && started < i + workers; ++started)
            ahead.push_back(
                std::async(std::launch::async, [&simulator, started] { return simulator.frame(started); }));
        InterruptGuard::check();
        const simulator::SimulatedFrame frame = ahead.front().get();
        ahead.pop_front();
        recording->add(frame);
        length += (frame.T_world_camera.translation() - last).norm();
        last = frame.T_world_camera.translation();
        progress.update(static_cast<size_t>(i) + 1);
    }
    progress.finish();
    recording->finish();
    std::printf("%s: %s of %s, path %.2f m\n", arguments.output.c_str(),
                counted(static_cast<std::size_t>(simulator.numFrames()), "frame").c_str(),
                options.scene.c_str(), length);
    return 0;
}

}  // namespace
}  // namespace roevo

int main(int argc, char** argv) {
    return roevo::runProgram(roevo::kName, [&] { return roevo::run(argc, argv); });
}
