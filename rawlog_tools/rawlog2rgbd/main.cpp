// rawlog2rgbd: an MRPT rawlog as a dataset folder in TUM RGB-D layout.
#include <CLI/CLI.hpp>
#include <cstdio>

#include "programs/memory_peak.h"
#include "programs/program.h"
#include "programs/text.h"
#include "rawlog2rgbd/export.h"

namespace roevo {
namespace {

constexpr char kName[] = "rawlog2rgbd";
constexpr std::size_t kFaultsShown = 10;

void print(const ExportResult& result, const std::string& output) {
    for (std::size_t i = 0; i < result.left_out.size() && i < kFaultsShown; i++)
        std::printf("left out: %s\n", result.left_out[i].c_str());
    if (result.left_out.size() > kFaultsShown)
        std::printf("left out: %zu more\n", result.left_out.size() - kFaultsShown);
    std::printf("%s: %s written, %zu left out, depth_scale %.9g\n", output.c_str(),
                counted(result.frames, "frame").c_str(), result.left_out.size(), result.depth_scale);
    std::printf("colour: %s as %s, %zu written as PNG\n", counted(result.linked_images, "file").c_str(),
                result.linked_images == 1 ? "it is" : "they are", result.frames - result.linked_images);
    if (result.resampled > 0)
        std::printf("depth: %s not as in the rawlog: %s\n", counted(result.resampled, "frame").c_str(),
                    result.depth_note.c_str());
    if (result.imu_samples > 0) std::printf("inertial samples: %zu\n", result.imu_samples);
    if (!result.ground_truth.empty()) std::printf("ground truth: from %s\n", result.ground_truth.c_str());
    if (const std::string& file = result.depth_times; !file.empty()) {
        if (result.depth_times_fault.empty())
            std::printf("times of the depth images: from %s\n", file.c_str());
        else
            std::printf("times of the depth images: those of colour, since %s\n",
                        result.depth_times_fault.c_str());
    }
    const auto frames = static_cast<double>(result.frames);
    std::printf("speed: %.1f frames/s; decoding the rawlog alone %.1f frames/s; memory at most %.0f MB\n",
                frames / result.seconds, frames / result.decode_seconds, memoryPeakMb());
}

int run(int argc, char** argv) {
    std::string input, output, sensor_label;
    CLI::App app(
        "Turns an MRPT rawlog into a dataset folder in TUM RGB-D layout: depth to the last unit, times to "
        "the "
        "microsecond, colour files as they are.",
        kName);
    app.add_option("--input", input, "Rawlog with RGB-D observations")->required();
    app.add_option("--output", output, "Folder to write; must not exist, or be empty")->required();
    app.add_option("--sensor-label", sensor_label, "Rawlogs with several cameras: which one");
    app.footer("Example:\n  rawlog2rgbd --input office.rawlog --output office");
    if (auto code = parseCommandLine(app, argc, argv)) return *code;

    const ExportResult result = exportRawlog(input, sensor_label, output);
    if (!result.warning.empty()) printWarning(kName, result.warning);
    print(result, output);
    return 0;
}

}  // namespace
}  // namespace roevo

int main(int argc, char** argv) {
    return roevo::runProgram(roevo::kName, [&] { return roevo::run(argc, argv); });
}
