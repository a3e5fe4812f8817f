#include "rows.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <stdexcept>
#include <utility>

#include "evaluation/trajectory_io.h"
#include "method.h"
#include "programs/atomic_file.h"
#include "programs/program.h"

namespace roevo {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

constexpr char kRunFile[] = "run.json", kTrajectoryFile[] = "trajectory.txt",
               kTruthFile[] = "groundtruth.txt", kConfigFile[] = "config_used.ini";

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
            {"not_pinned", run.not_pinned},
            {"trajectory_file", run.trajectory_file},
            {"key", run.key}};
}

MethodRun toRun(const Json& json) {
    MethodRun run;
    json.at("method").get_to(run.method);
    run.label = json.value("label", "");
    run.note = json.value("note", "");
    run.input = json.value("input", "");
    run.skipped = json.value("skipped", "");
    run.failure = json.value("failure", "");
    run.not_pinned = json.value("not_pinned", "");
    run.key = json.value("key", "");
    run.trajectory_file = json.value("trajectory_file", "");
    run.frames = json.value("frames", std::size_t{0});
    run.warnings = json.value("warnings", std::vector<std::string>());
    if (!run.ok()) return run;
    json.at("tracked").get_to(run.tracked);
    json.at("rejected").get_to(run.rejected);
    json.at("poses").get_to(run.poses);
    for (const Json& stage : json.at("stages_ms")) run.stages.push_back(toStage(stage));
    run.total = toStage(json.at("total_ms"));
    run.decode = toStage(json.at("decode_ms"));
    json.at("cpu_ms_per_frame").get_to(run.cpu_ms_per_frame);
    json.at("core_lost").get_to(run.core_lost);
    json.at("background").get_to(run.background);
    json.at("background_ms").get_to(run.background_ms);
    json.at("memory_peak_mb").get_to(run.memory_peak_mb);
    json.at("scene").get_to(run.scene);
    return run;
}

// The errors that a row keeps, by name. A template, since it is for reading and for writing.
template <class Visit, class Errors>
void forEachError(Errors& e, const Visit& visit) {
    visit("ate_m", e.ate.translation);
    visit("rpe_second_translation_m", e.rpe_second.translation);
    visit("rpe_second_rotation_deg", e.rpe_second.rotation);
    visit("rpe_frame_translation_m", e.rpe_frame.translation);
    visit("rpe_frame_rotation_deg", e.rpe_frame.rotation);
}

Json toJson(const EvaluatedRun& evaluated) {
    if (!evaluated.evaluation) return {{"fault", evaluated.fault}};
    Json json{{"scale_warning", evaluated.scale_warning}};
    forEachError(*evaluated.evaluation, [&](const char* name, const ErrorStatistics& s) {
        json[name] = nullptr;  // no two poses are that far apart
        if (s.count > 0)
            json[name] = {{"rmse", s.rmse}, {"mean", s.mean}, {"median", s.median}, {"std", s.std},
                          {"min", s.min},   {"max", s.max},   {"count", s.count}};
    });
    return json;
}

EvaluatedRun toErrors(const Json& json) {
    EvaluatedRun evaluated;
    if (json.contains("fault")) {
        json.at("fault").get_to(evaluated.fault);
        return evaluated;
    }
    evaluated.scale_warning = json.value("scale_warning", "");
    evaluated.evaluation.emplace();
    forEachError(*evaluated.evaluation, [&](const char* name, ErrorStatistics& s) {
        const Json& error = json.at(name);
        if (error.is_null()) return;
        error.at("rmse").get_to(s.rmse);
        error.at("mean").get_to(s.mean);
        error.at("median").get_to(s.median);
        error.at("std").get_to(s.std);
        error.at("min").get_to(s.min);
        error.at("max").get_to(s.max);
        error.at("count").get_to(s.count);
    });
    return evaluated;
}

Json toJson(const SequenceComparison& sequence) {
    const MethodRun& run = sequence.runs.at(0);
    Json json{{"name", sequence.name},
              {"part", run.part},
              {"notes", sequence.notes},
              {"ground_truth", sequence.ground_truth},
              {"ground_truth_fault", sequence.ground_truth_fault}};
    if (!sequence.reference.empty()) {
        const double length =
            pathLength(run.ok() ? coveredPart(sequence.reference, run.trajectory) : sequence.reference);
        json["ground_truth_length_m"] = finite(length, "the ground truth's length");
    }
    if (sequence.paper_ate_cm) json["paper_ate_cm"] = *sequence.paper_ate_cm;
    return json;
}

// A row without trajectory and ground truth.
SequenceComparison toRow(const Json& json) {
    const Json& facts = json.at("sequence");
    SequenceComparison row;
    facts.at("name").get_to(row.name);
    row.notes = facts.value("notes", std::vector<std::string>());
    row.ground_truth = facts.value("ground_truth", "");
    row.ground_truth_fault = facts.value("ground_truth_fault", "");
    if (facts.contains("paper_ate_cm")) row.paper_ate_cm = facts["paper_ate_cm"].get<double>();
    MethodRun run = toRun(json);
    run.part = facts.value("part", "");
    if (facts.contains("ground_truth_length_m"))
        run.ground_truth_length_m = facts["ground_truth_length_m"].get<double>();
    row.input = run.input;
    row.errors.push_back(run.ok() ? toErrors(json.at("errors")) : EvaluatedRun{{}, run.failure, {}});
    row.runs.push_back(std::move(run));
    return row;
}

// The trajectory of a run, from its folder. @return the ground truth, if it has one
std::vector<StampedPose> load(MethodRun& run, const std::string& folder) {
    if (!run.ok()) return {};
    run.trajectory = readTumTrajectory(inFolder(folder, kTrajectoryFile));
    if (run.trajectory.size() != run.poses)
        throw std::runtime_error(std::string(kTrajectoryFile) + " has " +
                                 std::to_string(run.trajectory.size()) + " poses instead of " +
                                 std::to_string(run.poses));
    if (!run.ground_truth_length_m) return {};
    return readTumTrajectory(inFolder(folder, kTruthFile));
}

bool sceneIsMissing(const MethodRun& run, const std::string& folder) {
    return !run.scene.empty() && !fs::exists(inFolder(folder, run.scene.c_str()));
}

std::vector<std::string> rowFiles(const std::string& path) {
    std::error_code fault;
    if (!fs::exists(path, fault))
        throw std::runtime_error("cannot read " + path + ": there is no such file or folder");
    if (!fs::is_directory(path, fault)) return {path};
    std::vector<std::string> files;
    fs::recursive_directory_iterator at(path, fs::directory_options::skip_permission_denied, fault);
    for (; !fault && at != fs::recursive_directory_iterator(); at.increment(fault)) {
        const std::string name = at->path().filename().string();
        if (name.front() == '.') at.disable_recursion_pending();  // runs that are under way, or were
        if (name == kRunFile) files.push_back(at->path().string());
    }
    if (fault) throw std::runtime_error("cannot read " + path + ": " + fault.message());
    std::sort(files.begin(), files.end());  // file systems have an order of their own
    return files;
}

class RowCollector {
  public:
    void add(const std::string& file) {
        try {
            std::ifstream in(file);
            if (!in) throw std::runtime_error("cannot read " + file);
            for (Json json; in >> std::ws && in.peek() != std::ifstream::traits_type::eof();) {
                in >> json;
                add(toRow(json), file);
            }
        } catch (const Json::exception& e) {
            rows_.notes.push_back("The row " + file + " is not whole: " + firstLine(e.what()));
        }
    }

    Rows take() {
        if (by_name_.empty())
            throw std::runtime_error("there is no row" + (rows_.notes.empty() ? "" : "; " + rows_.notes[0]));
        for (auto& [name, sequence] : by_name_) rows_.sequences.push_back(std::move(sequence));
        return std::move(rows_);
    }

  private:
    void add(SequenceComparison&& row, const std::string& file) {
        const std::string& method = row.runs[0].method;
        const auto [known, is_new] = files_.emplace(std::pair(row.name, method), file);
        if (!is_new)
            throw std::runtime_error("two rows of " + row.name + ", " + method + ": " + known->second +
                                     " and " + file);
        const auto [at, is_first] = by_name_.try_emplace(row.name);
        SequenceComparison& sequence = at->second;
        const auto place = std::upper_bound(sequence.runs.begin(), sequence.runs.end(), row.runs[0],
                                            [&](const MethodRun& a, const MethodRun& b) {
                                                return orderOf(a.method) < orderOf(b.method);
                                            }) -
                           sequence.runs.begin();
        MethodRun run = std::move(row.runs[0]);
        const fs::path folder = fs::path(file).parent_path();
        nameAsKnown(run);
        if (fs::path(file).filename() == kRunFile) {  // others are in folders of their own kind
            std::ifstream config(folder / kConfigFile);
            run.config.assign(std::istreambuf_iterator<char>(config), {});
        }
        const EvaluatedRun errors = std::move(row.errors[0]);
        // What failed may not know its recording
        if (is_first || (sequence.ground_truth.empty() && run.ok())) {
            row.runs = std::move(sequence.runs);
            row.errors = std::move(sequence.errors);
            row.run_folders = std::move(sequence.run_folders);
            sequence = std::move(row);
        }
        sequence.runs.insert(sequence.runs.begin() + place, std::move(run));
        sequence.errors.insert(sequence.errors.begin() + place, errors);
        sequence.run_folders.insert(sequence.run_folders.begin() + place, folder.string());
    }

    // What has left no row of its own does not say how it is called.
    void nameAsKnown(MethodRun& run) const {
        const std::size_t index = orderOf(run.method).first;
        if (!run.label.empty() || index == methods_.size()) return;
        const std::size_t mark = run.method.find(kVariantMark);
        run.label = methods_[index].label;
        if (mark != std::string::npos) run.label += " (" + run.method.substr(mark + 1) + ")";
        run.note = methods_[index].note;
    }

    // As in the tables of all methods; variants of a method by their names.
    std::pair<std::size_t, std::string> orderOf(const std::string& method) const {
        const std::string name = method.substr(0, method.find(kVariantMark));
        const auto is = [&](const MethodInfo& info) { return info.name == name; };
        return {std::find_if(methods_.begin(), methods_.end(), is) - methods_.begin(), method};
    }

    Rows rows_;
    std::map<std::string, SequenceComparison> by_name_;
    std::map<std::pair<std::string, std::string>, std::string> files_;
    const std::vector<MethodInfo> methods_ = knownMethods();
};

}  // namespace

void writeRow(const std::string& folder, const SequenceComparison& sequence) {
    const MethodRun& run = sequence.runs.at(0);
    try {
        Json json = toJson(run);
        json["sequence"] = toJson(sequence);
        if (run.ok()) json["errors"] = toJson(evaluateRuns(sequence).at(0));
        // File names and messages may hold bytes that are not UTF-8.
        const std::string text = json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
        if (run.ok()) {
            writeTumTrajectory(inFolder(folder, kTrajectoryFile), run.trajectory);
            if (!sequence.reference.empty())
                writeTumTrajectory(inFolder(folder, kTruthFile), sequence.reference);
        }
        writeTextAtomically(inFolder(folder, kRunFile), text);
    } catch (const std::exception& e) {
        throw std::runtime_error("cannot keep the run of " + run.method + ": " + firstLine(e.what()));
    }
}

SequenceComparison readRow(const std::string& folder) {
    std::ifstream in(inFolder(folder, kRunFile));
    if (!in) throw std::runtime_error("there is no whole run in " + folder + ": no " + kRunFile);
    try {
        SequenceComparison row = toRow(Json::parse(in));
        row.reference = load(row.runs[0], folder);
        row.errors.clear();
        if (sceneIsMissing(row.runs[0], folder)) throw std::runtime_error(row.runs[0].scene + " is missing");
        row.run_folders = {folder};
        return row;
    } catch (const std::exception& e) {
        throw std::runtime_error("the run in " + folder + " is not whole: " + firstLine(e.what()));
    }
}

void loadTrajectories(SequenceComparison& sequence) {
    for (std::size_t i = 0; i < sequence.runs.size(); ++i) {
        MethodRun& run = sequence.runs[i];
        try {
            auto reference = load(run, sequence.run_folders[i]);
            if (sceneIsMissing(run, sequence.run_folders[i])) run.scene.clear();  // maps may be thrown away
            if (sequence.reference.empty()) sequence.reference = std::move(reference);
        } catch (const std::exception& e) {
            run.failure = "its files are not whole: " + firstLine(e.what());
        }
    }
    sequence.errors.clear();
}

Rows readRows(const std::vector<std::string>& paths) {
    RowCollector collector;
    for (const std::string& path : paths)
        for (const std::string& file : rowFiles(path)) collector.add(file);
    return collector.take();
}

}  // namespace roevo
