#include "result_folder.h"

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "evaluation/trajectory_io.h"
#include "input/regular_file.h"
#include "ply_file.h"

namespace roevo {
namespace {

namespace fs = std::filesystem;

void readSummary(const std::string& path, ResultFolder& result) {
    requireRegularInput(path);
    std::ifstream in(path, std::ios::binary);
    const auto json = nlohmann::json::parse(in, nullptr, false);
    try {
        if (json.contains("input")) {  // a run of roevo-compare has none
            fs::path input = json.at("input").at("path").get<std::string>();
            if (input.filename().empty()) input = input.parent_path();  // "folder/"
            result.name = input.filename().string();
        }
        result.mode = json.at("mode").get<std::string>();
        if (json.contains("path_length_m")) result.path_length = json.at("path_length_m").get<double>();
        const auto& camera = json.at("camera");
        PinholeCamera pinhole;
        pinhole.width = camera.at("width").get<int>(), pinhole.height = camera.at("height").get<int>();
        pinhole.fx = camera.at("fx").get<double>(), pinhole.fy = camera.at("fy").get<double>();
        pinhole.cx = camera.at("cx").get<double>(), pinhole.cy = camera.at("cy").get<double>();
        if (pinhole.check().empty()) result.camera = pinhole;
        const auto truth = json.value("ground_truth", nlohmann::json());
        if (truth.is_object() && truth.contains("ate_m") && result.ground_truth.empty())
            result.missing.emplace_back("trajectory_truth.txt");
    } catch (const nlohmann::json::exception&) {
        throw std::runtime_error(path + " is no summary of roevo-odometry; is it cut off?");
    }
}

}  // namespace

ResultFolder readResultFolder(const std::string& folder) {
    if (!fs::exists(folder)) throw std::runtime_error("cannot read " + folder + ": there is no such folder");
    if (!fs::is_directory(folder))
        throw std::runtime_error("cannot read " + folder +
                                 ": it is no folder; give a result folder of roevo-odometry");
    const auto file = [&](const char* name) { return (fs::path(folder) / name).string(); };
    if (!fs::exists(file("trajectory.txt")))
        throw std::runtime_error("no trajectory.txt in " + folder +
                                 "; give a result folder of roevo-odometry");

    ResultFolder result;
    result.name = fs::canonical(folder).filename().string();
    result.trajectory = readTumTrajectory(file("trajectory.txt"));
    const auto take = [&](const char* name, const auto& read) {
        if (fs::exists(file(name)))
            read(file(name));
        else
            result.missing.emplace_back(name);
    };
    take("trajectory_live.txt", [&](const std::string& path) { result.live = readTumTrajectory(path); });
    take("keyframes.txt", [&](const std::string& path) { result.keyframes = readTumTrajectory(path); });
    for (const char* name : {"trajectory_truth.txt", "groundtruth.txt"})  // the other is of roevo-compare
        if (result.ground_truth.empty() && fs::exists(file(name))) result.ground_truth = file(name);
    take("summary.json", [&](const std::string& path) { readSummary(path, result); });
    take("map.ply", [&](const std::string& path) { result.edges = readEdgesPly(path); });
    take("map_semi_dense.ply", [&](const std::string& path) { result.surface = readPointsPly(path); });
    return result;
}

}  // namespace roevo
