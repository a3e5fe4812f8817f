// roevo-render: a picture or a movie of a .3Dscene, or a 3-D view of a whole result for a browser, with no
// display.
#include <CLI/CLI.hpp>
#include <cstdio>
#include <filesystem>

#include "evaluation/association.h"
#include "evaluation/trajectory_io.h"
#include "picture.h"
#include "programs/atomic_file.h"
#include "programs/output_folder.h"
#include "programs/program.h"
#include "programs/text.h"
#include "result_folder.h"
#include "scene_content.h"
#include "web_view.h"

namespace roevo {
namespace {

namespace fs = std::filesystem;

constexpr char kName[] = "roevo-render";
constexpr double kFarthest = 1e5, kNearest = 1e-6;  // m, of points that are given
constexpr int kMinSize = 16, kMaxSize = 4096;

struct Settings {
    std::string scene, input, output, size = "1280x800", view, layer = "edges", background = "dark",
                                      ground_truth, title, name;
    std::vector<std::string> trajectories;
    std::vector<double> from, look_at;
    double max_size_mb = 15, zoom = 1, seconds = 12;
    bool no_legend = false;
};

void parseSize(const std::string& text, int& width, int& height) {
    char rest = 0;
    if (std::sscanf(text.c_str(), "%dx%d%c", &width, &height, &rest) != 2 ||
        std::min(width, height) < kMinSize || std::max(width, height) > kMaxSize)
        throw UsageError("--size: '" + text + "' is not WIDTHxHEIGHT with 16 to 4096 pixels, e.g. 1280x800");
}

// A trajectory that is not named has the name of its file. @param times  of rows that have none
NamedPath namedPath(const std::string& argument, const RowTimes& times) {
    const NamedFile named = splitNamedFile(argument);
    return {named.name.empty() ? fs::path(named.file).stem().string() : named.name,
            readTrajectory(named.file, {}, times)};
}

// Numbers of an option, which must be finite.
void requireFinite(const char* option, const std::vector<double>& values, double low, double high) {
    for (const double value : values)
        if (!(value >= low && value <= high))
            throw UsageError(std::string(option) + ": " + plainNumber(value) + " is not from " +
                             plainNumber(low) + " to " + plainNumber(high));
}

std::optional<Eigen::Vector3d> pointOf(const char* option, const std::vector<double>& values) {
    if (values.empty()) return std::nullopt;
    requireFinite(option, values, -kFarthest, kFarthest);
    return Eigen::Vector3d(values[0], values[1], values[2]);
}

int drawPicture(const Settings& settings, bool layer_wanted, bool is_movie) {
    PictureSettings picture;
    picture.output = settings.output;
    parseSize(settings.size, picture.width, picture.height);
    if (is_movie && (picture.width % 2 != 0 || picture.height % 2 != 0))
        throw UsageError("--size: " + settings.size + " is odd; a movie needs an even width and height");
    if (settings.trajectories.size() > 1)
        throw UsageError("--trajectory: a picture follows one trajectory only");
    try {
        picture.background = Background(settings.background);
    } catch (const std::invalid_argument& e) {
        throw UsageError(std::string("--background: ") + e.what());
    }
    picture.view = settings.view.empty() ? (is_movie ? "orbit" : "iso") : settings.view;
    if (is_movie != (picture.view == "orbit"))
        throw UsageError(
            "--view: " + picture.view +
            (is_movie ? " is for pictures (.png); a movie has the view orbit" : " is for movies (.mp4)"));
    if (!settings.trajectories.empty() && picture.view != "follow")
        throw UsageError("--trajectory is for .html pages, and for pictures with --view follow");
    picture.from = pointOf("--from", settings.from);
    picture.look_at = pointOf("--look-at", settings.look_at);
    if (picture.from && !picture.look_at) throw UsageError("--from: say where to look, too, by --look-at");
    if (picture.from && (*picture.from - *picture.look_at).norm() < kNearest)
        throw UsageError("--from and --look-at are the same point");
    if (picture.from && !settings.view.empty() && !is_movie)
        throw UsageError("--view: " + picture.view + " is a place to look from, and so is --from");
    requireFinite("--zoom", {settings.zoom}, 0.1, 100);
    requireFinite("--seconds", {settings.seconds}, 1, 600);
    const fs::path scene =
        settings.scene.empty() ? fs::path(settings.input) / "map.3Dscene" : fs::path(settings.scene);
    picture.scene = scene.string();
    picture.trajectory = settings.trajectories.empty() ? (scene.parent_path() / "trajectory.txt").string()
                                                       : splitNamedFile(settings.trajectories.front()).file;
    picture.layer = settings.layer;
    picture.layer_wanted = layer_wanted;
    picture.legend = !settings.no_legend;
    picture.zoom = settings.zoom;
    picture.seconds = settings.seconds;
    roevo::drawPicture(picture);
    return 0;
}

int writeView(const Settings& settings) {
    AtomicFile page(settings.output);
    page.stream();  // what cannot be written is said before the work is done
    ResultFolder result = readResultFolder(settings.input);
    if (!settings.title.empty()) result.name = settings.title;
    WebViewSettings view_settings;
    if (!settings.name.empty()) view_settings.name = settings.name;
    view_settings.truth.name = "ground truth";
    if (!settings.ground_truth.empty())
        view_settings.truth.poses = readTrajectory(settings.ground_truth);
    else if (!result.ground_truth.empty())
        view_settings.truth.poses = readTumTrajectory(result.ground_truth);
    view_settings.max_size_mb = settings.max_size_mb;
    for (const std::string& argument : settings.trajectories)
        view_settings.others.push_back(
            namedPath(argument, {stampsOf(result.trajectory), settings.input + "/trajectory.txt"}));
    const WebView view = makeWebView(result, view_settings);
    page.stream() << view.html;
    page.commit();
    for (const std::string& name : result.missing)
        printWarning(kName,
                     "there is no " + name + " in " + settings.input + "; what it has is not in the view");
    for (const std::string& note : view.notes) printWarning(kName, note);
    std::printf("%s: %.1f MB, %zu points of edges, %zu of the surface, %s%s\n", settings.output.c_str(),
                static_cast<double>(view.html.size()) / 1e6, view.edge_points, view.surface_points,
                counted(result.keyframes.size(), "keyframe").c_str(),
                view_settings.truth.poses.empty() ? "" : ", with ground truth");
    return 0;
}

int run(int argc, char** argv) {
    Settings settings;
    CLI::App app(
        "Draws a .3Dscene into a PNG or a movie, or a result of roevo-odometry into one HTML page to look "
        "around in; "
        "needs no display.",
        kName);
    auto* input = app.add_option_group("input");
    input->add_option("--scene", settings.scene, "Scene for a picture, e.g. map.3Dscene of roevo-odometry");
    input->add_option("--input", settings.input, "Result folder of roevo-odometry, for a picture or a page");
    input->require_option(1);
    app.add_option("--output", settings.output, "Picture (.png), movie (.mp4) or page (.html) to write")
        ->required();
    const CLI::Option* picture_options[] = {
        app.add_option("--size", settings.size, "Of a picture: width and height, pixels")
            ->capture_default_str(),
        app.add_option("--view", settings.view,
                       "Of a picture: where to look from (default: iso); of a movie: orbit, one turn")
            ->check(CLI::IsMember({"iso", "top", "front", "follow", "orbit"})),
        app.add_option("--layer", settings.layer, "Of a picture: what to show of the map")
            ->capture_default_str()
            ->check(CLI::IsMember(layerNames())),
        app.add_option("--background", settings.background,
                       "Of a picture: dark, white as for print, black, or #rrggbb")
            ->capture_default_str(),
        app.add_option("--look-at", settings.look_at,
                       "Of a picture: this point is in the middle of what is above the legend; x forward, y "
                       "left, z up, m")
            ->expected(3)
            ->type_name("X Y Z"),
        app.add_option("--from", settings.from,
                       "Of a picture: where the camera is, with --look-at; of a movie: where it begins, m")
            ->expected(3)
            ->type_name("X Y Z"),
        app.add_option("--zoom", settings.zoom, "Of a picture: magnifies its middle, 0.1 to 100")
            ->capture_default_str(),
        app.add_flag("--no-legend", settings.no_legend, "Of a picture: no legend and no scale bar")};
    const CLI::Option* seconds =
        app.add_option("--seconds", settings.seconds, "Of a movie: length of a turn, s, 1 to 600")
            ->capture_default_str();
    app.add_option(
        "--trajectory", settings.trajectories,
        "[NAME=]FILE, TUM, EuRoC or KITTI. Of a page: more trajectories, aligned with the ground truth or "
        "else with the result's (KITTI: with a row for each of its poses). Of a picture with the view "
        "'follow': look from behind its last camera (default: "
        "trajectory.txt beside the scene)");
    const CLI::Option* page_options[] = {
        app.add_option("--ground-truth", settings.ground_truth,
                       "Of a page: true trajectory (default: the one that the odometry was compared with)"),
        app.add_option("--title", settings.title, "Of a page: its title (default: the recording's name)"),
        app.add_option("--name", settings.name,
                       "Of a page: name of the result's own trajectory (default: final)"),
        app.add_option("--max-size", settings.max_size_mb,
                       "Of a page: points are left out where the file would be larger, MB")
            ->capture_default_str()
            ->check(CLI::Range(1.0, 1000.0))};
    app.footer(
        "Example:\n  roevo-render --scene out/map.3Dscene --output map.png --size 1600x1000 --view iso\n"
        "  roevo-render --input out --output covisibility.png --layer covisibility --view front\n"
        "  roevo-render --input out --output walk.mp4 --view orbit --background white\n"
        "  roevo-render --input out --output view.html --ground-truth groundtruth.txt --trajectory "
        "other=other.txt");
    if (auto code = parseCommandLine(app, argc, argv)) return *code;

    const std::string kind = fs::path(settings.output).extension().string();
    keepInputs("--output", settings.output, {settings.scene});
    const bool is_page = kind == ".html", is_movie = kind == ".mp4";
    if (!is_page && !is_movie && kind != ".png")
        throw UsageError("--output: '" + settings.output + "' must end in .png, .mp4 or .html");
    for (const CLI::Option* option : picture_options)
        if (is_page && option->count() > 0)
            throw UsageError(option->get_name() + " is for pictures (.png, .mp4)");
    for (const CLI::Option* option : page_options)
        if (!is_page && option->count() > 0) throw UsageError(option->get_name() + " is for pages (.html)");
    if (!is_movie && seconds->count() > 0) throw UsageError("--seconds is for movies (.mp4)");
    if (is_page && settings.input.empty())
        throw UsageError("a page is made of a result folder: give --input instead of --scene");
    return is_page ? writeView(settings) : drawPicture(settings, picture_options[2]->count() > 0, is_movie);
}

}  // namespace
}  // namespace roevo

int main(int argc, char** argv) {
    return roevo::runProgram(roevo::kName, [&] { return roevo::run(argc, argv); });
}
