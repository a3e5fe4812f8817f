#include "roevo-compare/report/metrics.h"

#include <algorithm>
#include <cmath>

#include "programs/text.h"

namespace roevo {
namespace {

using Value = std::optional<double>;

Value rmse(const ErrorStatistics& s, double scale) {
    if (s.count == 0) return std::nullopt;
    return s.rmse * scale;
}

template <double MethodRun::*member>
Value whenRun(const MethodRun& run, const EvaluatedRun&) {
    if (!run.ok() || run.*member <= 0) return std::nullopt;  // 0: the system or the run does not tell
    return run.*member;
}

template <const ErrorStatistics& (*statistics)(const Evaluation&), int scale>
Value error(const MethodRun&, const EvaluatedRun& evaluated) {
    if (!evaluated.evaluation) return std::nullopt;
    return rmse(statistics(*evaluated.evaluation), scale);
}

const ErrorStatistics& ate(const Evaluation& e) {
    return e.ate.translation;
}
const ErrorStatistics& secondTranslation(const Evaluation& e) {
    return e.rpe_second.translation;
}
const ErrorStatistics& secondRotation(const Evaluation& e) {
    return e.rpe_second.rotation;
}
const ErrorStatistics& frameTranslation(const Evaluation& e) {
    return e.rpe_frame.translation;
}
const ErrorStatistics& frameRotation(const Evaluation& e) {
    return e.rpe_frame.rotation;
}

Value tracked(const MethodRun& run, const EvaluatedRun&) {
    const auto share = trackedShare(run);
    if (!share) return std::nullopt;
    return *share * 100;
}

Value medianTime(const MethodRun& run, const EvaluatedRun&) {
    if (!run.ok() || run.total.median <= 0) return std::nullopt;
    return run.total.median;
}

Value p95Time(const MethodRun& run, const EvaluatedRun&) {
    if (!run.ok() || run.total.p95 <= 0) return std::nullopt;
    return run.total.p95;
}

}  // namespace

const std::vector<Metric>& shownMetrics() {
    static const std::vector<Metric> metrics{
        {"ATE RMSE", "ATE", "cm", 3, true, false, error<ate, 100>},
        {"RPE over 1 s, translation RMSE", "RPE 1 s", "cm/s", 3, true, false, error<secondTranslation, 100>},
        {"RPE over 1 s, rotation RMSE", "RPE 1 s", "deg/s", 3, true, false, error<secondRotation, 1>},
        {"RPE per frame, translation RMSE", "RPE frame", "cm", 3, true, false, error<frameTranslation, 100>},
        {"RPE per frame, rotation RMSE", "RPE frame", "deg", 3, true, false, error<frameRotation, 1>},
        {"Frames tracked", "Tracked", "%", 1, false, true, tracked},
        {"Time per frame, median", "Time, median", "ms", 2, false, false, medianTime},
        {"Time per frame, 95th percentile", "Time, p95", "ms", 2, false, false, p95Time},
        {"Processor time per frame, all threads", "Processor time", "ms", 2, false, false,
         whenRun<&MethodRun::cpu_ms_per_frame>},
        {"Memory peak", "Memory peak", "MB", 0, false, false, whenRun<&MethodRun::memory_peak_mb>},
    };
    return metrics;
}

std::optional<double> metricOf(const Metric& metric, const SequenceResults& results, std::size_t run) {
    const Value value = metric.value(results.sequence->runs[run], results.evaluated[run]);
    return value && std::isfinite(*value) ? value : std::nullopt;
}

std::vector<bool> bestRuns(const Metric& metric, const SequenceResults& results) {
    const std::size_t count = results.evaluated.size();
    std::vector<Value> values(count);
    for (std::size_t i = 0; i < count; ++i) values[i] = metricOf(metric, results, i);
    std::vector<bool> best(count, false);
    const auto missing = std::count(values.begin(), values.end(), std::nullopt);
    if (metric.is_share || count - static_cast<std::size_t>(missing) < 2) return best;

    const auto complete = [&](std::size_t i) { return values[i] && isComplete(results.sequence->runs[i]); };
    bool any_complete = false;
    for (std::size_t i = 0; i < count; ++i) any_complete = any_complete || complete(i);
    const auto counts = [&](std::size_t i) { return any_complete ? complete(i) : values[i].has_value(); };
    Value extreme;
    for (std::size_t i = 0; i < count; ++i)
        if (counts(i) && (!extreme || *values[i] < *extreme)) extreme = values[i];
    for (std::size_t i = 0; i < count; ++i)
        best[i] =
            counts(i) && shownNumber(values[i], metric.decimals) == shownNumber(extreme, metric.decimals);
    return best;
}

}  // namespace roevo
