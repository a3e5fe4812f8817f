#include "method_run.h"

#include <cmath>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "evaluation/trajectory_io.h"
#include "programs/atomic_file.h"
#include "programs/program.h"

namespace roevo {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

constexpr char kRunFile[] = "run.json", kTrajectoryFile[] = "trajectory.txt";

std::string inFolder(const std::string& folder, const char* name) {
    return (fs::path(folder) / name).string();
}

// JSON has no NaN: it would become null, which no reader expects here.
double finite(double value, const char* what) {
    if (!std::isfinite(value)) throw std::runtime_error(std::string(what) + " is not a number");
    return value;
}

Json toJson(const StageStatistics& s) {
    return {{"name", s.name},
            {"median", finite(s.median, "a time's median")},
            {"p95", finite(s.p95, "a time's 95th percentile")},
            {"mean", finite(s.mean, "a time's mean")}};
}

StageStatistics toStage(const Json& json) {
    StageStatistics s;
    json.at("name").get_to(s.name);
    json.at("median").get_to(s.median);
    json.at("p95").get_to(s.p95);
    json.at("mean").get_to(s.mean);
    return s;
}

Json toJson(const MethodRun& run) {
    Json stages = Json::array();
    for (const StageStatistics& stage : run.stages) stages.push_back(toJson(stage));
    return {{"method", run.method},
            {"label", run.label},
            {"note", run.note},
            {"input", run.input},
            {"skipped", run.skipped},
            {"failure", run.failure},
            {"warnings", run.warnings},
            {"frames", run.frames},
            {"tracked", run.tracked},
            {"rejected", run.rejected},
            {"poses", run.trajectory.size()},
            {"stages_ms", stages},
            {"total_ms", toJson(run.total)},
            {"decode_ms", toJson(run.decode)},
            {"cpu_ms_per_frame", finite(run.cpu_ms_per_frame, "the processor time")},
            {"core_lost", finite(run.core_lost, "the share of the core that was lost")},
            {"background", run.background},
            {"background_ms", finite(run.background_ms, "the time of the background work")},
            {"memory_peak_mb", finite(run.memory_peak_mb, "the memory")},
            {"scene", run.scene},
            {"jobs", run.jobs},
            {"not_pinned", run.not_pinned},
            {"signal", run.signal},
            {"timeout_s", finite(run.timeout_s, "the time limit")},
            {"settings", run.settings}};
}

MethodRun toRun(const Json& json) {
    MethodRun run;
    json.at("method").get_to(run.method);
    json.at("label").get_to(run.label);
    json.at("note").get_to(run.note);
    json.at("input").get_to(run.input);
    json.at("skipped").get_to(run.skipped);
    json.at("failure").get_to(run.failure);
    json.at("warnings").get_to(run.warnings);
    json.at("frames").get_to(run.frames);
    json.at("tracked").get_to(run.tracked);
    json.at("rejected").get_to(run.rejected);
    for (const Json& stage : json.at("stages_ms")) run.stages.push_back(toStage(stage));
    run.total = toStage(json.at("total_ms"));
    run.decode = toStage(json.at("decode_ms"));
    json.at("cpu_ms_per_frame").get_to(run.cpu_ms_per_frame);
    json.at("core_lost").get_to(run.core_lost);
    json.at("background").get_to(run.background);
    json.at("background_ms").get_to(run.background_ms);
    json.at("memory_peak_mb").get_to(run.memory_peak_mb);
    json.at("scene").get_to(run.scene);
    json.at("jobs").get_to(run.jobs);
    json.at("not_pinned").get_to(run.not_pinned);
    json.at("signal").get_to(run.signal);
    json.at("timeout_s").get_to(run.timeout_s);
    json.at("settings").get_to(run.settings);
    return run;
}

}  // namespace

void writeMethodRun(const std::string& folder, const MethodRun& run) {
    const std::string file = inFolder(folder, kRunFile);
    try {
        // File names and messages may hold bytes that are not UTF-8.
        const std::string text = toJson(run).dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
        if (run.ok()) writeTumTrajectory(inFolder(folder, kTrajectoryFile), run.trajectory);
        writeTextAtomically(file, text);
    } catch (const std::exception& e) {
        throw std::runtime_error("cannot keep the run of " + run.method + ": " + firstLine(e.what()));
    }
}

MethodRun readMethodRun(const std::string& folder) {
    const std::string file = inFolder(folder, kRunFile);
    std::ifstream in(file);
    if (!in) throw std::runtime_error("there is no whole run in " + folder + ": no " + kRunFile);
    try {
        const Json json = Json::parse(in);
        MethodRun run = toRun(json);
        const auto poses = json.at("poses").get<std::size_t>();
        if (run.ok()) run.trajectory = readTumTrajectory(inFolder(folder, kTrajectoryFile));
        if (run.trajectory.size() != poses)
            throw std::runtime_error(std::string(kTrajectoryFile) + " has " +
                                     std::to_string(run.trajectory.size()) + " poses instead of " +
                                     std::to_string(poses));
        if (!run.scene.empty() && !fs::exists(inFolder(folder, run.scene.c_str())))
            throw std::runtime_error(run.scene + " is missing");
        return run;
    } catch (const std::exception& e) {
        throw std::runtime_error("the run in " + folder + " is not whole: " + firstLine(e.what()));
    }
}

}  // namespace roevo
