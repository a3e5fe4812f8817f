// Whether the camera is found again after a gap in the recording, and what the gap costs.
#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "known_view.h"
#include "programs/progress.h"
#include "programs/text.h"
#include "study.h"
#include "study_source.h"

namespace roevo {
namespace {

constexpr std::size_t kPlaces = 10;      // of each length, spread evenly
constexpr std::size_t kFewestEnds = 10;  // frames that are left before and after
constexpr double kKnown = 0.5;           // share of a view that was seen before the gap
constexpr std::size_t kSoon = 5;         // frames until the camera is found

struct Gap {
    std::size_t first = 0, frames = 0;

    bool contains(std::size_t frame) const { return frame >= first && frame < first + frames; }
};

struct GapRun {
    Gap gap;
    double known = 0;                         // share of the first view after it
    std::optional<std::size_t> found_after;   // frames; none: the track ended there
    std::optional<std::size_t> joined_after;  // frames; where a track of its own was begun, and joined
    std::optional<double> ate, uncut;         // m, over the frames outside the gap
    std::string fault;

    bool isKnown() const { return known >= kKnown; }
    bool isFoundSoon() const { return found_after && *found_after <= kSoon; }
    std::optional<double> ratio() const {
        return ate && uncut && *uncut > 0 ? std::make_optional(*ate / *uncut) : std::nullopt;
    }
};

/// Evenly over the recording; none where it is too short.
std::vector<Gap> gapsOf(std::size_t length, std::size_t frames) {
    std::vector<Gap> gaps;
    if (length + 2 * kFewestEnds > frames) return gaps;
    const std::size_t last = frames - length - kFewestEnds;
    for (std::size_t k = 0; k < kPlaces; ++k) {
        const std::size_t first = kFewestEnds + k * (last - kFewestEnds) / (kPlaces - 1);
        if (gaps.empty() || first > gaps.back().first) gaps.push_back({first, length});
    }
    return gaps;
}

std::optional<double> ateOutside(const Gap& gap, const std::vector<double>& times,
                                 const std::vector<StampedPose>& poses, const StudyInput& input,
                                 std::string& fault) {
    std::vector<StampedPose> outside;
    for (const StampedPose& pose : poses)
        if (pose.timestamp < times[gap.first] || pose.timestamp > times[gap.first + gap.frames - 1])
            outside.push_back(pose);
    try {
        return evaluate(input.ground_truth, outside).ate.translation.rmse;
    } catch (const std::exception& e) {
        fault = e.what();
        return std::nullopt;
    }
}

GapRun measure(const StudyInput& input, const OdometryOptions& options, const Gap& gap,
               const std::vector<double>& times, const std::vector<StampedPose>& uncut) {
    GapRun result;
    result.gap = gap;
    StudyInput cut = input;
    cut.open = [&input, gap] { return withoutFrames(input.open(), gap.first, gap.frames); };
    bool ended = false;  // the track of before
    std::size_t after = 0;
    const StudyRun run = trackRecording(cut, options, [&](const FrameResult& frame, const Odometry&) {
        if (frame.timestamp <= times[gap.first]) return;
        ++after;
        if (frame.joined_at >= 0 && ended && !result.joined_after) result.joined_after = after;
        if (ended || result.found_after) return;
        if (frame.status == FrameStatus::kOk) result.found_after = after;
        ended = frame.status == FrameStatus::kInitialised;
    });
    result.ate = ateOutside(gap, times, run.trajectory, input, result.fault);
    result.uncut = ateOutside(gap, times, uncut, input, result.fault);
    return result;
}

std::string shareOf(std::size_t part, std::size_t whole) {
    return whole == 0 ? "-" : std::to_string(part) + " of " + std::to_string(whole);
}

std::vector<std::string> shownLine(const std::string& recording, const std::vector<GapRun>& runs) {
    std::size_t known = 0, soon = 0, apart = 0, alike = 0;
    std::vector<double> ratios;
    for (const GapRun& run : runs) {
        if (!run.isKnown()) continue;
        ++known;
        soon += run.isFoundSoon();
        apart += !run.found_after && !run.joined_after;
        if (!run.ratio()) continue;
        ratios.push_back(*run.ratio());
        alike += *run.ratio() <= 1.3;
    }
    const auto middle = median(ratios);
    return {recording,
            std::to_string(runs.front().gap.frames),
            std::to_string(runs.size()),
            std::to_string(known),
            shareOf(soon, known),
            middle ? format("%.2f", *middle) : "-",
            middle ? format("%.2f", *std::max_element(ratios.begin(), ratios.end())) : "-",
            shareOf(alike, known),
            std::to_string(apart)};
}

std::string numberOr(const std::optional<std::size_t>& value) {
    return value ? std::to_string(*value) : "";
}

}  // namespace

StudyReport studyGaps(const std::vector<StudyInput>& inputs, const std::string& folder) {
    StudyReport report;
    CsvTable table({"recording", "mode", "frames_cut_out", "first_cut_out", "known_share", "found_after",
                    "joined_after", "ate_m", "ate_uncut_m", "ratio", "note"});
    std::vector<std::vector<std::string>> shown{
        {"recording", "frames cut out", "cases", "where half of the view is known",
         "of these found within 5 frames", "ATE over the uncut run's: median", "worst", "at most 1.3",
         "in two pieces"}};
    Progress progress("gaps", 0);
    std::size_t done = 0, known = 0, soon = 0;
    forEachInput(inputs, report, [&](const StudyInput& input) {
        if (input.ground_truth.empty()) throw std::runtime_error(input.ground_truth_note);
        OdometryOptions options = input.options;
        options.mapping.semi_dense_points = 0;  // costs time and moves no pose
        const KnownViews views(input);
        std::vector<double> times = views.times();
        const StudyRun uncut = trackRecording(input, options);
        std::vector<std::string> too_short;
        for (const std::size_t length : input.gaps) {
            std::vector<GapRun> runs;
            for (const Gap& gap : gapsOf(length, times.size())) {
                runs.push_back(measure(input, options, gap, times, uncut.trajectory));
                runs.back().known = views.knownShare(gap.first + gap.frames, gap.first);
                progress.update(++done);
            }
            if (runs.empty()) {
                too_short.push_back(input.name + ": too short for gaps of " + counted(length, "frame"));
                continue;
            }
            for (const GapRun& run : runs) {
                table.add({input.name, toString(options.mode), std::to_string(run.gap.frames),
                           std::to_string(run.gap.first), CsvTable::number(run.known, 3),
                           numberOr(run.found_after), numberOr(run.joined_after), CsvTable::number(run.ate),
                           CsvTable::number(run.uncut), CsvTable::number(run.ratio(), 4), run.fault});
                known += run.isKnown();
                soon += run.isKnown() && run.isFoundSoon();
            }
            shown.push_back(shownLine(input.name, runs));
        }
        if (too_short.size() == input.gaps.size()) throw std::runtime_error("too short for any of the gaps");
        report.notes.insert(report.notes.end(), too_short.begin(), too_short.end());
    });
    progress.finish();
    addTable(report, folder, "gaps.csv", table);
    report.summary = counted(done, "gap") + "; where half of the view after it was seen before it, the " +
                     "camera is found within 5 frames in " + shareOf(soon, known);
    report.table = markdownTable(shown);
    report.notes.push_back(
        "Known: of the first depth image after the gap, what the frames before it have seen, by the ground "
        "truth. Errors are of the frames outside the gap, final poses.");
    return report;
}

}  // namespace roevo
