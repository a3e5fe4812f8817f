// Share of the features of a reference frame that are rightly associated in later frames (the paper's Fig.
// "Cross-frame association result using different methods").
#include <algorithm>
#include <limits>

#include "repeatability/bins.h"
#include "repeatability/judge.h"
#include "repeatability/measure.h"
#include "study.h"
#include "support/gnuplot.h"

namespace roevo {
namespace {

struct MethodLook {
    const char *key, *label, *colour;  // colours as in the paper's figure
};
constexpr MethodLook kMethods[kNumAssociationMethods] = {
    {"lk", "Shi-Tomasi + LK optical flow", "#E69F00"},
    {"nearest", "organized edges, nearest neighbour", "#D62728"},
    {"normals", "organized edges, frame to frame with normals", "#0072B2"},
    {"disjoint_set", "organized edges, disjoint set", "#009E73"},
};

struct DistanceLook {
    Distance distance;
    const char *key, *label;
    double scale;  // to the plot's unit
};
constexpr DistanceLook kDistances[] = {
    {Distance::kFrames, "frames", "frames after the reference", 1},
    {Distance::kRotation, "rotation_deg", "rotation from the reference (deg)", 1},
    {Distance::kTranslation, "translation_m", "distance from the reference (cm)", 100}};

// Where near and far begin in the summary, frames.
constexpr double kNear = 10;

std::vector<std::string> columns(const char* suffix) {
    std::vector<std::string> names;
    for (const MethodLook& method : kMethods) names.push_back(std::string(method.key) + suffix);
    return names;
}

void append(std::vector<std::string>& fields, const std::vector<std::string>& more) {
    fields.insert(fields.end(), more.begin(), more.end());
}

void append(std::vector<std::string>& fields,
            const std::array<std::optional<double>, kNumAssociationMethods>& values) {
    for (const auto& value : values) fields.push_back(CsvTable::number(value, 4));
}

CsvTable rowsTable() {
    std::vector<std::string> head{"recording",     "judged_by",       "reference",
                                  "frame",         "frames",          "rotation_deg",
                                  "translation_m", "visible_corners", "visible_edge_points"};
    append(head, columns("_share"));
    append(head, columns("_precision"));
    return CsvTable(head);
}

void addRows(CsvTable& table, const std::string& recording, const Repeatability& measured) {
    for (const RepeatabilityRow& row : measured.rows) {
        std::vector<std::string> fields{recording,
                                        measured.judged_by,
                                        std::to_string(row.reference),
                                        std::to_string(row.frame),
                                        std::to_string(row.frame - row.reference),
                                        CsvTable::number(row.rotation_deg),
                                        CsvTable::number(row.translation),
                                        std::to_string(row.visible_corners),
                                        std::to_string(row.visible_points)};
        append(fields, row.share);
        append(fields, row.precision);
        table.add(fields);
    }
}

CsvTable binsTable() {
    std::vector<std::string> head{"recording", "distance", "from", "to", "rows"};
    append(head, columns("_share"));
    return CsvTable(head);
}

void addBins(CsvTable& table, const std::string& recording, const std::vector<RepeatabilityRow>& rows) {
    for (const DistanceLook& look : kDistances)
        for (const DistanceBin& bin : binRows(rows, look.distance)) {
            std::vector<std::string> fields{recording, look.key, CsvTable::number(bin.from),
                                            CsvTable::number(bin.to), std::to_string(bin.rows)};
            append(fields, bin.share);
            table.add(fields);
        }
}

// One panel of four curves.
std::string panel(const std::string& block, const std::vector<RepeatabilityRow>& rows,
                  const DistanceLook& look) {
    constexpr double kMissing = std::numeric_limits<double>::quiet_NaN();
    std::vector<std::vector<double>> lines;
    double farthest = 0;
    for (const DistanceBin& bin : binRows(rows, look.distance)) {
        std::vector<double> line{bin.middle() * look.scale};
        for (const auto& share : bin.share) line.push_back(share ? 100 * *share : kMissing);
        lines.push_back(std::move(line));
        farthest = std::max(farthest, bin.to * look.scale);
    }
    std::string script = gnuplotData(block, lines) + "set xlabel " + gnuplotText(look.label) +
                         format("\nset xrange [0:%g]\nplot ", farthest);
    for (std::size_t m = 0; m < kNumAssociationMethods; ++m)
        script += format("%s$%s using 1:%zu with linespoints pt 7 ps 0.45 lw 2.2 lc rgb '%s' title ",
                         m > 0 ? ", " : "", block.c_str(), m + 2, kMethods[m].colour) +
                  gnuplotText(kMethods[m].label);
    return script + '\n';
}

constexpr char kAxes[] = "set yrange [0:100]\nset ytics 20\nset xtics autofreq\n";

// All recordings pooled, over the three kinds of distance.
void drawPooled(StudyReport& report, const std::string& folder, const std::vector<RepeatabilityRow>& rows) {
    std::string script = std::string(kAxes) +
                         "set multiplot\nset tmargin at screen 0.95\nset bmargin at screen 0.27\n"
                         "set ylabel 'rightly associated features (%)'\n"
                         "set key at screen 0.5, 0.11 center maxrows 2 Left reverse width 2\n";
    const double left[] = {0.06, 0.385, 0.71}, width = 0.275;
    for (std::size_t i = 0; i < std::size(kDistances); ++i) {
        script += format("set lmargin at screen %g\nset rmargin at screen %g\n", left[i], left[i] + width);
        if (i > 0) script += "unset key\nunset ylabel\n";
        script += panel("pooled" + std::to_string(i), rows, kDistances[i]);
    }
    addPlot(report, folder, "repeatability.svg", script + "unset multiplot", 1180, 460);
}

// A panel for each recording.
void drawRecordings(StudyReport& report, const std::string& folder, const std::vector<std::string>& names,
                    const std::vector<Repeatability>& measured) {
    const int columns = names.size() < 3 ? static_cast<int>(names.size()) : names.size() == 4 ? 2 : 3;
    const int lines = (static_cast<int>(names.size()) + columns - 1) / columns;
    const int key_height = 70, panel_height = 300, height = key_height + panel_height * lines;
    const int width = std::max(640, 400 * columns);
    const double floor = static_cast<double>(key_height) / height;
    const double w = 1.0 / columns, h = (1 - floor) / lines;
    std::string script = std::string(kAxes) + "set multiplot\n" +
                         format("set key at screen 0.5, %g center maxrows %d Left reverse width 2\n",
                                0.5 * floor, columns > 2 ? 2 : 2);
    for (std::size_t i = 0; i < names.size(); ++i) {
        const double left = w * static_cast<double>(static_cast<int>(i) % columns);
        const double bottom = 1 - h * static_cast<double>(static_cast<int>(i) / columns + 1);
        script += format(
            "set lmargin at screen %g\nset rmargin at screen %g\nset bmargin at screen %g\nset tmargin at "
            "screen %g\n",
            left + 70.0 / width, left + w - 20.0 / width, bottom + 55.0 / height, bottom + h - 40.0 / height);
        script += "set title " + gnuplotText(names[i]) + "\nset ylabel " +
                  gnuplotText(i % static_cast<std::size_t>(columns) == 0 ? "rightly associated (%)" : "") +
                  '\n';
        script += panel("recording" + std::to_string(i), measured[i].rows, kDistances[0]) + "unset key\n";
    }
    addPlot(report, folder, "repeatability_recordings.svg", script + "unset multiplot", width, height);
}

std::string percentages(const std::array<std::optional<double>, kNumAssociationMethods>& shares) {
    std::string text;
    for (std::size_t m = 0; m < kNumAssociationMethods; ++m)
        text += (m > 0 ? ", " : "") + std::string(kMethods[m].key) + ' ' +
                (shares[m] ? format("%.0f %%", 100 * *shares[m]) : "-");
    return text;
}

}  // namespace

StudyReport studyRepeatability(const std::vector<StudyInput>& inputs, const std::string& folder) {
    const ReferencePlan plan;
    StudyReport report;
    CsvTable rows = rowsTable(), bins = binsTable();
    std::vector<Repeatability> measured;
    std::vector<std::string> names;
    std::vector<RepeatabilityRow> pooled;
    for (const StudyInput& input : inputs) {
        measured.push_back(measureRepeatability(input, plan));
        const Repeatability& of_input = measured.back();
        names.push_back(input.name);
        addRows(rows, input.name, of_input);
        addBins(bins, input.name, of_input.rows);
        pooled.insert(pooled.end(), of_input.rows.begin(), of_input.rows.end());
        std::string note = format("%s: judged by %s; %zu references", input.name.c_str(),
                                  of_input.judged_by.c_str(), of_input.references);
        if (of_input.left_out > 0)
            note += format("; %zu frames left out (unreadable or without a pose)", of_input.left_out);
        report.notes.push_back(note);
    }
    addBins(bins, "all", pooled);
    addTable(report, folder, "repeatability.csv", rows);
    addTable(report, folder, "repeatability_binned.csv", bins);
    drawPooled(report, folder, pooled);
    drawRecordings(report, folder, names, measured);

    report.notes.insert(report.notes.begin(),
                        format("Every %zu-th frame is a reference whose features are looked for in the %zu "
                               "frames after it. Of features "
                               "that are visible (inside the image, their surface shown by the depth) it "
                               "counts those associated within "
                               "%g px of their true place; edges count by their visible length. Precision: "
                               "share of the associations "
                               "that is right.",
                               plan.every, plan.follow, static_cast<double>(kTolerance)));
    double farthest = 0;
    for (const RepeatabilityRow& row : pooled)
        farthest = std::max(farthest, distanceOf(row, Distance::kFrames));
    report.summary =
        format("rightly associated up to %g frames on: ", kNear) + percentages(meanShares(pooled, 1, kNear));
    if (farthest > 2 * kNear)
        report.summary += format("; from %.0f to %.0f: ", farthest / 2, farthest) +
                          percentages(meanShares(pooled, farthest / 2, farthest));
    return report;
}

}  // namespace roevo
