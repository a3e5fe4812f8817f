#include "comparison_notes.h"

#include <algorithm>
#include <cstdio>

namespace roevo {

std::vector<std::string> comparisonNotes(const std::vector<SequenceComparison>& sequences) {
    std::size_t runs = 0, disturbed = 0, not_pinned = 0;
    double most_lost = 0;
    std::string why_not_pinned;  // the first one's
    for (const SequenceComparison& sequence : sequences)
        for (const MethodRun& run : sequence.runs) {
            runs += run.skipped.empty();
            disturbed += isDisturbed(run);
            most_lost = std::max(most_lost, run.core_lost);
            not_pinned += !run.not_pinned.empty();
            if (why_not_pinned.empty()) why_not_pinned = run.not_pinned;
        }
    std::vector<std::string> notes;
    if (disturbed > 0) {
        char text[320];
        std::snprintf(text, sizeof text,
                      "The machine was busy: in %zu of %zu runs other programs had the core for more than "
                      "%.0f %% of the time (up to %.0f %%), so that times per frame are too long there; "
                      "processor times hold.",
                      disturbed, runs, 100 * kDisturbedShare, 100 * most_lost);
        notes.push_back(text);
    }
    if (not_pinned > 0)
        notes.push_back("Not pinned: " + std::to_string(not_pinned) + " of " + std::to_string(runs) +
                        " runs could not be bound to one core (" + why_not_pinned +
                        "); where a method uses several threads its times may be of several cores.");
    return notes;
}

}  // namespace roevo
