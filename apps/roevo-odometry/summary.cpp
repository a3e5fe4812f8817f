#include <mrpt/system/os.h>

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <iterator>
#include <map>
#include <numeric>
#include <opencv2/core/version.hpp>

#include "evaluation/to_json.h"
#include "programs/memory_peak.h"
#include "programs/program.h"
#include "programs/text.h"
#include "run_report.h"

namespace roevo {
namespace {

using Json = nlohmann::ordered_json;

constexpr FrameStatus kStatuses[] = {FrameStatus::kOk, FrameStatus::kInitialised, FrameStatus::kPredicted,
                                     FrameStatus::kLost, FrameStatus::kRejected};

struct Stage {
    const char* name;
    double (*time)(const FrameRecord&);
};
constexpr Stage kStages[] = {
    {"decode", [](const FrameRecord& f) { return f.ms_decode; }},
    {"edges", [](const FrameRecord& f) { return f.result.ms.edges; }},
    {"coarse", [](const FrameRecord& f) { return f.result.ms.coarse; }},
    {"fine", [](const FrameRecord& f) { return f.result.ms.fine; }},
    {"total", [](const FrameRecord& f) { return f.result.ms.total; }},
};
const Stage& kDecode = kStages[0];
const Stage& kTotal = kStages[4];
// What --profile shows besides.
constexpr Stage kWaiting = {"waiting", [](const FrameRecord& f) { return f.result.ms.waiting; }};
constexpr Stage kRest = {"the rest", [](const FrameRecord& f) {
                             const StageTimes& ms = f.result.ms;
                             return ms.total - ms.edges - ms.coarse - ms.fine - ms.waiting;
                         }};

// Times of one stage over the frames that went through the odometry and are such frames, ms.
template <class IsSuch>
std::vector<double> stageTimes(const RunReport& report, const Stage& stage, IsSuch&& is_such) {
    std::vector<double> times;
    for (const FrameRecord& f : report.frames)
        if (f.result.hasPose() && is_such(f)) times.push_back(stage.time(f));
    return times;
}
std::vector<double> stageTimes(const RunReport& report, const Stage& stage) {
    return stageTimes(report, stage, [](const FrameRecord&) { return true; });
}

// Times of mapping over the frames with which a keyframe's map took effect, ms.
std::vector<double> mappingTimes(const RunReport& report, double StageTimes::*time = &StageTimes::mapping) {
    std::vector<double> times;
    for (const FrameRecord& f : report.frames)
        if (f.result.ms.mapping > 0) times.push_back(f.result.ms.*time);
    return times;
}

double meanOf(const std::vector<double>& values) {
    return values.empty()
               ? 0
               : std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

// Reasons of the frames that were not tracked, with how often each occurred.
std::map<std::string, std::size_t> reasonsOf(const RunReport& report) {
    std::map<std::string, std::size_t> reasons;
    for (const FrameRecord& f : report.frames)
        if (f.result.status != FrameStatus::kOk && !f.result.reason.empty())
            ++reasons[std::string(toString(f.result.status)) + ": " + reasonWithoutFile(f.result.reason)];
    return reasons;
}

// The same for people: reasons that differ in their numbers only count as one, the commonest of them.
std::map<std::string, std::size_t> alikeReasonsOf(const RunReport& report) {
    std::map<std::string, std::map<std::string, std::size_t>> alike;
    for (const auto& [reason, count] : reasonsOf(report)) {
        std::string words;
        std::remove_copy_if(reason.begin(), reason.end(), std::back_inserter(words),
                            [](char c) { return (c >= '0' && c <= '9') || c == '.'; });
        alike[words][reason] = count;
    }
    std::map<std::string, std::size_t> out;
    for (const auto& [words, reasons] : alike) {
        std::size_t all = 0;
        for (const auto& [reason, count] : reasons) all += count;
        const auto commonest = std::max_element(
            reasons.begin(), reasons.end(), [](const auto& a, const auto& b) { return a.second < b.second; });
        out[commonest->first + (reasons.size() > 1 ? " (and the like)" : "")] = all;
    }
    return out;
}

Json cameraJson(const RunReport& report) {
    const PinholeCamera& c = report.camera;
    return {{"width", c.width},
            {"height", c.height},
            {"fx", c.fx},
            {"fy", c.fy},
            {"cx", c.cx},
            {"cy", c.cy},
            {"lens", c.lens == LensModel::kKannalaBrandt ? "kannala_brandt" : "brown_conrady"},
            {"distortion_k1_k2_p1_p2_k3", c.distortion},
            {"denominator_k4_k5_k6", c.denominator},
            {"source", report.camera_source},
            {"readout_time_s", report.readout_time},
            {"readout_learned", report.readout_learned}};
}

Json framesJson(const RunReport& report) {
    Json json = {{"total", report.frames.size()}};
    for (const FrameStatus status : kStatuses) json[toString(status)] = report.count(status);
    json["keyframes"] = report.keyframes.size();
    json["reasons"] = Json::object();
    for (const auto& [reason, count] : reasonsOf(report)) json["reasons"][reason] = count;
    return json;
}

Json timingsJson(const RunReport& report) {
    Json json;
    for (const Stage& stage : kStages) {
        const auto times = stageTimes(report, stage);
        const auto rounded = [&](double share) { return std::round(percentile(times, share) * 1000) / 1000; };
        json[stage.name] = {
            {"median", rounded(0.5)}, {"p95", rounded(0.95)}, {"p99", rounded(0.99)}, {"max", rounded(1)}};
    }
    return json;
}

// What mapping took per keyframe, beside tracking, and how long tracking waited for it.
Json mappingJson(const RunReport& report) {
    if (report.mode != Mode::kBundleAdjustment) return nullptr;
    const auto times = mappingTimes(report), cpu_times = mappingTimes(report, &StageTimes::mapping_cpu);
    double longest_wait = 0, largest_correction = 0, largest_turn = 0;
    Json reasons = Json::object(), final_reasons = Json::object();
    const auto count = [](const std::vector<MapRefusal>& refusals, Json& kinds) {
        for (const MapRefusal& refusal : refusals) {
            const char* kind = toString(refusal.kind);
            kinds[kind] = kinds.value(kind, 0) + 1;
        }
    };
    count(report.final_refusals, final_reasons);
    for (const FrameRecord& f : report.frames) {
        longest_wait = std::max(longest_wait, f.result.ms.waiting);
        largest_correction = std::max(largest_correction, f.result.map_correction);
        largest_turn = std::max(largest_turn, f.result.map_turn);
        count(f.result.map_refusals, reasons);
    }
    return {{"keyframes", times.size()},
            {"mean_ms", meanOf(times)},
            {"max_ms", percentile(times, 1)},
            {"mean_cpu_ms", meanOf(cpu_times)},
            {"max_cpu_ms", percentile(cpu_times, 1)},
            {"final_s", report.final_seconds},
            {"longest_wait_ms", longest_wait},
            {"largest_correction_m", largest_correction},
            {"largest_correction_deg", largest_turn / kDegree},
            {"reasons", reasons},
            {"final_reasons", final_reasons}};
}

// The map that the run began with, and where the camera was recognised in it first.
Json mapInJson(const RunReport& report) {
    if (!report.map_in) return nullptr;
    Json json = {{"file", report.map_in->file},
                 {"keyframes", report.map_in->keyframes},
                 {"localise_only", report.map_in->localise_only},
                 {"localised", nullptr},
                 {"segment", nullptr}};
    const FrameResult* const localised = report.localised();
    for (std::size_t i = 0; localised != nullptr && i < report.frames.size(); ++i) {
        const FrameResult& frame = report.frames[i].result;
        if (&frame != localised) continue;
        json["localised"] = {
            {"frame", i}, {"timestamp", frame.timestamp}, {"keyframe", report.mapKeyframeOf(frame)}};
    }
    if (const int segment = report.mapSegment(); segment > 0) json["segment"] = segment;
    return json;
}

Json mapOutJson(const RunReport& report) {
    if (report.map_out.file.empty()) return nullptr;
    return {{"file", report.map_out.file},
            {"keyframes", report.map_out.keyframes},
            {"covered", report.covered()},
            {"left_out", report.leftOut()}};
}

Json groundTruthJson(const RunReport& report) {
    if (report.ground_truth.empty()) return nullptr;
    // Absolute: who reads the summary may be in another folder
    Json json = {{"file", std::filesystem::absolute(report.ground_truth).string()},
                 {"max_dt_s", kDefaultMaxDt}};
    if (report.evaluation) {
        json.update(toJson(*report.evaluation));
        json["warning"] = report.scale_warning;
    } else {
        json["fault"] = report.evaluation_fault;
    }
    return json;
}

std::string keyframes(int count) {
    return counted(static_cast<std::size_t>(count), "keyframe");
}

void printErrors(const Evaluation& e) {
    std::printf("ATE         %.3f cm rmse, %.3f cm max (%zu poses, SE(3) alignment)\n",
                100 * e.ate.translation.rmse, 100 * e.ate.translation.max, e.pairs.size());
    if (e.rpe_second.translation.count > 0)
        std::printf("RPE         %.3f cm/s, %.3f deg/s over 1 s; ", 100 * e.rpe_second.translation.rmse,
                    e.rpe_second.rotation.rmse);
    else
        std::printf("RPE         no two poses are 1 s apart; ");
    std::printf("%.3f cm, %.3f deg per frame (rmse)\n", 100 * e.rpe_frame.translation.rmse,
                e.rpe_frame.rotation.rmse);
}

// In lines that fit a terminal.
void printFiles(const std::vector<std::string>& files) {
    constexpr std::size_t kWidth = 92;
    std::string line;
    for (const std::string& file : files) {
        if (!line.empty() && line.size() + file.size() > kWidth) {
            std::printf("            %s\n", line.c_str());
            line.clear();
        }
        line += (line.empty() ? "" : "  ") + file;
    }
    std::printf("            %s\n", line.c_str());
}

}  // namespace

std::string summaryJson(const RunReport& report) {
    const std::string eigen = std::to_string(EIGEN_WORLD_VERSION) + "." +
                              std::to_string(EIGEN_MAJOR_VERSION) + "." + std::to_string(EIGEN_MINOR_VERSION);
    Json json;
    std::string mrpt = mrpt::system::MRPT_getVersion();  // "MRPT 2.5.8"
    mrpt.erase(0, mrpt.find_first_of("0123456789"));
    json["versions"] = {{"roevo", versionText()}, {"mrpt", mrpt}, {"opencv", CV_VERSION}, {"eigen", eigen}};
    json["command"] = report.command;
    json["input"] = {{"path", report.input}, {"kind", report.kind}, {"warning", report.warning}};
    json["failure"] = report.failure();
    json["mode"] = toString(report.mode);
    json["camera"] = cameraJson(report);
    json["frames"] = framesJson(report);
    const Losses losses = report.losses();
    json["losses"] = {
        {"lost", losses.lost},     {"found_again", losses.found_again},   {"regained", losses.regained},
        {"joined", losses.joined}, {"loops_closed", losses.loops_closed}, {"pieces", losses.pieces}};
    json["timings_ms"] = timingsJson(report);
    json["mapping"] = mappingJson(report);
    json["dropped_frames"] = report.dropped();
    json["wall_time_s"] = report.wall_seconds;
    json["memory_peak_mb"] = memoryPeakMb();
    json["path_length_m"] = report.pathLength();
    json["map"] = {{"edges", report.map_edges},
                   {"points", report.map_points},
                   {"semi_dense_points", report.semi_dense_points}};
    json["map_in"] = mapInJson(report);
    json["map_out"] = mapOutJson(report);
    json["ground_truth"] = groundTruthJson(report);
    // File names and messages may hold bytes that are not UTF-8.
    return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

void printSummary(const RunReport& report, const std::string& output_dir) {
    std::printf("\nframes      %zu:", report.frames.size());
    const char* separator = " ";
    for (const FrameStatus status : kStatuses)
        if (const std::size_t count = report.count(status)) {
            std::printf("%s%zu %s", separator, count, toString(status));
            separator = ", ";
        }
    std::printf("; %s\n", counted(report.keyframes.size(), "keyframe").c_str());
    const std::string initialised = toString(FrameStatus::kInitialised);
    for (const auto& [reason, count] : alikeReasonsOf(report))
        if (reason.compare(0, initialised.size(), initialised) != 0 || count > 1)
            std::printf("            %zu %s\n", count, reason.c_str());
    const Losses losses = report.losses();
    if (losses.lost > 0) std::printf("losses      %s\n", losses.toText().c_str());
    if (losses.pieces > 1)
        std::printf(
            "            trajectory in %zu pieces, the join is not measured: see 'segment' in frames.csv\n",
            losses.pieces);
    if (const FrameResult* frame = report.localised())
        std::printf("map in      %s, %s: recognised at keyframe %d, %.2f s after the first frame\n",
                    report.map_in->file.c_str(), keyframes(report.map_in->keyframes).c_str(),
                    report.mapKeyframeOf(*frame), frame->timestamp - report.frames.front().result.timestamp);
    else if (report.mapSegment() > 0)
        std::printf("map in      %s, %s: recognised after the last frame\n", report.map_in->file.c_str(),
                    keyframes(report.map_in->keyframes).c_str());
    if (!report.map_out.file.empty())
        std::printf("map out     %s, %s%s\n", report.map_out.file.c_str(),
                    keyframes(report.map_out.keyframes).c_str(),
                    report.covered() > 0
                        ? (", " + std::to_string(report.covered()) + " more show the same").c_str()
                        : "");
    if (const std::size_t left_out = report.leftOut(); left_out > 0)
        std::printf("            %s of pieces that were not joined to these left out\n",
                    counted(left_out, "keyframe").c_str());
    if (losses.loops_closed > 0) std::printf("loops       %zu closed\n", losses.loops_closed);
    const auto total = stageTimes(report, kTotal);
    std::printf(
        "time        %.1f ms per frame (median), %.1f ms (95 %%), decoding apart; %.1f s in all, %.0f MB\n",
        percentile(total, 0.5), percentile(total, 0.95), report.wall_seconds, memoryPeakMb());
    if (const auto times = mappingTimes(report); !times.empty())
        std::printf(
            "mapping     %.1f ms per keyframe (mean), beside tracking; all together at the end %.1f s\n",
            meanOf(times), report.final_seconds);
    if (report.dropped() > 0)
        std::printf("dropped     %s came while tracking was busy\n",
                    counted(report.dropped(), "frame").c_str());
    std::printf("path        %.2f m\n", report.pathLength());
    std::printf("map         %s, %s; %s of the surface next to them\n",
                counted(report.map_edges, "edge").c_str(), counted(report.map_points, "point").c_str(),
                counted(report.semi_dense_points, "point").c_str());
    if (report.evaluation)
        printErrors(*report.evaluation);
    else
        std::printf("errors      %s\n",
                    report.ground_truth.empty() ? "no ground truth" : report.evaluation_fault.c_str());
    std::printf("files       %s\n", (std::filesystem::path(output_dir) / "").c_str());
    printFiles(report.files);
}

void printProfile(const RunReport& report) {
    const double decode = percentile(stageTimes(report, kDecode), 0.5);
    const auto print = [&](const std::string& name, const std::vector<double>& times) {
        if (times.empty()) return;
        const double median = percentile(times, 0.5);
        std::printf("  %-22s %8.2f %8.2f %8.2f", name.c_str(), median, percentile(times, 0.95),
                    meanOf(times));
        std::printf(decode > 0 ? " %10.2f\n" : "          -\n", median / decode);
    };
    std::printf("profile     ms per frame       median     95 %%     mean  by decode\n");
    for (const Stage* stage :
         {&kStages[0], &kStages[1], &kStages[2], &kStages[3], &kRest, &kWaiting, &kTotal})
        print(stage->name, stageTimes(report, *stage));
    const auto isNew = [](const FrameRecord& f) { return f.result.new_keyframe; };
    print("  with a new keyframe", stageTimes(report, kTotal, isNew));
    print("  without", stageTimes(report, kTotal, [&](const FrameRecord& f) { return !isNew(f); }));
    print("mapping, a keyframe", mappingTimes(report));
    print("  processor time", mappingTimes(report, &StageTimes::mapping_cpu));
}

}  // namespace roevo
