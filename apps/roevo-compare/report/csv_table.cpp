#include <algorithm>
#include <functional>
#include <utility>

#include "programs/text.h"
#include "roevo-compare/report/documents.h"
#include "roevo-compare/report/metrics.h"
#include "roevo-compare/report/protocol.h"
#include "roevo-compare/report/ranking.h"
#include "roevo-compare/report/remarks.h"

namespace roevo {
namespace {

// A row as it grows: names only in the first, so that heads and fields cannot drift apart.
class Row {
  public:
    void text(const std::string& name, const std::string& value) {
        fields_.emplace_back(name, csvField(value));
    }
    void number(const std::string& name, std::optional<double> value) {
        fields_.emplace_back(name, exactNumber(value));
    }
    void count(const std::string& name, std::optional<std::size_t> value) {
        fields_.emplace_back(name, value ? std::to_string(*value) : "");
    }
    std::string names() const {
        return line([](const auto& field) { return csvField(field.first); });
    }
    std::string values() const {
        return line([](const auto& field) { return field.second; });
    }

  private:
    using Field = std::pair<std::string, std::string>;
    std::string line(const std::function<std::string(const Field&)>& part) const {
        std::string text;
        for (const Field& field : fields_) text += (text.empty() ? "" : ",") + part(field);
        return text + '\n';
    }
    std::vector<Field> fields_;
};

void addStatistics(Row& row, const std::string& name, const std::string& unit, const ErrorStatistics* s) {
    if (s && s->count == 0) s = nullptr;
    const auto value = [&](double ErrorStatistics::*member) {
        return s ? std::optional<double>(s->*member) : std::nullopt;
    };
    row.number(name + "_rmse_" + unit, value(&ErrorStatistics::rmse));
    row.number(name + "_mean_" + unit, value(&ErrorStatistics::mean));
    row.number(name + "_median_" + unit, value(&ErrorStatistics::median));
    row.number(name + "_std_" + unit, value(&ErrorStatistics::std));
    row.number(name + "_max_" + unit, value(&ErrorStatistics::max));
    row.count(name + "_count", s ? std::optional<std::size_t>(s->count) : std::nullopt);
}

void addErrors(Row& row, const Evaluation* e) {
    row.count("associated_poses", e ? std::optional<std::size_t>(e->ate.translation.count) : std::nullopt);
    addStatistics(row, "ate", "m", e ? &e->ate.translation : nullptr);
    addStatistics(row, "rpe_second_translation", "m_per_s", e ? &e->rpe_second.translation : nullptr);
    addStatistics(row, "rpe_second_rotation", "deg_per_s", e ? &e->rpe_second.rotation : nullptr);
    addStatistics(row, "rpe_frame_translation", "m", e ? &e->rpe_frame.translation : nullptr);
    addStatistics(row, "rpe_frame_rotation", "deg", e ? &e->rpe_frame.rotation : nullptr);
}

void addTimes(Row& row, const std::string& name, const StageStatistics* s) {
    const auto value = [&](double StageStatistics::*member) {
        return s ? std::optional<double>(s->*member) : std::nullopt;
    };
    row.number(name + "_median_ms", value(&StageStatistics::median));
    row.number(name + "_p95_ms", value(&StageStatistics::p95));
    row.number(name + "_mean_ms", value(&StageStatistics::mean));
}

void addCosts(Row& row, const MethodRun* run, const std::vector<std::string>& stages) {
    const bool timed = run && run->ok() && run->tracked > 0 && run->trajectory_file.empty();
    addTimes(row, "time_total", timed ? &run->total : nullptr);
    addTimes(row, "time_decode", timed ? &run->decode : nullptr);
    for (const std::string& name : stages) {
        const StageStatistics* found = nullptr;
        if (timed)
            for (const StageStatistics& stage : run->stages)
                if (stage.name == name) found = &stage;
        addTimes(row, "time_stage_" + replaceAll(cleanText(name), " ", "_"), found);
    }
    const auto when = [&](bool known, double value) {
        return known ? std::optional<double>(value) : std::nullopt;
    };
    row.number("processor_time_per_frame_ms", when(timed, timed ? run->cpu_ms_per_frame : 0));
    const bool background = timed && !run->background.empty();
    row.text("background", background ? run->background : "");
    row.number("background_mean_ms", when(background, background ? run->background_ms : 0));
    const bool memory = run && run->ok() && run->memory_peak_mb > 0;
    row.number("memory_peak_mb", when(memory, memory ? run->memory_peak_mb : 0));
}

const char* statusOf(const SequenceComparison& sequence, const MethodRun* run) {
    if (!run || !sequence.failure.empty()) return "failed";
    if (!run->skipped.empty()) return "skipped";
    if (!run->failure.empty()) return "failed";
    return isComplete(*run) ? "ok" : "incomplete";
}

std::string joined(const std::vector<std::string>& lines) {
    std::string text;
    for (const std::string& line : lines) text += (text.empty() ? "" : "; ") + line;
    return text;
}

// Ranks among all methods, by metric and run.
std::vector<std::vector<std::optional<int>>> allRanks(const SequenceResults& results) {
    std::vector<std::vector<std::optional<int>>> ranks;
    for (const Metric& metric : shownMetrics())
        if (metric.is_error)
            ranks.push_back(rankRuns(metric, results, std::vector<bool>(results.evaluated.size(), true)));
    return ranks;
}

Row makeRow(const SequenceResults& results, std::optional<std::size_t> index,
            const std::vector<std::vector<std::optional<int>>>& ranks, const std::vector<std::string>& stages,
            Conditions conditions, const std::optional<std::string>& options) {
    const SequenceComparison& sequence = *results.sequence;
    const MethodRun* run = index ? &sequence.runs[*index] : nullptr;
    const EvaluatedRun* evaluated = index ? &results.evaluated[*index] : nullptr;
    const auto counted = [&](std::size_t MethodRun::*member) {
        return run && run->skipped.empty() ? std::optional<std::size_t>(run->*member) : std::nullopt;
    };
    Row row;
    row.text("sequence", sequence.name);
    row.text("method", run ? run->method : "");
    row.text("label", run ? run->label : "");
    row.text("status", statusOf(sequence, run));
    row.text("reason", !sequence.failure.empty() ? sequence.failure
                       : !run                    ? ""
                       : run->skipped.empty()    ? run->failure
                                                 : run->skipped);
    row.text("no_errors_because", run ? whyNoErrors(sequence, *run, *evaluated) : sequence.failure);
    row.count("frames", counted(&MethodRun::frames));
    for (const auto& [column, count] :
         {std::pair("frames_rejected", &MethodRun::rejected), {"frames_tracked", &MethodRun::tracked}})
        row.count(column, run && run->ok() ? counted(count) : std::nullopt);
    row.number("tracked_share", run ? trackedShare(*run) : std::nullopt);
    row.count("poses", run && run->ok()
                           ? std::optional<std::size_t>(std::max(run->trajectory.size(), run->poses))
                           : std::nullopt);
    addErrors(row, evaluated && evaluated->evaluation ? &*evaluated->evaluation : nullptr);
    static const char* const rank_names[] = {"rank_ate", "rank_rpe_second_translation",
                                             "rank_rpe_second_rotation", "rank_rpe_frame_translation",
                                             "rank_rpe_frame_rotation"};
    for (std::size_t k = 0; k < std::size(rank_names); ++k) {
        const auto rank = index ? ranks[k][*index] : std::nullopt;
        row.count(rank_names[k], rank ? std::optional<std::size_t>(*rank) : std::nullopt);
    }
    addCosts(row, run, stages);
    std::optional<double> length = run ? run->ground_truth_length_m : std::nullopt;
    if (run && !run->trajectory.empty() && !sequence.reference.empty())
        length = pathLength(coveredPart(sequence.reference, run->trajectory));
    row.number("ground_truth_length_m", length);
    row.number("paper_roevo_ba_ate_cm", sequence.paper_ate_cm);
    row.text("input", sequence.input);
    row.text("ground_truth", sequence.ground_truth);
    row.text("run_folder", index && *index < sequence.run_folders.size() ? sequence.run_folders[*index] : "");
    row.text("note", run ? run->note : "");
    row.text("sequence_part", run ? run->part : "");
    row.text("sequence_note", joined(sequence.notes));
    row.text("warning", run ? joined(warningsOf(*run, *evaluated, sequence, options)) : "");
    row.text("not_pinned", run ? run->not_pinned : "");
    conditions.pinned = !run || run->not_pinned.empty();
    row.text("protocol", errorProtocol(conditions) + " " + costProtocol(conditions));
    return row;
}

}  // namespace

std::string csvTable(const std::vector<SequenceResults>& results) {
    const auto stages = stageNames(results);
    const auto options = optionsRemark(results);
    std::string head, rows;
    for (const SequenceResults& result : results) {
        const auto ranks = allRanks(result);
        Conditions conditions = conditionsOf({result});
        conditions.config = !options;
        const auto add = [&](std::optional<std::size_t> run) {
            const Row row = makeRow(result, run, ranks, stages, conditions, options);
            head = row.names();
            rows += row.values();
        };
        for (std::size_t i = 0; i < result.evaluated.size(); ++i) add(i);
        if (result.evaluated.empty()) add(std::nullopt);  // a sequence that failed is a row all the same
    }
    return head + rows;
}

}  // namespace roevo
