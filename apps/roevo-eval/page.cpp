#include "page.h"

#include "programs/text.h"
#include "roevo-compare/report/html_parts.h"
#include "roevo-compare/report/html_sections.h"
#include "roevo-compare/report/html_sequence.h"

namespace roevo {
namespace {

// The estimates as runs of methods, so that the report's figures are theirs, too.
SequenceComparison asComparison(const std::string& reference_file, const std::vector<StampedPose>& reference,
                                const std::vector<JudgedEstimate>& estimates) {
    SequenceComparison sequence;
    sequence.name = reference_file;
    sequence.reference = reference;
    for (const JudgedEstimate& estimate : estimates) {
        MethodRun run;
        run.method = std::to_string(sequence.runs.size());  // names may be there twice
        run.label = estimate.name;
        run.trajectory = estimate.trajectory;
        sequence.runs.push_back(std::move(run));
        sequence.errors.push_back({estimate.evaluation, {}, {}});
    }
    return sequence;
}

}  // namespace

std::string htmlPage(const std::string& reference_file, const std::vector<StampedPose>& reference,
                     const std::vector<JudgedEstimate>& estimates, const std::string& alignment,
                     double max_dt) {
    const SequenceComparison sequence = asComparison(reference_file, reference, estimates);
    const SequenceResults results{&sequence, evaluateRuns(sequence)};
    Legend legend{tableMethods({results}), {}};
    legend.styles = lineStyles(legend.methods);
    Table table = pageTable(estimates);
    table.protocol = "Poses with one of the reference within " + plainNumber(max_dt) + " s; ATE after " +
                     alignment + "; RPE over 1 s.";
    std::string html = pageHead("Errors of trajectories") + "<header>\n<h1>Errors of trajectories</h1>\n";
    html += "<p class=\"facts\">" + counted(estimates.size(), "estimate") + " · reference <code>" +
            breakable(reference_file) + "</code>, " + counted(reference.size(), "pose") + ", " +
            shownNumber(reference.back().timestamp - reference.front().timestamp, 1) + " s, path of " +
            shownNumber(pathLength(reference), 2) + " m</p>\n</header>\n<main>\n" +
            setTable(table, "errors", false);
    html += trajectoryBlock(results, legend, "Trajectories, " + alignment);
    html += errorBlocks(results, legend, alignment);
    return html + "</main>\n</body>\n</html>\n";
}

}  // namespace roevo
