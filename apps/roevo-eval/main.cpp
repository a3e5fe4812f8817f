// roevo-eval: errors of a trajectory against a reference.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <map>
#include <utility>

#include "evaluation/evaluate.h"
#include "evaluation/scale_check.h"
#include "evaluation/to_json.h"
#include "evaluation/trajectory_io.h"
#include "page.h"
#include "programs/atomic_file.h"
#include "programs/output_folder.h"
#include "programs/program.h"
#include "programs/text.h"
#include "tables.h"

namespace roevo {
namespace {

constexpr char kName[] = "roevo-eval";

void printRow(const char* label, const ErrorStatistics& s, double scale) {
    if (s.count == 0) {
        std::printf("%-22s %10s   (no two poses are that far apart, within 10 %%)\n", label, "n/a");
        return;
    }
    std::printf("%-22s %10.4f %10.4f %10.4f %10.4f %10.4f\n", label, s.rmse * scale, s.mean * scale,
                s.median * scale, s.std * scale, s.max * scale);
}

constexpr struct {
    const char *name, *text;
    Alignment alignment;
} kAlignments[] = {{"se3", "SE(3) alignment, no scale", Alignment::kSe3},
                   {"sim3", "Sim(3) alignment, with scale", Alignment::kSim3},
                   {"yaw", "alignment by a turn about z and a translation", Alignment::kYaw},
                   {"none", "no alignment", Alignment::kNone}};

struct Settings {
    std::string reference, alignment = "se3", json, table, plot, format, times;
    std::vector<std::string> estimates;
    double max_dt = kDefaultMaxDt, offset = 0;
};

const auto& alignmentOf(const Settings& settings) {
    return *std::find_if(std::begin(kAlignments), std::end(kAlignments),
                         [&](const auto& each) { return each.name == settings.alignment; });
}

void print(const JudgedEstimate& estimate, std::size_t num_reference, const Settings& settings) {
    const Evaluation& e = estimate.evaluation;
    std::printf("%zu of %s have a reference (%s) within %g s; %s", e.pairs.size(),
                counted(estimate.poses, "estimated pose").c_str(), counted(num_reference, "pose").c_str(),
                settings.max_dt, alignmentOf(settings).text);
    if (alignmentOf(settings).alignment == Alignment::kSim3) std::printf(" (%.6g)", e.scale);
    std::printf("\n\n");
    std::printf("%-22s %10s %10s %10s %10s %10s\n", "", "rmse", "mean", "median", "std", "max");
    printRow("ATE [cm]", e.ate.translation, 100);
    printRow("RPE over 1 s [cm/s]", e.rpe_second.translation, 100);
    printRow("RPE over 1 s [deg/s]", e.rpe_second.rotation, 1);
    printRow("RPE per frame [cm]", e.rpe_frame.translation, 100);
    printRow("RPE per frame [deg]", e.rpe_frame.rotation, 1);
}

JudgedEstimate judge(const std::vector<StampedPose>& reference, const std::string& argument,
                     const RowTimes& times, const Settings& settings) {
    const NamedFile named = splitNamedFile(argument);
    auto poses = readTrajectory(named.file, trajectoryFormat(settings.format), times);
    for (StampedPose& pose : poses) pose.timestamp += settings.offset;
    try {
        const Alignment alignment = alignmentOf(settings).alignment;
        const Evaluation e = evaluate(reference, poses, settings.max_dt, alignment);
        const std::string scaled = scaleContradiction(reference, poses, e.pairs);
        if (alignment != Alignment::kSim3 && !scaled.empty())
            printWarning(kName,
                         cleanText(named.file) + ": " + scaled + " --align sim3 judges the shape alone");
        for (StampedPose& pose : poses) pose.T_world_camera.translation() *= e.scale;
        return {named.name.empty() ? named.file : named.name, named.file, poses.size(), e, poses};
    } catch (const std::runtime_error& e) {
        throw std::runtime_error(named.file + ": " + e.what());
    }
}

nlohmann::ordered_json jsonOf(const JudgedEstimate& estimate) {
    nlohmann::ordered_json json = {{"name", cleanText(estimate.name)}, {"estimate", estimate.file}};
    json.update(toJson(estimate.evaluation));
    json["scale"] = estimate.evaluation.scale;
    return json;
}

// One estimate stands at the top, several are in a list.
void writeJson(const std::vector<JudgedEstimate>& estimates, const Settings& settings) {
    nlohmann::ordered_json json = {{"reference", settings.reference},
                                   {"alignment", settings.alignment},
                                   {"max_dt_s", settings.max_dt},
                                   {"offset_s", settings.offset}};
    if (estimates.size() == 1)
        json.update(jsonOf(estimates.front()));
    else
        for (const JudgedEstimate& estimate : estimates) json["estimates"].push_back(jsonOf(estimate));
    writeTextAtomically(settings.json,
                        json.dump(2, ' ', false, nlohmann::json::error_handler_t::replace) + "\n");
}

// Errors of a part and of the whole stand in one table.
void warnOfParts(const std::vector<JudgedEstimate>& estimates) {
    const auto poses = [](const JudgedEstimate& e) { return e.evaluation.pairs.size(); };
    const auto [fewest, most] = std::minmax_element(
        estimates.begin(), estimates.end(),
        [&](const JudgedEstimate& a, const JudgedEstimate& b) { return poses(a) < poses(b); });
    if (isComparable(*fewest, estimates)) return;
    printWarning(kName, cleanText(fewest->name) + " is judged by " + counted(poses(*fewest), "pose") + ", " +
                            cleanText(most->name) + " by " + std::to_string(poses(*most)) +
                            ": errors of a part do not compare with those of the whole");
}

int run(int argc, char** argv) {
    Settings settings;
    std::vector<std::string> alignments;
    for (const auto& each : kAlignments) alignments.emplace_back(each.name);
    CLI::App app("Absolute (ATE) and relative (RPE) error of trajectories: TUM, KITTI and EuRoC files.",
                 kName);
    app.add_option("--reference", settings.reference, "Ground truth")->required();
    app.add_option("--estimate", settings.estimates, "Trajectories to judge, [NAME=]FILE each")->required();
    app.add_option(
           "--align", settings.alignment,
           "How the ATE brings an estimate onto the reference: se3 (rotation, translation), sim3 (and "
           "scale), yaw (turn about the reference's z, translation), none")
        ->capture_default_str()
        ->check(CLI::IsMember(alignments));
    app.add_option(
           "--format", settings.format,
           "Of the estimates: tum, kitti or euroc (default: told by the first row, as the reference's is)")
        ->check(CLI::IsMember(trajectoryFormatNames()));
    app.add_option("--times", settings.times,
                   "File whose lines begin with the time of each row of a KITTI file, s (default: the "
                   "reference)");
    app.add_option("--max-dt", settings.max_dt, "Largest difference of paired stamps, s")
        ->capture_default_str()
        ->check(CLI::Range(0.0, 1.0));
    app.add_option("--offset", settings.offset, "Added to the estimates' stamps, s")->capture_default_str();
    app.add_option("--json", settings.json, "Write all figures there too (m, deg)");
    app.add_option("--table", settings.table,
                   "Write a table there too, one row per estimate: FILE.csv or FILE.tex");
    app.add_option(
        "--plot", settings.plot,
        "Write a page for a browser there too, FILE.html: the table, trajectories, errors over time, "
        "cumulative errors");
    app.footer(
        "Example:\n  roevo-eval --reference groundtruth.txt --estimate out/trajectory.txt\n"
        "  roevo-eval --reference groundtruth.txt --estimate ours=out/trajectory.txt theirs=other.txt "
        "--table errors.tex --plot errors.html");
    if (auto code = parseCommandLine(app, argc, argv)) return *code;
    const std::string kind = std::filesystem::path(settings.table).extension().string();
    if (!settings.table.empty() && kind != ".csv" && kind != ".tex")
        throw UsageError("--table: '" + settings.table + "' must end in .csv or .tex");
    if (!settings.plot.empty() && std::filesystem::path(settings.plot).extension() != ".html")
        throw UsageError("--plot: '" + settings.plot + "' must end in .html");
    std::vector<std::string> inputs{settings.reference, settings.times};
    for (const std::string& argument : settings.estimates) inputs.push_back(splitNamedFile(argument).file);
    keepInputs("--json", settings.json, inputs);
    keepInputs("--table", settings.table, inputs);
    keepInputs("--plot", settings.plot, inputs);
    for (const auto& [a, b] : {std::pair(settings.json, settings.table), {settings.json, settings.plot}})
        if (isSameFile(a, b)) throw UsageError("'" + a + "' is to be two outputs; give another name");
    if (!std::isfinite(settings.offset) || !std::isfinite(settings.max_dt))
        throw UsageError("--offset and --max-dt must be finite numbers");

    RowTimes times{{}, settings.reference};
    if (!settings.times.empty()) times = readRowTimes(settings.times);
    const auto reference = readTrajectory(settings.reference, {}, times);
    if (settings.times.empty()) times = readRowTimes(settings.reference);
    std::vector<JudgedEstimate> estimates;
    for (const std::string& argument : settings.estimates)
        estimates.push_back(judge(reference, argument, times, settings));
    std::map<std::string, int> count;
    for (const JudgedEstimate& estimate : estimates) ++count[estimate.name];
    for (JudgedEstimate& estimate : estimates)
        if (count[estimate.name] > 1) estimate.name = estimate.file;  // a name of several tells none of them
    std::string page;                                                 // before all else, since it may fail
    if (!settings.plot.empty())
        page =
            htmlPage(settings.reference, reference, estimates, alignmentOf(settings).text, settings.max_dt);
    if (estimates.size() == 1)
        print(estimates.front(), reference.size(), settings);
    else
        std::printf("reference has %zu poses; pairs within %g s; %s\n\n%s", reference.size(), settings.max_dt,
                    alignmentOf(settings).text, terminalTable(estimates).c_str());
    warnOfParts(estimates);
    if (!settings.json.empty()) writeJson(estimates, settings);
    if (!settings.table.empty())
        writeTextAtomically(settings.table,
                            kind == ".csv" ? csvTable(estimates, settings.alignment) : latexTable(estimates));
    if (!page.empty()) writeTextAtomically(settings.plot, page);
    return 0;
}

}  // namespace
}  // namespace roevo

int main(int argc, char** argv) {
    return roevo::runProgram(roevo::kName, [&] { return roevo::run(argc, argv); });
}
