// Share of the features of a reference frame that are rightly associated in later frames (the paper's Fig.
// "Cross-frame association result using different methods").
#include <algorithm>
#include <map>

#include "programs/gnuplot.h"
#include "programs/text.h"
#include "repeatability/bins.h"
#include "repeatability/judge.h"
#include "repeatability/measure.h"
#include "study.h"

namespace roevo {
namespace {

struct MethodLook {
    const char *key, *name, *label, *colour;  // colours as in the paper's figure
};
constexpr MethodLook kMethods[kNumAssociationMethods] = {
    {"lk", "optical flow", "Shi-Tomasi, LK optical flow", "#E69F00"},
    {"nearest", "nearest neighbour", "edges, nearest neighbour", "#D62728"},
    {"normals", "normals", "edges, frame to frame, normals", "#0072B2"},
    {"keyframe", "keyframe to frame", "edges, keyframe to frame, normals", "#56B4E9"},
    {"disjoint_set", "disjoint set", "edges, disjoint set", "#009E73"},
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
    std::vector<std::string> head{"recording",       "judged_by",       "reprojected_by",     "reference",
                                  "frame",           "frames",          "rotation_deg",       "translation_m",
                                  "disagreement_px", "visible_corners", "visible_edge_points"};
    append(head, columns("_share"));
    append(head, columns("_precision"));
    return CsvTable(head);
}

void addRows(CsvTable& table, const std::string& recording, const Repeatability& measured) {
    for (const RepeatabilityRow& row : measured.rows) {
        std::vector<std::string> fields{recording,
                                        measured.judged_by,
                                        measured.searched_by,
                                        std::to_string(row.reference),
                                        std::to_string(row.frame),
                                        std::to_string(row.frame - row.reference),
                                        CsvTable::number(row.rotation_deg),
                                        CsvTable::number(row.translation),
                                        CsvTable::number(row.disagreement, 4),
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

std::string inWords(const std::string& poses) {
    if (poses.rfind("roevo-", 0) != 0) return poses;
    return "final poses of ROEVO " + poses.substr(6);
}

// For the small space over a panel.
std::string posesInShort(const Repeatability& measured) {
    const auto shortly = [](const std::string& poses) {
        return poses.rfind("roevo-", 0) == 0 ? "ROEVO " + poses.substr(6) : poses;
    };
    return "judged by " + shortly(measured.judged_by) + ", reprojected by " + shortly(measured.searched_by);
}

std::string posesInWords(const Repeatability& measured) {
    return "judged by " + inWords(measured.judged_by) + "; edges reprojected at " +
           inWords(measured.searched_by);
}

// "ground truth (3), final poses of ROEVO ba (2)"
std::string countedPoses(const std::vector<Repeatability>& measured, std::string Repeatability::*poses) {
    std::map<std::string, std::size_t> counts;
    for (const Repeatability& one : measured) ++counts[inWords(one.*poses)];
    std::string text;
    for (auto entry = counts.rbegin(); entry != counts.rend(); ++entry)  // ground truth first
        text += (text.empty() ? "" : ", ") + entry->first +
                (counts.size() > 1 ? " (" + std::to_string(entry->second) + ")" : "");
    return text;
}

// One panel, a curve for each method.
std::string panel(const std::string& block, const std::vector<RepeatabilityRow>& rows,
                  const DistanceLook& look) {
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

struct Sheet {
    int columns = 1, lines = 1, width = 0, height = 0, key_rows = 1;  // panels; px

    // A panel's axes, px left of, below, right of and above them.
    static constexpr int kLeft = 80, kBelow = 60, kRight = 15, kAbove = 58, kKeyRow = 24;

    int keyHeight() const { return key_rows * kKeyRow + 16; }
    std::string head() const {
        return format(
            "set yrange [0:100]\nset ytics 20\nset ylabel offset 0.5\nset xlabel offset 0, 0.3\nset title "
            "offset 0, -0.6\nset "
            "multiplot\n"
            "set key at screen 0.5, %g center center maxrows %d Left reverse width -3\n",
            0.5 * keyHeight() / height, key_rows);
    }
    std::string place(std::size_t number) const {
        const int column = static_cast<int>(number) % columns, line = static_cast<int>(number) / columns;
        const double w = static_cast<double>(width) / columns,
                     h = static_cast<double>(height - keyHeight()) / lines;
        const double left = w * column, bottom = height - h * (line + 1);
        return format(
            "set lmargin at screen %g\nset rmargin at screen %g\nset bmargin at screen %g\nset tmargin at "
            "screen %g\n",
            (left + kLeft) / width, (left + w - kRight) / width, (bottom + kBelow) / height,
            (bottom + h - kAbove) / height);
    }
};

// All recordings pooled, over the three kinds of distance.
void drawPooled(StudyReport& report, const std::string& folder, const std::vector<RepeatabilityRow>& rows,
                const std::vector<Repeatability>& measured) {
    const Sheet sheet{3, 1, 1200, 480, 2};
    const std::string title = counted(measured.size(), "recording") + "; judged by " +
                              countedPoses(measured, &Repeatability::judged_by) + "; edges reprojected at " +
                              countedPoses(measured, &Repeatability::searched_by);
    std::string script = sheet.head() + "set label 1 " + gnuplotText(title) +
                         format(" at screen 0.5, %g center\n", 1 - 18.0 / sheet.height) +
                         "set ylabel 'rightly associated features (%)'\n";
    for (std::size_t i = 0; i < std::size(kDistances); ++i)
        script += sheet.place(i) + panel("pooled" + std::to_string(i), rows, kDistances[i]) +
                  "unset key\nunset ylabel\nunset label 1\n";
    addPlot(report, folder, "repeatability.svg", script + "unset multiplot", sheet.width, sheet.height);
}

// A panel for each recording.
void drawRecordings(StudyReport& report, const std::string& folder, const std::vector<std::string>& names,
                    const std::vector<Repeatability>& measured) {
    const int count = static_cast<int>(names.size());
    Sheet sheet;
    sheet.columns = count == 4 ? 2 : std::min(count, 3);
    sheet.lines = (count + sheet.columns - 1) / sheet.columns;
    sheet.width = std::max(600, 400 * sheet.columns);
    sheet.key_rows = sheet.columns == 3 ? 2 : sheet.columns == 2 ? 3 : 5;
    sheet.height = sheet.keyHeight() + 320 * sheet.lines;
    std::string script = sheet.head();
    for (std::size_t i = 0; i < names.size(); ++i)
        script +=
            sheet.place(i) + "set title " + gnuplotText(names[i]) + ".\"\\n\".'{/=11 '." +
            gnuplotText(posesInShort(measured[i])) + ".'}'\nset ylabel " +
            gnuplotText(i % static_cast<std::size_t>(sheet.columns) == 0 ? "rightly associated (%)" : "") +
            '\n' + panel("recording" + std::to_string(i), measured[i].rows, kDistances[0]) + "unset key\n";
    addPlot(report, folder, "repeatability_recordings.svg", script + "unset multiplot", sheet.width,
            sheet.height);
}

std::string percentages(const std::array<std::optional<double>, kNumAssociationMethods>& shares) {
    std::string text;
    for (std::size_t m = 0; m < kNumAssociationMethods; ++m)
        text += (m > 0 ? ", " : "") + std::string(kMethods[m].name) + ' ' +
                (shares[m] ? format("%.0f %%", 100 * *shares[m]) : "-");
    return text;
}

std::string noteOf(const std::string& name, const Repeatability& measured) {
    std::string note =
        name + ": " + posesInWords(measured) + "; " + counted(measured.references, "reference");
    if (measured.disagreement > kExactPoses)
        note += format(
            "; its poses and the odometry's put the same edge %.1f px apart (median): too much to reproject "
            "by them, and to judge well by them; compare with --no-ground-truth",
            measured.disagreement);
    if (measured.left_out > 0)
        note += "; " + counted(measured.left_out, "frame") + " left out (unreadable or without a pose)";
    return note;
}

}  // namespace

StudyReport studyRepeatability(const std::vector<StudyInput>& inputs, const std::string& folder) {
    const ReferencePlan plan;
    StudyReport report;
    CsvTable rows = rowsTable(), bins = binsTable();
    std::vector<Repeatability> measured;
    std::vector<std::string> names;
    std::vector<RepeatabilityRow> pooled;
    forEachInput(inputs, report, [&](const StudyInput& input) {
        measured.push_back(measureRepeatability(input, plan));
        const Repeatability& of_input = measured.back();
        names.push_back(input.name);
        addRows(rows, input.name, of_input);
        addBins(bins, input.name, of_input.rows);
        pooled.insert(pooled.end(), of_input.rows.begin(), of_input.rows.end());
        report.notes.push_back(noteOf(input.name, of_input));
    });
    addBins(bins, "all", pooled);
    addTable(report, folder, "repeatability.csv", rows);
    addTable(report, folder, "repeatability_binned.csv", bins);
    drawPooled(report, folder, pooled, measured);
    drawRecordings(report, folder, names, measured);

    const std::string notes[] = {
        format("Every %zu-th frame is a reference whose features are looked for in the %zu frames after it.",
               plan.every, plan.follow),
        format("Of features that are visible (inside the image, their surface shown by the depth) those "
               "count that are "
               "associated within %g px of their true place; edges count by their visible length. Precision: "
               "share of "
               "the associations that is right.",
               static_cast<double>(kTolerance)),
        "Nearest neighbour and frame to frame are chained: as with optical flow, what is lost in one frame "
        "stays lost. Keyframe to frame is what the tracker does.",
        format("Judged by: the poses that tell where a feature truly is. Reprojected at: the poses by which "
               "edges are put into the other frame to be associated, the same for all edge methods; optical "
               "flow needs none. That is the ground truth where it is exact (edges within %g px, median, of "
               "where the odometry puts them), else the final, refined poses of the odometry's own run over "
               "the same recording.",
               kExactPoses),
        "Pooled curves mix recordings that move differently; each has a panel of its own."};
    report.notes.insert(report.notes.begin(), std::begin(notes), std::end(notes));
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
