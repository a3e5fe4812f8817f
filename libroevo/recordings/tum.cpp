#include "recordings/tum.h"

#include <filesystem>
#include <stdexcept>

#include "recordings/given_camera.h"
#include "recordings/image_lists.h"
#include "recordings/sensor_files.h"
#include "recordings/text_list.h"

namespace fs = std::filesystem;

namespace roevo {
std::optional<CameraDescription> findTumCamera(const std::string& folder_name, const FolderChoice& choice) {
    const fs::path folder(folder_name);
    if (auto given = givenCamera(folder_name, choice)) return given;
    const std::string name = fs::weakly_canonical(folder).filename().string();
    if (auto found = tumCameraNamedIn(name)) {
        found->source += " (named by the folder)";
        return found;
    }
    for (const char* list : {"rgb.txt", "depth.txt", "groundtruth.txt"})
        if (auto found = tumCameraNamedIn(readHeaderComments((folder / list).string()))) {
            found->source += std::string(" (named by ") + list + ")";
            return found;
        }
    return std::nullopt;
}

bool isTumFolder(const std::string& folder) {
    for (const char* list : {"rgb.txt", "depth.txt", "associations.txt"})
        if (fs::is_regular_file(fs::path(folder) / list)) return true;
    return false;
}

DatasetDescription loadTum(const std::string& folder_name, const DatasetOptions& options) {
    const fs::path folder(folder_name);
    DatasetDescription out;
    out.folder = folder_name;
    out.format = "tum";

    const bool has_colour = fs::exists(folder / "rgb.txt"), has_depth = fs::exists(folder / "depth.txt");
    if (!options.folder.associations.empty()) {
        // As seen from here, or else from the folder
        const fs::path given = options.folder.associations;
        readAssociations(fs::exists(given) ? fs::absolute(given).string() : given.string(),
                         options.max_time_difference, out);
        out.notes.push_back("pairs are those of " + given.string());
    } else if (has_colour && has_depth) {
        matchLists("rgb.txt", "depth.txt", options.max_time_difference, out);
        if (fs::exists(folder / "associations.txt"))
            out.notes.push_back("associations.txt was not used: rgb.txt and depth.txt were matched anew");
    } else if (fs::exists(folder / "associations.txt")) {
        readAssociations("associations.txt", options.max_time_difference, out);
    } else {
        throw std::runtime_error(folder_name + " has no " + (has_colour ? "depth.txt" : "rgb.txt") +
                                 ": not a whole TUM sequence");
    }
    finishFrames(out);

    const auto camera = findTumCamera(folder_name, options.folder);
    if (!camera)
        throw std::runtime_error(
            noIntrinsics(folder_name, " and is not named as a freiburg1, 2 or 3 sequence"));
    setCamera(*camera, out);
    out.ground_truth = readGroundTruth((folder / "groundtruth.txt").string());
    readAccelerometer((folder / "accelerometer.txt").string(), out);
    return out;
}

}  // namespace roevo
