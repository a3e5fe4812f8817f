#include "roevo-compare/report/html_sequence.h"

#include <algorithm>
#include <filesystem>
#include <utility>

#include "programs/gnuplot.h"
#include "programs/text.h"
#include "roevo-compare/report/html_parts.h"
#include "roevo-compare/report/ranking.h"
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
        parts.push_back(std::to_string(frames) + " frames" +
                        (rejected > 0 ? ", " + std::to_string(rejected) + " of them unusable" : ""));
    if (!sequence.part.empty()) parts.push_back("only " + sequence.part + " of the recording");
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
    const ScenePicture picture = renderScene(scene, layer);
    if (!picture.fault.empty())
        return "<p class=\"remark\">" + htmlText(run.label + ", " + what + ": no picture: " + picture.fault) +
               "</p>\n";
    return "<figure><img src=\"data:image/png;base64," + base64(picture.png) + "\" alt=\"" +
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

std::string stageBlock(const SequenceResults& results, std::vector<std::string>& stages) {
    const Figure figure = stageFigure(results, stages);
    return block("Mean time per tracked frame by stage", figure.svg.empty() ? "" : stageLegend(figure),
                 setFigure(figure));
}

}  // namespace

std::string allFigures(const SequenceResults& results, const std::string& id, const std::string& folder) {
    Table table = sequenceTable(results);
    const auto& run_folders = results.sequence->run_folders;
    for (std::size_t i = 0; i < std::min(table.rows.size(), run_folders.size()); ++i)
        table.rows[i].link = relativeLink(run_folders[i], folder);
    return setTable(table, id, false);
}

std::string trajectoryBlock(const SequenceResults& results, const Legend& legend, const std::string& title) {
    std::string figures;
    bool any = false;
    for (const Figure& figure : trajectoryFigures(results, legend)) {
        figures += setFigure(figure);
        any = any || !figure.svg.empty();
    }
    return block(title, any ? lineLegend(results, legend, true) : "",
                 "<div class=\"pair\">\n" + figures + "</div>\n");
}

std::string errorBlocks(const SequenceResults& results, const Legend& legend, const std::string& alignment) {
    if (!isReferenced(results)) return {};
    const auto set = [&](const std::string& title, const Figure& figure) {
        return block(title, figure.svg.empty() ? "" : lineLegend(results, legend, false), setFigure(figure));
    };
    const std::string over_time = set("Position error over time, " + alignment, errorFigure(results, legend));
    return over_time + set("Cumulative position error", cumulativeErrorFigure(results, legend));
}

SequenceWriter::SequenceWriter(const Legend& legend, std::string folder, bool with_table)
    : legend_(legend), folder_(std::move(folder)), with_table_(with_table) {}

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
    if (with_table_) html += allFigures(results, id + "_figures", folder_);
    html += plots(results);
    html += setTable(stageTable(results), id + "_stages");
    return html + maps(results) + "</section>\n";
}

std::string SequenceWriter::plots(const SequenceResults& results) {
    if (!plot_fault_.empty()) return {};
    try {
        std::string html =
            trajectoryBlock(results, legend_,
                            isReferenced(results) ? "Trajectories, aligned with the ground truth"
                                                  : "Trajectories, each from its own first pose");
        html += errorBlocks(results, legend_, "after the alignment");
        return html + stageBlock(results, stages_);
    } catch (const NoGnuplot& e) {
        plot_fault_ = e.what();  // the others need not be tried
        return {};
    }
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
