// rgbd2rawlog: an RGB-D dataset folder as an MRPT rawlog, lossless.
#include <CLI/CLI.hpp>
#include <cstdio>
#include <filesystem>

#include "datasets/dataset_reader.h"
#include "rgbd2rawlog/convert.h"
#include "rgbd2rawlog/verify.h"
#include "roevo_mrpt/rawlog_writer.h"
#include "support/atomic_file.h"
#include "support/program.h"

namespace roevo {
namespace {

constexpr char kName[] = "rgbd2rawlog";

void copyGroundTruth(const std::string& from, const std::string& to) {
    if (from.empty()) return;
    writeAtomically(to, [&](const std::string& temporary) {
        std::filesystem::copy_file(from, temporary, std::filesystem::copy_options::overwrite_existing);
        std::filesystem::permissions(temporary, std::filesystem::perms::owner_write,
                                     std::filesystem::perm_options::add);
    });
    std::printf("ground truth: %s\n", to.c_str());
}

void removeRawlog(const std::string& rawlog) {
    std::filesystem::remove(rawlog);
    std::filesystem::remove_all(RawlogWriter::imagesDirectory(rawlog));
}

int run(int argc, char** argv) {
    std::string input, output;
    DatasetOptions options;
    bool verify = false, skip_bad = false;
    CLI::App app(
        "Turns an RGB-D dataset folder into an MRPT rawlog: depth lossless inside, colour files beside it as "
        "they are.",
        kName);
    app.add_option("--input", input, "Dataset folder")->required();
    app.add_option("--output", output, "Rawlog to write; images go to <stem>_Images beside it")->required();
    app.add_option("--format", options.format, "Dataset format")
        ->capture_default_str()
        ->check(CLI::IsMember(datasetFormats()));
    app.add_option("--max-dt", options.max_time_difference,
                   "Largest time between a colour and its depth image, s")
        ->capture_default_str()
        ->check(CLI::Range(0.0, 10.0));
    app.add_flag("--verify", verify,
                 "Read the rawlog back and compare every depth value, time stamp and the intrinsics");
    app.add_flag("--skip-bad", skip_bad, "Leave out frames whose images cannot be used, instead of failing");
    app.footer(
        "Example:\n  rgbd2rawlog --input rgbd_dataset_freiburg1_desk --output fr1_desk.rawlog --verify");
    if (auto code = parseCommandLine(app, argc, argv)) return *code;
    if (std::filesystem::path(output).extension() != ".rawlog")
        throw UsageError("--output must end in .rawlog: " + output);

    const DatasetReader dataset = openDataset(input, options);
    std::printf("%s\n", dataset.summary().c_str());
    const ConvertResult result = convertToRawlog(dataset, output, skip_bad);
    for (const std::string& line : result.left_out) std::printf("left out: %s\n", line.c_str());
    std::printf("%s: %zu frames written, %zu left out\n", output.c_str(), result.written.size(),
                result.left_out.size());
    if (verify) {
        try {
            const VerifyResult checked = verifyRawlog(dataset, result.written, output);
            std::printf(
                "verified: %zu frames, %zu depth values, stamps, grey images and intrinsics: 0 differences\n",
                checked.frames, checked.depth_values);
        } catch (...) {
            removeRawlog(output);
            throw;
        }
    }
    copyGroundTruth(dataset.groundTruthPath(), groundTruthFileOf(output));
    return 0;
}

}  // namespace
}  // namespace roevo

int main(int argc, char** argv) {
    return roevo::runProgram(roevo::kName, [&] { return roevo::run(argc, argv); });
}
