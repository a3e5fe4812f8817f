#include "efficiency_registration.h"

#include "bar_chart.h"
#include "registration_steps.h"

namespace roevo {
namespace {

struct Kind {
    const char *method, *setting, *label;
    Operation time;
    RegistrationWork FrameWork::*work;
};
constexpr Kind kKinds[] = {
    {"ROEVO", "as configured", "ROEVO, as configured", kRegistration, &FrameWork::ours},
    {"distance field", "as configured", "distance field, as configured", kRegistrationField,
     &FrameWork::field},
    {"ROEVO", "alike", "ROEVO, alike", kAlike, &FrameWork::alike},
    {"distance field", "alike", "distance field, alike", kAlikeField, &FrameWork::alike}};
constexpr std::size_t kKindCount = std::size(kKinds);

/// What one kind of registration costs over the frames of a recording.
struct Cost {
    std::size_t frames = 0;
    std::optional<double> ms, points, steps;  // medians
    std::optional<double> ns;                 // of one point in one step, over all frames
};

Cost costOf(const Measured& measured, const Kind& kind) {
    std::vector<double> ms, points, steps;
    double sum_ms = 0, sum_work = 0;
    for (std::size_t i = 0; i < measured.frames.size(); ++i) {
        const RegistrationWork& work = measured.work[i].*kind.work;
        if (work.points == 0) continue;
        ms.push_back(measured.frames[i][kind.time]);
        points.push_back(static_cast<double>(work.points));
        steps.push_back(work.steps);
        sum_ms += ms.back();
        sum_work += points.back() * steps.back();
    }
    Cost cost{ms.size(), median(ms), median(points), median(steps), {}};
    if (sum_work > 0) cost.ns = 1e6 * sum_ms / sum_work;
    return cost;
}

void addCosts(CsvTable& table, const Measured& measured) {
    for (const Kind& kind : kKinds) {
        const Cost cost = costOf(measured, kind);
        table.add({measured.name, kind.method, kind.setting, CsvTable::number(cost.ms, 4),
                   CsvTable::number(cost.points, 5), CsvTable::number(cost.steps, 3),
                   CsvTable::number(cost.ns, 4), std::to_string(cost.frames)});
    }
}

/// Time of a registration, and of a point in a step.
void drawCosts(StudyReport& report, const std::string& folder, const std::vector<Measured>& all) {
    constexpr int kColours[] = {1, 2, 6, 5};  // dark and light of each
    BarChart chart;
    chart.title =
        "Registration of a frame, processor time; alike: same points, start and steps, edge residuals alone";
    chart.panels = {{"median (ms)", {}}, {"per point and step (ns)", {}}};
    for (std::size_t k = 0; k < kKindCount; ++k) chart.series.push_back({kKinds[k].label, kColours[k]});
    for (const Measured& measured : all) {
        chart.groups.push_back(measured.name);
        for (BarChart::Panel& panel : chart.panels) panel.bars.emplace_back();
        for (const Kind& kind : kKinds) {
            const Cost cost = costOf(measured, kind);
            chart.panels[0].bars.back().push_back(cost.ms.value_or(kMissing));
            chart.panels[1].bars.back().push_back(cost.ns.value_or(kMissing));
        }
    }
    addBarChart(report, folder, "efficiency_registration.svg", chart);
}

void addNotes(StudyReport& report, const FineOptions& options) {
    report.notes.push_back(format(
        "Registration, ROEVO as configured: at most %d steps, at most %d points of the keyframe. Each step "
        "reprojects them, associates them anew (nearest edge point within a radius and with the normal of "
        "the "
        "edge, then a vote of each edge's points) and joins point-to-tangent residuals with photometric ones "
        "(weight %g) and those of depth (weight %g); at the end edges are associated once more to judge the "
        "result.",
        options.max_iterations, options.max_points, options.photometric_weight, options.depth_weight));
    report.notes.push_back(
        "Registration, distance field as configured: the same limits on steps and points. Each step "
        "reprojects "
        "the points and looks up the field and its slope: nothing is associated, no photometric residual, "
        "none "
        "of depth, nothing judged at the end. Building the field is not in it, see there; the two differ "
        "in keyframes and starts, too, since each is an odometry of its own.");
    report.notes.push_back(format(
        "Alike: both on the same keyframe, frame, points and start, %d steps each, edge residuals alone; "
        "ROEVO's still associates in every step and once at the end. This is the comparison of the two ways "
        "to register; the other is of two odometries. Points: those looked up in a step. Per point and step: "
        "total time / total of points x steps.",
        kFixedSteps));
}

}  // namespace

std::string reportRegistrations(StudyReport& report, const std::string& folder,
                                const std::vector<Measured>& all, const Measured& together,
                                const FineOptions& options) {
    CsvTable table({"recording", "registration", "setting", "median_ms", "points_median", "steps_median",
                    "ns_per_point_and_step", "frames"});
    for (const Measured& measured : all) addCosts(table, measured);
    if (all.size() > 1) addCosts(table, together);
    addTable(report, folder, "efficiency_registration.csv", table);
    drawCosts(report, folder, all);
    addNotes(report, options);
    const Cost ours = costOf(together, kKinds[2]), field = costOf(together, kKinds[3]);
    if (!ours.ms || !ours.ns || !field.ns) return "no frame on which both registrations converged alike";
    return format(
        "alike (same points and start, %d steps) %.2f and %.2f ms, %.0f and %.0f ns per point and step",
        kFixedSteps, *ours.ms, *field.ms, *ours.ns, *field.ns);
}

}  // namespace roevo
