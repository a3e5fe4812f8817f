#include "roevo-compare/report/html_sequence.h"

#include <algorithm>
#include <filesystem>
#include <optional>
#include <stdexcept>
#include <utility>

#include "evaluation/evaluate.h"
#include "programs/gnuplot.h"
#include "programs/text.h"
#include "roevo-compare/report/html_parts.h"
#include "roevo-compare/report/ranking.h"
#include "roevo-compare/report/remarks.h"
#include "roevo-compare/report/scene_picture.h"

namespace roevo {
namespace {

// Input, frames, duration and path, as far as they are known.
std::string facts(const SequenceComparison& sequence) {
    std::vector<std::string> parts;
    std::size_t frames = 0, rejected = 0;
    for (const MethodRun& run : sequence.runs) {
        frames = std::max(frames, run.frames);
        rejected = std::max(rejected, run.rejected);
    }
    if (frames > 0)
        parts.push_back(counted(frames, "frame") +
                        (rejected > 0 ? ", " + std::to_string(rejected) + " of them unusable" : ""));
    if (const std::string part = commonPart(sequence); !part.empty())
        parts.push_back("only " + part + " of the recording");
    double duration = 0;
    for (const MethodRun& run : sequence.runs)
        if (!run.trajectory.empty())
            duration = std::max(duration, run.trajectory.back().timestamp - run.trajectory.front().timestamp);
    if (duration > 0) parts.push_back(shownNumber(duration, 1) + " s");
    std::string html;
    for (const std::string& part : parts) html += (html.empty() ? "" : " · ") + htmlText(part);
    if (!sequence.input.empty())
        html +=
            std::string(html.empty() ? "" : " · ") + "input <code>" + breakable(sequence.input) + "</code>";
    if (!sequence.ground_truth.empty())
        html += " · ground truth <code>" + breakable(sequence.ground_truth) + "</code>";
    return "<p class=\"facts\">" + html + "</p>\n";
}

std::string mapFigure(const MethodRun& run, const std::string& scene, const std::string& layer,
                      const std::string& what) {
    const Rendered picture = renderScene(scene, layer);
    if (!picture.fault.empty())
        return "<p class=\"remark\">" + htmlText(run.label + ", " + what + ": no picture: " + picture.fault) +
               "</p>\n";
    return "<figure><img src=\"data:image/png;base64," + base64(picture.bytes) + "\" alt=\"" +
           htmlText(run.label + ": " + what) + "\"/><figcaption>" + htmlText(run.label + ": " + what) +
           "</figcaption></figure>\n";
}

bool isReferenced(const SequenceResults& results) {
    return std::any_of(results.evaluated.begin(), results.evaluated.end(),
                       [](const EvaluatedRun& run) { return run.evaluation.has_value(); });
}

std::string block(const std::string& title, const std::string& legend, const std::string& figures) {
    return "<div class=\"block\"><h3>" + title + "</h3>\n" + legend + figures + "</div>\n";
}

std::string stageBlock(const SequenceResults& results, std::vector<std::string>& stages, PageFiles& files) {
    const Figure figure = stageFigure(results, stages);
    return block("Mean time per tracked frame by stage", figure.svg.empty() ? "" : stageLegend(figure),
                 setFigure(figure, &files));
}

// The run whose map a 3-D view shows: of the fullest of ROEVO's modes, or the first with poses. None without
// any.
std::optional<std::size_t> viewedRun(const SequenceResults& results) {
    const SequenceComparison& sequence = *results.sequence;
    std::optional<std::size_t> best;
    for (std::size_t i = 0; i < std::min(sequence.runs.size(), sequence.run_folders.size()); ++i) {
        const std::string& folder = sequence.run_folders[i];
        std::error_code ignored;
        if (!sequence.runs[i].ok() || (isReferenced(results) && !results.evaluated[i].evaluation) ||
            !std::filesystem::exists(std::filesystem::path(folder) / "trajectory.txt", ignored))
            continue;
        if (!best || fullnessOf(sequence.runs[i].method) > fullnessOf(sequence.runs[*best].method)) best = i;
    }
    return best;
}

// Those beside the viewed one that can be aligned as it is.
bool canBeViewed(const SequenceResults& results, std::size_t run, std::size_t viewed) {
    const MethodRun& shown = results.sequence->runs[run];
    if (run == viewed || !shown.ok() || shown.trajectory.empty()) return false;
    if (isReferenced(results)) return results.evaluated[run].evaluation.has_value();
    try {
        evaluate(results.sequence->runs[viewed].trajectory, shown.trajectory);
        return true;
    } catch (const std::runtime_error&) {
        return false;
    }
}

}  // namespace

std::string allFigures(const SequenceResults& results, const std::string& id, const std::string& folder) {
    Table table = sequenceTable(results);
    const auto& run_folders = results.sequence->run_folders;
    for (std::size_t i = 0; i < std::min(table.rows.size(), run_folders.size()); ++i)
        table.rows[i].link = relativeLink(run_folders[i], folder);
    return setTable(table, id, false);
}

std::string trajectoryBlock(const SequenceResults& results, const Legend& legend, const std::string& title,
                            PageFiles* files) {
    std::string figures;
    bool any = false;
    for (const Figure& figure : trajectoryFigures(results, legend)) {
        figures += setFigure(figure, files);
        any = any || !figure.svg.empty();
    }
    return block(title, any ? lineLegend(results, legend, true) : "",
                 "<div class=\"pair\">\n" + figures + "</div>\n");
}

std::string errorBlocks(const SequenceResults& results, const Legend& legend, const std::string& alignment,
                        PageFiles* files) {
    if (!isReferenced(results)) return {};
    const auto set = [&](const std::string& title, const Figure& figure) {
        return block(title, figure.svg.empty() ? "" : lineLegend(results, legend, false),
                     setFigure(figure, files));
    };
    std::string html = set("Position error over time, " + alignment, errorFigure(results, legend));
    html += set("Position error along the axes, " + alignment, axisErrorFigure(results, legend));
    html += set("Angular error over time, " + alignment, angularErrorFigure(results, legend));
    html += set("Cumulative position error", cumulativeErrorFigure(results, legend));
    std::string drift;
    for (const Figure& figure : relativeErrorFigures(results, legend)) drift += setFigure(figure, files);
    if (drift.empty()) return html;
    return html +
           block("Relative error over path length", lineLegend(results, legend, false),
                 "<div class=\"pair\">\n" + drift +
                     "</div>\n<p class=\"protocol\">Mean over all pieces of the path of such a length, as "
                     "KITTI’s benchmark has it; lengths of which there are fewer than 10 pieces are left "
                     "out.</p>\n");
}

SequenceWriter::SequenceWriter(const Legend& legend, std::string folder, bool with_table, PageFiles& files)
    : legend_(legend), folder_(std::move(folder)), with_table_(with_table), files_(files) {}

std::string SequenceWriter::write(const SequenceResults& results, std::size_t number) {
    const SequenceComparison& sequence = *results.sequence;
    const std::string id = "sequence" + std::to_string(number);
    std::string html = "<section class=\"sequence\" id=\"" + id + "\">\n<h2>" + breakable(sequence.name) +
                       "</h2>\n" + facts(sequence);
    if (!sequence.notes.empty()) {
        html += "<ul class=\"lines facts\">\n";
        for (const std::string& note : sequence.notes) html += element("li", note) + "\n";
        html += "</ul>\n";
    }
    if (sequence.runs.empty())
        return html +
               "<p>Nothing could be run on it; the reason is at the top of this page.</p>\n</section>\n";
    html += view(results);
    if (with_table_) html += allFigures(results, id + "_figures", folder_);
    html += plots(results);
    if (const Table stages = stageTable(results); !stages.rows.empty())
        html += setTable(stages, id + "_stages");
    return html + maps(results) + "</section>\n";
}

std::string SequenceWriter::plots(const SequenceResults& results) {
    if (!plot_fault_.empty()) return {};
    try {
        std::string html =
            trajectoryBlock(results, legend_,
                            isReferenced(results) ? "Trajectories, aligned with the ground truth"
                                                  : "Trajectories, each from its own first pose",
                            &files_);
        html += errorBlocks(results, legend_, "after the alignment", &files_);
        return html + stageBlock(results, stages_, files_);
    } catch (const NoGnuplot& e) {
        plot_fault_ = e.what();  // the others need not be tried
        return {};
    }
}

std::string SequenceWriter::view(const SequenceResults& results) {
    const auto viewed = viewedRun(results);
    if (!viewed) return {};
    const SequenceComparison& sequence = *results.sequence;
    NamedTrajectories others;
    for (std::size_t i = 0; i < sequence.runs.size(); ++i)
        if (canBeViewed(results, i, *viewed))
            others.emplace_back(labelOf(sequence.runs[i]), sequence.runs[i].trajectory);
    const MethodRun& run = sequence.runs[*viewed];
    const Rendered page = renderView({sequence.run_folders[*viewed], sequence.name, labelOf(run)}, others,
                                     isReferenced(results) ? sequence.reference : std::vector<StampedPose>());
    if (!page.fault.empty())
        return "<p class=\"remark\">" + htmlText("No 3-D view: " + page.fault) + "</p>\n";
    return "<p class=\"view\"><a href=\"" + files_.add("views", sequence.name, ".html", page.bytes) +
           "\">3-D view</a> " +
           htmlText((run.scene.empty() ? "of the trajectories"
                                       : "of the map of " + labelOf(run) + " and the trajectories") +
                    std::string(isReferenced(results) ? ", with their errors" : "")) +
           "</p>\n";
}

std::string SequenceWriter::maps(const SequenceResults& results) const {
    const SequenceComparison& sequence = *results.sequence;
    const auto fullest = oneRoevo(legend_.methods);
    std::string html;
    for (std::size_t i = 0; i < sequence.runs.size(); ++i) {
        const MethodRun& run = sequence.runs[i];
        if (!run.ok() || run.scene.empty() || i >= sequence.run_folders.size()) continue;
        const std::string scene = (std::filesystem::path(sequence.run_folders[i]) / run.scene).string();
        html += mapFigure(run, scene, "edges", "edges of the map");
        const bool is_fullest = std::any_of(fullest.begin(), fullest.end(),
                                            [&](const TableMethod& m) { return m.name == run.method; });
        if (is_fullest) html += mapFigure(run, scene, "semi-dense", "surface beside the edges");
    }
    return html.empty() ? html : "<h3>Maps</h3>\n<div class=\"maps\">\n" + html + "</div>\n";
}

}  // namespace roevo
