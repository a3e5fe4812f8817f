// roevo-render: a picture of a .3Dscene, with no display.
#include <CLI/CLI.hpp>
#include <cstdio>
#include <filesystem>

#include "evaluation/trajectory_io.h"
#include "offscreen.h"
#include "programs/atomic_file.h"
#include "programs/program.h"
#include "roevo_mrpt/image_conversions.h"
#include "roevo_mrpt/scene_builder.h"
#include "scene_content.h"

namespace roevo {
namespace {

constexpr char kName[] = "roevo-render";
constexpr float kPointSizeHeight = 800;  // pixels; in higher pictures points grow along
constexpr int kMinSize = 16, kMaxSize = 4096;

void parseSize(const std::string& text, int& width, int& height) {
    char rest = 0;
    if (std::sscanf(text.c_str(), "%dx%d%c", &width, &height, &rest) != 2 ||
        std::min(width, height) < kMinSize || std::max(width, height) > kMaxSize)
        throw UsageError("--size: '" + text + "' is not WIDTHxHEIGHT with 16 to 4096 pixels, e.g. 1280x800");
}

// The last camera of a trajectory, in the scene's axes (x forward, y left, z up) with an optical camera
// frame.
Eigen::Isometry3d lastCamera(const std::string& trajectory_file) {
    Eigen::Isometry3d T_scene_world = Eigen::Isometry3d::Identity();
    T_scene_world.linear() << 0, 0, 1, -1, 0, 0, 0, -1, 0;
    return T_scene_world * readTumTrajectory(trajectory_file).back().T_world_camera.isometry();
}

int run(int argc, char** argv) {
    std::string scene_file, output, size = "1280x800", view_name = "iso", layer = "edges", trajectory_file;
    CLI::App app("Draws a .3Dscene into a PNG; needs no display.", kName);
    app.add_option("--scene", scene_file, "Scene, e.g. map.3Dscene of roevo-odometry")->required();
    app.add_option("--output", output, "Picture to write (.png)")->required();
    app.add_option("--size", size, "Width and height, pixels")->capture_default_str();
    app.add_option("--view", view_name, "Where to look from")
        ->capture_default_str()
        ->check(CLI::IsMember({"iso", "top", "front", "follow"}));
    const auto* layer_option = app.add_option("--layer", layer, "What to show of the map")
                                   ->capture_default_str()
                                   ->check(CLI::IsMember(layerNames()));
    app.add_option(
        "--trajectory", trajectory_file,
        "For the view 'follow': look from behind its last camera (default: trajectory.txt beside the scene)");
    app.footer(
        "Example:\n  roevo-render --scene out/map.3Dscene --output map.png --size 1600x1000 --view iso\n"
        "  roevo-render --scene out/map.3Dscene --output covisibility.png --layer covisibility --view front");
    if (auto code = parseCommandLine(app, argc, argv)) return *code;

    int width = 0, height = 0;
    parseSize(size, width, height);
    if (std::filesystem::path(output).extension() != ".png")
        throw UsageError("--output: '" + output + "' must end in .png");
    if (trajectory_file.empty())
        trajectory_file = (std::filesystem::path(scene_file).parent_path() / "trajectory.txt").string();

    const auto scene = loadScene(scene_file);
    // A scene that is none of ours has no layers: it is shown as it is
    if (layer_option->count() > 0 || scene->getByName(SceneNames::kEdges)) showLayer(*scene, layer);
    const ViewContent content = sceneContent(*scene);
    const View view = view_name == "follow"
                          ? followView(lastCamera(trajectory_file), content)
                          : fixedView(view_name, content, static_cast<double>(width) / height);
    preparePoints(*scene, kSuperSampling * std::max(1.f, static_cast<float>(height) / kPointSizeHeight));
    const cv::Mat picture = renderOffscreen(*scene, view, width, height);
    writeAtomically(output, [&](const std::string& path) { writeImageFile(path, picture); });
    std::printf("%s: %d x %d pixels, view %s, layer %s, %zu points\n", output.c_str(), width, height,
                view_name.c_str(), layer.c_str(), content.cloud.size());
    return 0;
}

}  // namespace
}  // namespace roevo

int main(int argc, char** argv) {
    return roevo::runProgram(roevo::kName, [&] { return roevo::run(argc, argv); });
}
