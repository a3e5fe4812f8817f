#include "roevo-compare/report/scene_picture.h"

#include <filesystem>
#include <functional>
#include <stdexcept>

#include "evaluation/trajectory_io.h"
#include "programs/interrupt.h"
#include "programs/process.h"
#include "programs/text.h"
#include "roevo-compare/report/scratch_folder.h"

namespace roevo {
namespace {

namespace fs = std::filesystem;

constexpr double kTimeout = 120;        // s; a picture takes about one
constexpr char kSize[] = "960x640";     // px: sharp in print at half a page's width
constexpr char kMostMegabytes[] = "6";  // of a 3-D view: a report may have 40
constexpr char kRenderer[] = "roevo-render";

// @param arguments  without --output. @param kind  of file, ".png"
std::string render(std::vector<std::string> arguments, const char* kind) {
    std::error_code error;
    const fs::path renderer = fs::read_symlink("/proc/self/exe", error).parent_path() / kRenderer;
    if (error || !fs::exists(renderer, error))
        throw std::runtime_error(std::string(kRenderer) + " is not beside this program");
    const ScratchFolder scratch;
    const std::string file = scratch.file(std::string("made") + kind);
    arguments.insert(arguments.begin(), renderer.string());
    arguments.insert(arguments.end(), {"--output", file});
    ChildProcess process(arguments, -1, kTimeout);
    const ProcessEnd& end = process.finish();
    if (end.timed_out) throw std::runtime_error(std::string(kRenderer) + " did not come to an end");
    if (end.signal != 0)
        throw std::runtime_error(std::string(kRenderer) + " was ended by signal " +
                                 std::to_string(end.signal));
    if (!end.ok()) throw std::runtime_error(process.lastError());
    const std::string bytes = readWhole(file);
    if (bytes.empty()) throw std::runtime_error(std::string(kRenderer) + " drew nothing");
    return bytes;
}

Rendered orFault(const std::function<std::string()>& make) {
    try {
        return {make(), ""};
    } catch (const Interrupted&) {
        throw;
    } catch (const std::exception& e) {
        return {"", cleanText(e.what())};
    }
}

}  // namespace

Rendered renderScene(const std::string& scene, const std::string& layer) {
    return orFault([&] {
        std::error_code error;
        if (!fs::exists(scene, error))
            throw std::runtime_error("the scene " + fs::path(scene).filename().string() + " is missing");
        return render({"--scene", scene, "--size", kSize, "--view", "iso", "--layer", layer}, ".png");
    });
}

Rendered renderView(const ViewedRun& run, const NamedTrajectories& others,
                    const std::vector<StampedPose>& truth) {
    return orFault([&] {
        const ScratchFolder scratch;
        std::vector<std::string> arguments{"--input=" + run.folder, "--title=" + run.recording,
                                           "--name=" + run.name, std::string("--max-size=") + kMostMegabytes};
        const auto file = [&](const std::string& name, const std::vector<StampedPose>& poses) {
            writeTumTrajectory(scratch.file(name), poses);
            return scratch.file(name);
        };
        if (!truth.empty()) arguments.insert(arguments.end(), {"--ground-truth", file("truth", truth)});
        if (!others.empty()) arguments.emplace_back("--trajectory");
        for (std::size_t i = 0; i < others.size(); ++i)  // a name ends at the first '='
            arguments.push_back(replaceAll(others[i].first, "=", ":") + "=" +
                                file(std::to_string(i), others[i].second));
        return render(arguments, ".html");
    });
}

}  // namespace roevo
