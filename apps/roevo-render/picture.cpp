#include "picture.h"

#include <cmath>
#include <cstdio>
#include <opencv2/core.hpp>

#include "evaluation/trajectory_io.h"
#include "legend.h"
#include "movie.h"
#include "offscreen.h"
#include "overlay.h"
#include "programs/atomic_file.h"
#include "programs/text.h"
#include "roevo_mrpt/image_conversions.h"
#include "roevo_mrpt/scene_builder.h"
#include "scene_content.h"

namespace roevo {
namespace {

constexpr float kPointSizeHeight = 800;  // pixels; in higher pictures points grow along
constexpr double kTurn = 2 * 3.14159265358979323846;
constexpr char kOrbit[] = "orbit", kFollow[] = "follow", kTop[] = "top";

// The last camera of a trajectory, in the scene's axes (x forward, y left, z up) with an optical camera
// frame.
Eigen::Isometry3d lastCamera(const std::string& trajectory_file) {
    return (sensorFromOptical() * readTrajectory(trajectory_file).back().T_world_camera).isometry();
}

View chosenView(const PictureSettings& settings, const ViewContent& content, double aspect) {
    View view;
    if (settings.from)
        view = lookAt(*settings.from, *settings.look_at);
    else if (settings.view == kFollow)
        view = followView(lastCamera(settings.trajectory), content);
    else
        view =
            settings.view == kOrbit ? orbitView(content, aspect) : fixedView(settings.view, content, aspect);
    // A point to look at alone moves the camera along
    if (!settings.from && settings.look_at)
        view.T_scene_camera.translation() =
            *settings.look_at - view.distance * view.T_scene_camera.linear().col(2);
    return zoomed(view, settings.zoom);
}

}  // namespace

void drawPicture(const PictureSettings& settings) {
    const Background& background = settings.background;
    const auto scene = loadScene(settings.scene);
    // A scene that is none of ours has no layers: it is shown as it is
    if (settings.layer_wanted || scene->getByName(SceneNames::kEdges)) showLayer(*scene, settings.layer);
    const ViewContent content = sceneContent(*scene);
    // Seen from above, the grid would reach beyond the picture
    if (settings.view == kTop && !settings.from) cropGrid(*scene, boundsOf(content));
    const float larger = std::max(1.f, static_cast<float>(settings.height) / kPointSizeHeight);
    const bool all_layers = settings.layer == kAllLayers;
    const auto below = preparePoints(*scene, kSuperSampling * larger, background, all_layers);
    prepareGrid(*scene, background);

    const cv::Size size(settings.width, settings.height);
    const Overlay overlay(legendOf(*scene, background, all_layers), background, size);
    const cv::Size drawn(size.width, size.height - (settings.legend ? overlay.height() : 0));
    const View view = chosenView(settings, content, static_cast<double>(drawn.width) / drawn.height);
    OffscreenRenderer renderer(*scene, background, drawn);
    const auto draw = [&](const View& from) {
        cv::Mat picture = renderer.draw(from, below);
        if (drawn != size)
            cv::vconcat(picture, overlay.draw(from.pixelsPerMetre(drawn.height), from.parallel), picture);
        return picture;
    };
    std::string length;
    if (settings.view == kOrbit) {
        const auto count = static_cast<std::size_t>(std::lround(settings.seconds * kMovieRate));
        writeMovie(settings.output, size, count, [&](std::size_t i) {
            return draw(turned(view, kTurn * static_cast<double>(i) / static_cast<double>(count)));
        });
        length = ", " + counted(count, "picture");
    } else {
        const cv::Mat picture = draw(view);
        writeAtomically(settings.output, [&](const std::string& path) { writeImageFile(path, picture); });
    }
    std::printf("%s: %d x %d pixels%s, view %s, layer %s, %s%s\n", settings.output.c_str(), size.width,
                size.height, length.c_str(), settings.from ? "from a point" : settings.view.c_str(),
                settings.layer.c_str(), counted(content.cloud.size(), "point").c_str(),
                settings.legend && drawn == size ? "; too small for a legend" : "");
}

}  // namespace roevo
