#include "roevo-compare/report/results.h"

#include <algorithm>
#include <cmath>
#include <exception>

#include "evaluation/scale_check.h"
#include "programs/program.h"

namespace roevo {
namespace {

EvaluatedRun evaluateRun(const SequenceComparison& sequence, const MethodRun& run) {
    EvaluatedRun result;
    if (!run.ok()) {
        result.fault = run.skipped.empty() ? run.failure : run.skipped;
        return result;
    }
    if (sequence.reference.empty()) {
        result.fault = sequence.ground_truth_fault.empty() ? "no ground truth" : sequence.ground_truth_fault;
        return result;
    }
    if (run.trajectory.empty()) {
        result.fault = "the method gave no pose";
        return result;
    }
    if (!allFinite(run.trajectory)) {
        result.fault = "a pose is not a number";
        return result;
    }
    try {
        result.evaluation = evaluate(sequence.reference, run.trajectory);
        result.scale_warning =
            scaleContradiction(sequence.reference, run.trajectory, result.evaluation->pairs);
    } catch (const std::exception& e) {
        result.fault = firstLine(e.what());
    }
    return result;
}

}  // namespace

std::vector<EvaluatedRun> evaluateRuns(const SequenceComparison& sequence) {
    std::vector<EvaluatedRun> results = sequence.errors;
    if (results.empty())
        for (const MethodRun& run : sequence.runs) results.push_back(evaluateRun(sequence, run));
    // A wrong unit of depth misleads all methods alike; what only some of them show is their own drift
    const auto evaluated = std::count_if(results.begin(), results.end(),
                                         [](const EvaluatedRun& run) { return run.evaluation.has_value(); });
    const auto contradicting = std::count_if(
        results.begin(), results.end(), [](const EvaluatedRun& run) { return !run.scale_warning.empty(); });
    if (2 * contradicting <= evaluated)
        for (EvaluatedRun& run : results) run.scale_warning.clear();
    return results;
}

std::vector<SequenceResults> evaluateAll(const std::vector<SequenceComparison>& sequences) {
    std::vector<SequenceResults> all;
    for (const SequenceComparison& sequence : sequences) all.push_back({&sequence, evaluateRuns(sequence)});
    return all;
}

std::optional<double> trackedShare(const MethodRun& run) {
    if (!run.ok() || run.frames == 0) return std::nullopt;
    return static_cast<double>(run.tracked) / static_cast<double>(run.frames);
}

bool isComplete(const MethodRun& run) {
    return trackedShare(run).value_or(0) >= kCompleteShare;
}

const std::string& labelOf(const MethodRun& run) {
    return run.label.empty() ? run.method : run.label;
}

std::vector<TableMethod> tableMethods(const std::vector<SequenceResults>& results) {
    std::vector<TableMethod> methods;
    for (const SequenceResults& result : results)
        for (const MethodRun& run : result.sequence->runs)
            if (std::none_of(methods.begin(), methods.end(),
                             [&](const TableMethod& m) { return m.name == run.method; }))
                methods.push_back({run.method, labelOf(run), run.note});
    return methods;
}

std::vector<std::string> stageNames(const std::vector<SequenceResults>& results) {
    std::vector<std::string> names;
    for (const SequenceResults& result : results)
        for (const MethodRun& run : result.sequence->runs)
            for (const StageStatistics& stage : run.stages)
                if (run.ok() && std::find(names.begin(), names.end(), stage.name) == names.end())
                    names.push_back(stage.name);
    return names;
}

std::optional<std::size_t> findRun(const SequenceComparison& sequence, const std::string& method) {
    for (std::size_t i = 0; i < sequence.runs.size(); ++i)
        if (sequence.runs[i].method == method) return i;
    return std::nullopt;
}

bool allFinite(const std::vector<StampedPose>& trajectory) {
    return std::all_of(trajectory.begin(), trajectory.end(), [](const StampedPose& pose) {
        return std::isfinite(pose.timestamp) && pose.T_world_camera.isFinite();
    });
}

std::string whyNoErrors(const SequenceComparison& sequence, const MethodRun& run,
                        const EvaluatedRun& evaluated) {
    if (evaluated.evaluation) return {};
    if (!sequence.failure.empty()) return sequence.failure;
    if (!run.skipped.empty()) return "skipped: " + run.skipped;
    if (!run.failure.empty()) return "failed: " + run.failure;
    return evaluated.fault;
}

}  // namespace roevo
