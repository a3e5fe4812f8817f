#include "run_method.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <map>
#include <new>
#include <numeric>
#include <stdexcept>

#include "core_contention.h"
#include "evaluation/error_statistics.h"
#include "odometry/input_check.h"
#include "programs/atomic_file.h"
#include "programs/memory_peak.h"
#include "programs/program.h"
#include "programs/text.h"

namespace roevo {
namespace {

namespace fs = std::filesystem;

constexpr char kSceneFile[] = "map.3Dscene";
const std::string kRejected = "rejected: ";

struct FrameRow {
    double timestamp = 0;
    bool rejected = false;
    double ms_decode = 0, ms_total = 0;
    MethodFrame result;
};

// Runs a piece of the method; what it throws is told with where it happened.
template <class Work>
auto guarded(const std::string& where, const Work& work) {
    try {
        return work();
    } catch (const std::bad_alloc&) {
        throw std::runtime_error(where + ": out of memory");
    } catch (const std::exception& e) {
        throw std::runtime_error(where + ": " + describe(e));
    } catch (...) {
        throw std::runtime_error(where + ": it threw something that is no std::exception");
    }
}

class Runner {
  public:
    Runner(Method& method, FrameSource& source) : method_(method), source_(source) {}

    void processAll(std::size_t first, const RunProgress& progress);
    std::vector<StampedPose> trajectory() const;
    MethodRun summary() const;
    std::string csv() const;

    std::vector<FrameRow> rows;
    double decode_cpu_ms = 0;

  private:
    void process(const SourceFrame& frame, FrameRow& row);
    bool next(SourceFrame& frame);
    /// How many frames were rejected, and why most of them.
    std::string refusal(const MethodRun& run) const;
    StageStatistics statistics(const std::string& name,
                               const std::function<double(const FrameRow&)>& time) const;

    Method& method_;
    FrameSource& source_;
    const std::vector<std::string> stages_ = method_.stages();
    StampCheck stamps_;
};

bool Runner::next(SourceFrame& frame) {
    const double start = processorTime(CLOCK_THREAD_CPUTIME_ID);
    const bool more = source_.next(frame);
    decode_cpu_ms += processorTime(CLOCK_THREAD_CPUTIME_ID) - start;
    return more;
}

void Runner::process(const SourceFrame& frame, FrameRow& row) {
    const std::string where =
        "at frame " + std::to_string(rows.size() + 1) + " (" + stampText(frame.timestamp) + " s)";
    const auto start = std::chrono::steady_clock::now();
    row.result = guarded(where, [&] { return method_.processFrame(frame.frame); });
    row.ms_total =
        std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();

    MethodFrame& result = row.result;
    if (result.T_world_camera)
        if (const std::string fault = poseFault(*result.T_world_camera); !fault.empty())
            throw std::runtime_error(where + ": " + fault);
    if (result.tracked && !result.T_world_camera)
        throw std::runtime_error(where + ": tracked, but without a pose");
    if (result.stage_ms.size() != stages_.size())
        throw std::runtime_error(where + ": " + std::to_string(result.stage_ms.size()) + " times for " +
                                 std::to_string(stages_.size()) + " stages");
}

void Runner::processAll(std::size_t first, const RunProgress& progress) {
    SourceFrame frame;
    while ((first == 0 || rows.size() < first) && next(frame)) {
        FrameRow row;
        row.timestamp = frame.timestamp;
        row.ms_decode = frame.ms_decode;
        const bool readable = frame.fault.empty();
        const std::string fault = readable ? stamps_.take(frame.timestamp).words : frame.fault;
        row.rejected = !fault.empty();
        if (!row.rejected) {
            process(frame, row);
        } else {
            if (readable) method_.refused(frame.frame);
            row.result.reason = kRejected + fault;
        }
        rows.push_back(std::move(row));
        const double of_first = first > 0 ? static_cast<double>(rows.size()) / static_cast<double>(first) : 0;
        if (progress) progress(rows.size(), std::max(frame.progress, of_first));
    }
}

std::vector<StampedPose> Runner::trajectory() const {
    std::vector<StampedPose> poses;
    if (auto refined = guarded("at the end", [&] { return method_.finalTrajectory(); })) {
        poses = std::move(*refined);
    } else {
        for (const FrameRow& row : rows)
            if (row.result.T_world_camera) poses.push_back({row.timestamp, *row.result.T_world_camera});
    }
    for (std::size_t i = 0; i < poses.size(); ++i) {
        const std::string where = "in the final trajectory at " + stampText(poses[i].timestamp) + " s: ";
        if (const std::string fault = poseFault(poses[i].T_world_camera); !fault.empty())
            throw std::runtime_error(where + fault);
        if (i > 0 && !(poses[i].timestamp > poses[i - 1].timestamp))
            throw std::runtime_error(where + "the time stamps do not ascend");
    }
    if (!poses.empty()) return poses;
    const auto reason =
        std::find_if(rows.begin(), rows.end(), [](const FrameRow& r) { return !r.result.reason.empty(); });
    throw std::runtime_error("none of the " + std::to_string(rows.size()) + " frames has a pose" +
                             (reason == rows.end() ? "" : "; the first says: " + reason->result.reason));
}

StageStatistics Runner::statistics(const std::string& name,
                                   const std::function<double(const FrameRow&)>& time) const {
    std::vector<double> times;
    for (const FrameRow& row : rows)
        if (row.result.tracked) times.push_back(time(row));
    if (times.empty()) return {name, 0, 0, 0};
    return {name, percentile(times, 0.5), percentile(times, 0.95),
            std::accumulate(times.begin(), times.end(), 0.0) / static_cast<double>(times.size())};
}

std::string Runner::refusal(const MethodRun& run) const {
    std::map<std::string, std::size_t> reasons;
    for (const FrameRow& row : rows)
        if (row.rejected) ++reasons[row.result.reason];
    const auto most = std::max_element(reasons.begin(), reasons.end(),
                                       [](const auto& a, const auto& b) { return a.second < b.second; });
    const std::string share =
        most->second < run.rejected ? ", " + std::to_string(most->second) + " of them" : "";
    return std::to_string(run.rejected) + " of " + std::to_string(run.frames) + " frames cannot be used" +
           share + ": " + most->first.substr(kRejected.size());
}

MethodRun Runner::summary() const {
    MethodRun run;
    run.frames = rows.size();
    for (const FrameRow& row : rows) {
        run.tracked += row.result.tracked;
        run.rejected += row.rejected;
    }
    for (std::size_t i = 0; i < stages_.size(); ++i)
        run.stages.push_back(
            statistics(stages_[i], [i](const FrameRow& row) { return row.result.stage_ms[i]; }));
    run.total = statistics("total", [](const FrameRow& row) { return row.ms_total; });
    run.decode = statistics("decode", [](const FrameRow& row) { return row.ms_decode; });
    if (const auto background = method_.background()) {
        run.background = background->name;
        run.background_ms = background->mean_ms;
    }
    if (!source_.warning().empty()) run.warnings.push_back(source_.warning());
    if (run.rejected > 0) run.warnings.push_back(refusal(run));
    return run;
}

std::string Runner::csv() const {
    std::string text = "timestamp,tracked,reason,ms_decode";
    for (const std::string& stage : stages_) text += "," + csvField("ms_" + replaceAll(stage, " ", "_"));
    text += ",ms_total\n";
    char number[64];
    for (const FrameRow& row : rows) {
        std::snprintf(number, sizeof number, "%.6f,%d,", row.timestamp, row.result.tracked ? 1 : 0);
        text += number + csvField(row.result.reason);
        const auto add = [&](double ms) {
            std::snprintf(number, sizeof number, ",%.3f", ms);
            text += number;
        };
        add(row.ms_decode);
        for (std::size_t i = 0; i < stages_.size(); ++i) add(row.rejected ? 0 : row.result.stage_ms[i]);
        add(row.ms_total);
        text += '\n';
    }
    return text;
}

}  // namespace

std::string poseFault(const Pose& pose) {
    return pose.isFinite() ? "" : "the pose is not a number";
}

MethodRun runMethod(Method& method, const MethodInfo& info, FrameSource& source, std::size_t first,
                    const std::string& folder, const RunProgress& progress) {
    Runner runner(method, source);
    const CoreContention contention;
    const double start = processorTime(CLOCK_PROCESS_CPUTIME_ID);
    runner.processAll(first, progress);
    // Work that was put off till the end is the method's, too: its time counts from before the trajectory.
    std::vector<StampedPose> trajectory = runner.trajectory();
    const double cpu_ms = processorTime(CLOCK_PROCESS_CPUTIME_ID) - start - runner.decode_cpu_ms;
    const double core_lost = contention.shareLost();

    MethodRun run = runner.summary();
    run.method = info.name;
    run.label = info.label;
    run.note = info.note;
    run.trajectory = std::move(trajectory);
    // Some frame has a pose, so that some frame was not rejected
    run.cpu_ms_per_frame = cpu_ms / static_cast<double>(run.frames - run.rejected);
    run.core_lost = core_lost;
    run.memory_peak_mb = memoryPeakMb();  // before the scene is made, which no odometry needs

    writeTextAtomically((fs::path(folder) / "frames.csv").string(), runner.csv());
    try {
        if (method.writeScene((fs::path(folder) / kSceneFile).string())) run.scene = kSceneFile;
    } catch (const std::exception& e) {  // the figures are good all the same
        run.warnings.push_back("no scene: " + firstLine(e.what()));
    }
    return run;
}

}  // namespace roevo
