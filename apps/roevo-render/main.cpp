// roevo-render: a picture of a .3Dscene, or a 3-D view of a whole result for a browser, with no display.
#include <CLI/CLI.hpp>
#include <cstdio>
#include <filesystem>

#include "evaluation/trajectory_io.h"
#include "offscreen.h"
#include "programs/atomic_file.h"
#include "programs/program.h"
#include "result_folder.h"
#include "roevo_mrpt/image_conversions.h"
#include "roevo_mrpt/scene_builder.h"
#include "scene_content.h"
#include "web_view.h"

namespace roevo {
namespace {

namespace fs = std::filesystem;

constexpr char kName[] = "roevo-render";
constexpr float kPointSizeHeight = 800;  // pixels; in higher pictures points grow along
constexpr int kMinSize = 16, kMaxSize = 4096;

struct Settings {
    std::string scene, input, output, size = "1280x800", view = "iso", layer = "edges", background = "dark",
                                      ground_truth;
    std::vector<std::string> trajectories;
    double max_size_mb = 15;
};

void parseSize(const std::string& text, int& width, int& height) {
    char rest = 0;
    if (std::sscanf(text.c_str(), "%dx%d%c", &width, &height, &rest) != 2 ||
        std::min(width, height) < kMinSize || std::max(width, height) > kMaxSize)
        throw UsageError("--size: '" + text + "' is not WIDTHxHEIGHT with 16 to 4096 pixels, e.g. 1280x800");
}

// A trajectory that is not named has the name of its file.
NamedPath namedPath(const std::string& argument) {
    const NamedFile named = splitNamedFile(argument);
    return {named.name.empty() ? fs::path(named.file).stem().string() : named.name,
            readTumTrajectory(named.file)};
}

// The last camera of a trajectory, in the scene's axes (x forward, y left, z up) with an optical camera
// frame.
Eigen::Isometry3d lastCamera(const std::string& trajectory_file) {
    Eigen::Isometry3d T_scene_world = Eigen::Isometry3d::Identity();
    T_scene_world.linear() << 0, 0, 1, -1, 0, 0, 0, -1, 0;
    return T_scene_world * readTumTrajectory(trajectory_file).back().T_world_camera.isometry();
}

int drawPicture(const Settings& settings, bool layer_wanted) {
    int width = 0, height = 0;
    parseSize(settings.size, width, height);
    if (settings.trajectories.size() > 1)
        throw UsageError("--trajectory: a picture follows one trajectory only");
    const fs::path scene_file =
        settings.scene.empty() ? fs::path(settings.input) / "map.3Dscene" : fs::path(settings.scene);
    const std::string trajectory_file = settings.trajectories.empty()
                                            ? (scene_file.parent_path() / "trajectory.txt").string()
                                            : settings.trajectories.front();

    const auto scene = loadScene(scene_file.string());
    // A scene that is none of ours has no layers: it is shown as it is
    if (layer_wanted || scene->getByName(SceneNames::kEdges)) showLayer(*scene, settings.layer);
    const ViewContent content = sceneContent(*scene);
    const View view = settings.view == "follow"
                          ? followView(lastCamera(trajectory_file), content)
                          : fixedView(settings.view, content, static_cast<double>(width) / height);
    const Background background = settings.background == "white" ? Background::kWhite : Background::kDark;
    const float larger = std::max(1.f, static_cast<float>(height) / kPointSizeHeight);
    preparePoints(*scene, kSuperSampling * larger, background);
    const cv::Mat picture = renderOffscreen(*scene, view, background, width, height);
    writeAtomically(settings.output, [&](const std::string& path) { writeImageFile(path, picture); });
    std::printf("%s: %d x %d pixels, view %s, layer %s, %zu points\n", settings.output.c_str(), width, height,
                settings.view.c_str(), settings.layer.c_str(), content.cloud.size());
    return 0;
}

// The ground truth that was asked for, or the one that the run was compared with, if it is still there.
NamedPath groundTruth(const std::string& file, const ResultFolder& result) {
    constexpr char kTruth[] = "ground truth";
    if (!file.empty()) return {kTruth, readTumTrajectory(file)};
    if (result.ground_truth.empty()) return {kTruth, {}};
    try {
        return {kTruth, readTumTrajectory(result.ground_truth)};
    } catch (const std::exception& e) {
        printWarning(
            kName, std::string("the view has no ground truth: ") + e.what() + "; name it by --ground-truth");
        return {kTruth, {}};
    }
}

int writeView(const Settings& settings) {
    AtomicFile page(settings.output);
    page.stream();  // what cannot be written is said before the work is done
    const ResultFolder result = readResultFolder(settings.input);
    WebViewSettings view_settings;
    view_settings.truth = groundTruth(settings.ground_truth, result);
    view_settings.max_size_mb = settings.max_size_mb;
    for (const std::string& argument : settings.trajectories)
        view_settings.others.push_back(namedPath(argument));
    const WebView view = makeWebView(result, view_settings);
    page.stream() << view.html;
    page.commit();
    for (const std::string& name : result.missing)
        printWarning(kName,
                     "there is no " + name + " in " + settings.input + "; what it has is not in the view");
    for (const std::string& note : view.notes) printWarning(kName, note);
    std::printf("%s: %.1f MB, %zu points of edges, %zu of the surface, %zu keyframes%s\n",
                settings.output.c_str(), static_cast<double>(view.html.size()) / 1e6, view.edge_points,
                view.surface_points, result.keyframes.size(),
                view_settings.truth.poses.empty() ? "" : ", with ground truth");
    return 0;
}

int run(int argc, char** argv) {
    Settings settings;
    CLI::App app(
        "Draws a .3Dscene into a PNG, or a result of roevo-odometry into one HTML page to look around in; "
        "needs no display.",
        kName);
    auto* input = app.add_option_group("input");
    input->add_option("--scene", settings.scene, "Scene for a picture, e.g. map.3Dscene of roevo-odometry");
    input->add_option("--input", settings.input, "Result folder of roevo-odometry, for a picture or a page");
    input->require_option(1);
    app.add_option("--output", settings.output, "Picture (.png) or page (.html) to write")->required();
    const CLI::Option* picture_options[] = {
        app.add_option("--size", settings.size, "Of a picture: width and height, pixels")
            ->capture_default_str(),
        app.add_option("--view", settings.view, "Of a picture: where to look from")
            ->capture_default_str()
            ->check(CLI::IsMember({"iso", "top", "front", "follow"})),
        app.add_option("--layer", settings.layer, "Of a picture: what to show of the map")
            ->capture_default_str()
            ->check(CLI::IsMember(layerNames())),
        app.add_option("--background", settings.background, "Of a picture: dark, or white as for print")
            ->capture_default_str()
            ->check(CLI::IsMember({"dark", "white"}))};
    app.add_option(
        "--trajectory", settings.trajectories,
        "[NAME=]FILE. Of a page: more trajectories, aligned with the ground truth or else with the "
        "result's. Of a picture with the view 'follow': look from behind its last camera (default: "
        "trajectory.txt beside the scene)");
    const CLI::Option* page_options[] = {
        app.add_option("--ground-truth", settings.ground_truth,
                       "Of a page: true trajectory (default: the one that the odometry was compared with)"),
        app.add_option("--max-size", settings.max_size_mb,
                       "Of a page: points are left out where the file would be larger, MB")
            ->capture_default_str()
            ->check(CLI::Range(1.0, 1000.0))};
    app.footer(
        "Example:\n  roevo-render --scene out/map.3Dscene --output map.png --size 1600x1000 --view iso\n"
        "  roevo-render --input out --output covisibility.png --layer covisibility --view front\n"
        "  roevo-render --input out --output view.html --ground-truth groundtruth.txt --trajectory "
        "other=other.txt");
    if (auto code = parseCommandLine(app, argc, argv)) return *code;

    const std::string kind = fs::path(settings.output).extension().string();
    if (kind != ".png" && kind != ".html")
        throw UsageError("--output: '" + settings.output + "' must end in .png or .html");
    for (const CLI::Option* option : picture_options)
        if (kind == ".html" && option->count() > 0)
            throw UsageError(option->get_name() + " is for pictures (.png)");
    for (const CLI::Option* option : page_options)
        if (kind == ".png" && option->count() > 0)
            throw UsageError(option->get_name() + " is for pages (.html)");
    if (kind == ".html" && settings.input.empty())
        throw UsageError("a page is made of a result folder: give --input instead of --scene");
    return kind == ".html" ? writeView(settings) : drawPicture(settings, picture_options[2]->count() > 0);
}

}  // namespace
}  // namespace roevo

int main(int argc, char** argv) {
    return roevo::runProgram(roevo::kName, [&] { return roevo::run(argc, argv); });
}
