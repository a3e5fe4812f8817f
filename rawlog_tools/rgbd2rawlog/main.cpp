// rgbd2rawlog: an RGB-D dataset folder or a bag as an MRPT rawlog, lossless unless told otherwise.
#include <CLI/CLI.hpp>
#include <filesystem>

#include "programs/program.h"
#include "recordings/input_choice.h"
#include "rgbd2rawlog/conversion.h"

namespace roevo {
namespace {

namespace fs = std::filesystem;

constexpr char kName[] = "rgbd2rawlog";

constexpr char kFooter[] =
    "T is either seconds after the first frame (--from 12.5) or, with @ before it, a time stamp of the\n"
    "dataset (--from @1305031453.36); both limits are inclusive.\n"
    "Ground truth goes to <stem>_groundtruth.txt beside the rawlog, time stamps of depth images that are "
    "not\n"
    "those of the colour images to <stem>_depth_times.txt, inertial samples into the rawlog.\n"
    "Example:\n"
    "  rgbd2rawlog --input rgbd_dataset_freiburg1_desk --output fr1_desk.rawlog --verify";

std::optional<int> parse(int argc, char** argv, ConversionSettings& settings) {
    std::string from, to;
    CLI::App app(
        "Turns an RGB-D dataset folder or a ROS bag into an MRPT rawlog: depth lossless inside, colour files "
        "beside it as they are (of bags: as PNG).",
        kName);
    app.add_option("--input", settings.input, "Dataset folder or ROS bag")->required();
    app.add_option("--output", settings.output, "Rawlog to write; images go to <stem>_Images beside it")
        ->required();
    app.add_option("--format", settings.dataset.format, "Dataset format")
        ->capture_default_str()
        ->check(CLI::IsMember(datasetFormats()));
    app.add_option("--max-dt", settings.dataset.max_time_difference,
                   "Largest time between a colour and its depth image, s")
        ->capture_default_str()
        ->check(CLI::Range(0.0, 10.0));
    app.add_option("--from", from, "Leave out what comes before this moment")->type_name("T");
    app.add_option("--to", to, "Leave out what comes after this moment")->type_name("T");
    app.add_option("--every", settings.convert.selection.every, "Take each N-th frame only")
        ->type_name("N")
        ->check(CLI::Range(1, 1000000));
    app.add_flag("--externalize-depth", settings.convert.externalize_depth,
                 "Depth in files of MRPT's binary format beside the rawlog instead of inside; lossless, too");
    app.add_option("--jpeg", settings.convert.jpeg_quality,
                   "Store colour as JPEG of this quality: smaller, but LOSSY")
        ->type_name("Q")
        ->check(CLI::Range(1, 100));
    app.add_flag("--verify", settings.verify,
                 "Read the rawlog back before it gets its name and compare every depth value, time stamp, "
                 "image, inertial sample and the intrinsics");
    app.add_option("--ground-truth", settings.dataset.ground_truth,
                   "Trajectory to go with the rawlog, TUM or EuRoC, in place of what lies beside the images")
        ->type_name("FILE");
    addTopicOptions(app, settings.dataset.topics);
    addFolderOptions(app, settings.dataset.folder);
    app.add_flag("--skip-bad", settings.convert.skip_bad,
                 "Leave out frames whose images cannot be used, instead of failing");
    app.footer(kFooter);
    if (auto code = parseCommandLine(app, argc, argv)) return code;
    if (fs::path(settings.output).extension() != ".rawlog")
        throw UsageError("--output must end in .rawlog: " + settings.output);
    if (!from.empty()) settings.convert.selection.from = parseTimeLimit(from, "--from");
    if (!to.empty()) settings.convert.selection.to = parseTimeLimit(to, "--to");
    return std::nullopt;
}

int run(int argc, char** argv) {
    ConversionSettings settings;
    if (auto code = parse(argc, argv, settings)) return *code;
    convertRecording(kName, settings);
    return 0;
}

}  // namespace
}  // namespace roevo

int main(int argc, char** argv) {
    return roevo::runProgram(roevo::kName, [&] { return roevo::run(argc, argv); });
}
