#include "runs.h"

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <utility>

#include "machine_info.h"
#include "programs/text.h"

namespace roevo {
namespace {

namespace fs = std::filesystem;

// All that a run depends on but the method itself.
std::map<std::string, std::string> runSettings(const CompareSettings& settings, const SequenceInput& sequence,
                                               const std::string& program) {
    OdometryOptions options = settings.options;
    options.mode = OdometryOptions().mode;  // each method has its own
    std::string values, chosen, versions;
    for (const OptionField& field : optionFields(options))
        values += field.name() + "=" + field.toText() + "; ";
    for (const auto& [option, value] : chosenOptions(sequence.choice)) chosen += option + " " + value + "; ";
    for (const auto& [name, version] : softwareVersions()) versions += name + " " + version + "; ";
    std::map<std::string, std::string> all{{"recording", recordingState(sequence.input, settings.output)},
                                           {"choice", chosen},
                                           {"skip", std::to_string(sequence.skip)},
                                           {"first", std::to_string(sequence.first)},
                                           {"options", values},
                                           {"program", program},
                                           {"versions", versions},
                                           {"processor", processorName()}};
    for (auto& [key, value] : all) value = cleanText(value);  // as it comes back from the file
    return all;
}

std::vector<std::string> childCommand(const RunTask& task, const std::string& folder,
                                      const SequenceInput& sequence, const std::string& config) {
    // Not the path of this program: it may be another one by now, had it been built anew
    std::vector<std::string> command{"/proc/self/exe", "--run-method", task.method.name,
                                     "--run-folder",   folder,         "--input",
                                     sequence.input,   "--config",     config};
    const auto add = [&](const std::string& option, const std::string& value) {
        command.insert(command.end(), {option, value});
    };
    if (sequence.skip > 0) add("--skip", std::to_string(sequence.skip));
    if (sequence.first > 0) add("--first", std::to_string(sequence.first));
    for (const auto& [option, value] : chosenOptions(sequence.choice)) add(option, value);
    return command;
}

}  // namespace

Runs::Runs(const CompareSettings& settings, std::vector<SequenceComparison>& sequences)
    : settings_(settings), sequences_(sequences), place_(sequences.size()) {
    const std::string program = programState();
    for (std::size_t s = 0; s < sequences.size(); ++s) {
        if (!sequences[s].failure.empty()) continue;
        place_[s].resize(settings.methods.size());
        const auto run_settings = runSettings(settings, settings.sequences[s], program);
        for (std::size_t m = 0; m < settings.methods.size(); ++m) plan(s, m, run_settings);
    }
}

MethodRun Runs::notRun(std::size_t s, std::size_t m, const std::string& reason) const {
    const MethodInfo& method = settings_.methods[m];
    MethodRun run;
    run.method = method.name;
    run.label = method.label;
    run.note = method.note;
    run.input = sequences_[s].input;
    run.skipped = reason;
    return run;
}

void Runs::plan(std::size_t s, std::size_t m, const std::map<std::string, std::string>& run_settings) {
    const MethodInfo& method = settings_.methods[m];
    if (!method.unavailable.empty()) {
        place_[s][m] = notRun(s, m, method.unavailable);
        return;
    }
    RunTask task{sequences_[s].name, sequences_[s].input, method, folder(s, m), run_settings};
    if (settings_.resume) {
        KeptRun kept = findKeptRun(task, settings_.queue.timeout_s);
        place_[s][m] = kept.run;  // to be made anew or not: it stands until there is another one
        if (kept.run) tell(task, kept);
        if (kept.run && kept.redo.empty()) {
            ++reused_;
            return;
        }
    }
    tasks_.push_back(std::move(task));
    where_.emplace_back(s, m);
}

void Runs::tell(const RunTask& task, const KeptRun& kept) const {
    const std::string& failure = kept.run->failure;
    if (settings_.quiet || (failure.empty() && kept.redo.empty())) return;
    const std::string what = !kept.redo.empty() ? "is made anew: " + kept.redo
                                                : "kept as it is, FAILED: " + failure + " (remove " +
                                                      task.folder + " to have it run again)";
    std::fprintf(stderr, "%s, %s: %s\n", task.sequence.c_str(), task.method.name.c_str(), what.c_str());
}

std::string Runs::folder(std::size_t s, std::size_t m) const {
    return (fs::path(settings_.output) / "runs" / sequences_[s].name / settings_.methods[m].name).string();
}

void Runs::make(const std::string& config) {
    const auto command = [&](const RunTask& task, const std::string& run_folder) {
        const std::size_t index = static_cast<std::size_t>(&task - tasks_.data());
        return childCommand(task, run_folder, settings_.sequences[where_[index].first], config);
    };
    runTasks(tasks_, command, settings_.queue, *this);
}

std::size_t Runs::count() const {
    std::size_t count = 0;
    for (const auto& runs : place_)
        for (const auto& run : runs) count += run && run->skipped.empty();
    return count;
}

std::size_t Runs::total() const {
    std::size_t total = 0;
    for (const auto& runs : place_)
        for (const auto& run : runs) total += !run || run->skipped.empty();
    return total;
}

void Runs::deliver() {
    for (std::size_t s = 0; s < sequences_.size(); ++s) {
        SequenceComparison& sequence = sequences_[s];
        std::size_t frames = 0;
        for (std::size_t m = 0; m < place_[s].size(); ++m) {
            sequence.runs.push_back(place_[s][m] ? *place_[s][m]
                                                 : notRun(s, m, "not run: the comparison was ended before"));
            sequence.run_folders.push_back(folder(s, m));
            if (sequence.runs.back().ok()) frames = std::max(frames, sequence.runs.back().frames);
        }
        // A rawlog does not tell its length before its end
        const SequenceInput& input = settings_.sequences[s];
        if (frames > 0 && frames < input.first) sequence.part = partOf(input, input.skip + frames);
    }
}

}  // namespace roevo
