#include "roevo-compare/report/scene_picture.h"

#include <filesystem>
#include <stdexcept>

#include "programs/interrupt.h"
#include "programs/process.h"
#include "programs/text.h"
#include "roevo-compare/report/scratch_folder.h"

namespace roevo {
namespace {

namespace fs = std::filesystem;

constexpr double kTimeout = 120;     // s; a picture takes about one
constexpr char kSize[] = "960x640";  // px: sharp in print at half a page's width
constexpr char kRenderer[] = "roevo-render";

std::string draw(const std::string& renderer, const std::string& scene, const std::string& layer) {
    const ScratchFolder scratch;
    const std::string picture = scratch.file("map.png");
    ChildProcess process(
        {renderer, "--scene", scene, "--output", picture, "--size", kSize, "--view", "iso", "--layer", layer},
        -1, kTimeout);
    const ProcessEnd& end = process.finish();
    if (end.timed_out) throw std::runtime_error(std::string(kRenderer) + " did not come to an end");
    if (end.signal != 0)
        throw std::runtime_error(std::string(kRenderer) + " was ended by signal " +
                                 std::to_string(end.signal));
    if (!end.ok()) throw std::runtime_error(process.lastError());
    const std::string png = readWhole(picture);
    if (png.empty()) throw std::runtime_error(std::string(kRenderer) + " drew nothing");
    return png;
}

}  // namespace

ScenePicture renderScene(const std::string& scene, const std::string& layer) {
    try {
        std::error_code error;
        const fs::path renderer = fs::read_symlink("/proc/self/exe", error).parent_path() / kRenderer;
        if (error || !fs::exists(renderer, error))
            return {"", std::string(kRenderer) + " is not beside this program"};
        if (!fs::exists(scene, error))
            return {"", "the scene " + fs::path(scene).filename().string() + " is missing"};
        return {draw(renderer.string(), scene, layer), ""};
    } catch (const Interrupted&) {
        throw;
    } catch (const std::exception& e) {
        return {"", cleanText(e.what())};
    }
}

}  // namespace roevo
