#include "recordings/plain.h"

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <stdexcept>

#include "recordings/given_camera.h"
#include "recordings/image_lists.h"
#include "recordings/sensor_files.h"

namespace fs = std::filesystem;

namespace roevo {
namespace {

constexpr double kUsualRate = 30;  // Hz

using Names = std::vector<std::string>;

std::string lowerCase(std::string text) {
    std::transform(text.begin(), text.end(), text.begin(),
                   [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    return text;
}

/// The folder in this one that has the first of these names, or an empty path.
fs::path findFolder(const fs::path& folder, const Names& names) {
    fs::path found;
    std::size_t best = names.size();
    std::error_code fault;
    for (const auto& entry : fs::directory_iterator(folder, fault)) {
        if (!entry.is_directory(fault)) continue;
        const auto name = std::find(names.begin(), names.end(), lowerCase(entry.path().filename().string()));
        const auto rank = static_cast<std::size_t>(name - names.begin());
        if (rank >= best) continue;
        best = rank;
        found = entry.path();
    }
    return found;
}

/// Images that lie side by side, by what their names say.
ImagePair sideBySide(const std::string& folder) {
    ImagePair out;
    out.colour_place = out.depth_place = folder;
    NamedImages unnamed;
    for (const auto& [name, file] : imagesIn(folder)) {
        const std::string words = lowerCase(name);
        const auto says = [&](const char* word) { return words.find(word) != std::string::npos; };
        if (says("depth"))
            out.depth[name] = file;
        else if (says("rgb") || says("color") || says("colour"))
            out.colour[name] = file;
        else
            unnamed[name] = file;
    }
    if (out.colour.empty()) out.colour = unnamed;
    return out;
}

}  // namespace

std::optional<ImagePair> findImages(const std::string& folder_name) {
    const fs::path folder(folder_name);
    const fs::path colour = findFolder(folder, {"rgb", "color", "colour", "images", "image", "rgb_images",
                                                "color_images", "rgb_image", "color_image"});
    const fs::path depth = findFolder(
        folder, {"aligned_depth", "depth_aligned", "depth", "depths", "depth_images", "depth_image"});
    if (!colour.empty() && !depth.empty())
        return ImagePair{imagesIn(colour), imagesIn(depth), colour.string(), depth.string()};
    ImagePair pair = sideBySide(folder_name);
    if (pair.colour.empty() || pair.depth.empty()) return std::nullopt;
    return pair;
}

bool isPlainFolder(const std::string& folder) {
    return findImages(folder).has_value();
}

DatasetDescription loadPlain(const std::string& folder_name, const DatasetOptions& options) {
    const fs::path folder(folder_name);
    DatasetDescription out;
    out.folder = folder_name;
    out.format = "plain";
    const auto images = findImages(folder_name);
    if (!images)
        throw std::runtime_error(
            folder_name +
            " has no folder depth/ with rgb/ or color/ beside it, nor images with 'depth' "
            "and 'rgb' or 'color' in their names");
    requireImages(images->colour, images->colour_place);
    requireImages(images->depth, images->depth_place);
    const auto camera = givenCamera(folder_name, options.folder);
    if (!camera) throw std::runtime_error(noIntrinsics(folder_name));
    const bool told = camera->frame_rate || options.folder.frame_rate > 0;
    const double rate = frameRate(options.folder, camera, kUsualRate);
    std::string times = pairByName(images->colour, images->depth, rate, options.max_time_difference, out);
    if (!told && times.find("Hz") != std::string::npos)
        times += " (assumed; frame_rate in camera.txt or --frame-rate sets it)";
    out.notes.push_back(times);
    finishFrames(out);
    setCamera(*camera, out);
    out.ground_truth = readGroundTruth((folder / "groundtruth.txt").string());
    return out;
}

}  // namespace roevo
