#include "comparison_notes.h"

#include <algorithm>
#include <cstdio>

namespace roevo {
namespace {

struct Conditions {
    std::size_t jobs = 1, disturbed = 0, not_pinned = 0;
    double most_lost = 0;
    std::string why_not_pinned;  // the first one's
};

Conditions conditionsOf(const std::vector<SequenceComparison>& sequences) {
    Conditions all;
    for (const SequenceComparison& sequence : sequences)
        for (const MethodRun& run : sequence.runs) {
            all.jobs = std::max(all.jobs, run.jobs);
            all.disturbed += isDisturbed(run);
            all.most_lost = std::max(all.most_lost, run.core_lost);
            all.not_pinned += !run.not_pinned.empty();
            if (all.why_not_pinned.empty()) all.why_not_pinned = run.not_pinned;
        }
    return all;
}

std::string missingSentence(const std::vector<std::string>& missing) {
    std::string line = std::to_string(missing.size()) +
                       (missing.size() == 1 ? " sequence of the list is" : " sequences of the list are") +
                       " not on this disk and skipped: ";
    for (const std::string& one : missing)
        line += one.substr(0, one.find(':')) + (&one == &missing.back() ? "." : ", ");
    return line;
}

}  // namespace

std::vector<std::string> comparisonNotes(const CompareSettings& settings, const CompareResult& result) {
    std::vector<std::string> notes;
    const Conditions conditions = conditionsOf(result.sequences);
    if (conditions.disturbed > 0) {
        char text[320];
        std::snprintf(text, sizeof text,
                      "The machine was busy: in %zu of %zu runs other programs had the core for more than "
                      "%.0f %% of the time (up to %.0f %%), so that times per frame are too long there; "
                      "processor times hold. With --resume these runs are made anew.",
                      conditions.disturbed, result.runs, 100 * kDisturbedShare, 100 * conditions.most_lost);
        notes.push_back(text);
    }
    if (conditions.not_pinned > 0)
        notes.push_back("Not pinned: " + std::to_string(conditions.not_pinned) + " of " +
                        std::to_string(result.runs) + " runs could not be bound to one core (" +
                        conditions.why_not_pinned +
                        "); where a method uses several threads its times may be of several cores.");
    if (conditions.jobs > 1)
        notes.push_back(
            "Up to " + std::to_string(conditions.jobs) +
            " runs went on side by side, each on a core of its own: they share memory and caches, "
            "so that times are noisier, and longer, than those of runs one after the other.");
    if (!settings.missing.empty()) notes.push_back(missingSentence(settings.missing));
    if (result.interrupted)
        notes.push_back("The comparison was interrupted: " + std::to_string(result.left) +
                        (result.left == 1 ? " run is" : " runs are") + " still to be made.");
    return notes;
}

}  // namespace roevo
