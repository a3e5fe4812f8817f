// roevo-eval: errors of a trajectory against a reference.
#include <CLI/CLI.hpp>
#include <cstdio>

#include "evaluation/evaluate.h"
#include "evaluation/to_json.h"
#include "evaluation/trajectory_io.h"
#include "programs/atomic_file.h"
#include "programs/program.h"

namespace roevo {
namespace {

constexpr char kName[] = "roevo-eval";

void printRow(const char* label, const ErrorStatistics& s, double scale) {
    if (s.count == 0) {
        std::printf("%-22s %10s   (the common time is too short)\n", label, "n/a");
        return;
    }
    std::printf("%-22s %10.4f %10.4f %10.4f %10.4f %10.4f\n", label, s.rmse * scale, s.mean * scale,
                s.median * scale, s.std * scale, s.max * scale);
}

void print(const Evaluation& e, std::size_t num_reference, std::size_t num_estimate, double max_dt) {
    std::printf(
        "%zu of %zu estimated poses have a reference (%zu poses) within %g s; SE(3) alignment, no scale\n\n",
        e.pairs.size(), num_estimate, num_reference, max_dt);
    std::printf("%-22s %10s %10s %10s %10s %10s\n", "", "rmse", "mean", "median", "std", "max");
    printRow("ATE [cm]", e.ate.translation, 100);
    printRow("RPE over 1 s [cm/s]", e.rpe_second.translation, 100);
    printRow("RPE over 1 s [deg/s]", e.rpe_second.rotation, 1);
    printRow("RPE per frame [cm]", e.rpe_frame.translation, 100);
    printRow("RPE per frame [deg]", e.rpe_frame.rotation, 1);
}

int run(int argc, char** argv) {
    std::string reference_file, estimate_file, json_file;
    double max_dt = kDefaultMaxDt, offset = 0;
    CLI::App app("Absolute (ATE) and relative (RPE) trajectory error of TUM trajectory files.", kName);
    app.add_option("--reference", reference_file, "Ground truth")->required();
    app.add_option("--estimate", estimate_file, "Trajectory to judge")->required();
    app.add_option("--max-dt", max_dt, "Largest difference of paired stamps, s")
        ->capture_default_str()
        ->check(CLI::Range(0.0, 1.0));
    app.add_option("--offset", offset, "Added to the estimate's stamps, s")->capture_default_str();
    app.add_option("--json", json_file, "Write all figures there too (m, deg)");
    app.footer("Example:\n  roevo-eval --reference groundtruth.txt --estimate out/trajectory.txt");
    if (auto code = parseCommandLine(app, argc, argv)) return *code;

    const auto reference = readTumTrajectory(reference_file);
    auto estimate = readTumTrajectory(estimate_file);
    for (StampedPose& pose : estimate) pose.timestamp += offset;
    const Evaluation evaluation = evaluate(reference, estimate, max_dt);
    print(evaluation, reference.size(), estimate.size(), max_dt);
    if (!json_file.empty()) {
        nlohmann::ordered_json json = {{"reference", reference_file},
                                       {"estimate", estimate_file},
                                       {"max_dt_s", max_dt},
                                       {"offset_s", offset}};
        json.update(toJson(evaluation));
        writeTextAtomically(json_file, json.dump(2) + "\n");
    }
    return 0;
}

}  // namespace
}  // namespace roevo

int main(int argc, char** argv) {
    return roevo::runProgram(roevo::kName, [&] { return roevo::run(argc, argv); });
}
