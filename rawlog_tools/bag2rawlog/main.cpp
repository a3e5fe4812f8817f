// bag2rawlog: an RGB-D recording in a ROS bag as an MRPT rawlog: rgbd2rawlog's conversion with what people
// want of bags, where some messages are often unusable, and a list of topics.
#include <CLI/CLI.hpp>
#include <cstdio>
#include <filesystem>

#include "input/excerpt.h"
#include "programs/program.h"
#include "recordings/bags/bag_file.h"
#include "recordings/input_choice.h"
#include "rgbd2rawlog/conversion.h"

namespace roevo {
namespace {

constexpr char kName[] = "bag2rawlog";

void printTopics(const BagFile& bag) {
    for (const BagTopic& topic : bag.topics())
        std::printf("%-48s %8zu  %s%s%s%s%s\n", excerpt(topic.name).c_str(), topic.messages,
                    excerpt(topic.type).c_str(), topic.encoding.empty() ? "" : ", ",
                    excerpt(topic.encoding).c_str(), topic.frame_id.empty() ? "" : ", frame ",
                    excerpt(topic.frame_id).c_str());
    for (const std::string& damage : bag.damage()) std::printf("left out: %s\n", damage.c_str());
}

int run(int argc, char** argv) {
    ConversionSettings settings;
    settings.convert.skip_bad = true;
    bool list = false;
    CLI::App app(
        "Turns colour, depth and camera_info of a ROS bag into an MRPT rawlog: depth lossless inside, colour "
        "as PNG beside it. The other programs read bags as they are.",
        kName);
    app.add_option("--input", settings.input,
                   "Bag to read: .bag, .db3, .mcap, or the folder of a ROS 2 recording")
        ->required();
    app.add_option("--output", settings.output, "Rawlog to write; images go to <stem>_Images beside it");
    app.add_flag("--list", list,
                 "List the topics with number of messages, type, encoding and frame, and end");
    app.add_option("--ground-truth", settings.dataset.ground_truth,
                   "Trajectory to go with the rawlog, TUM or EuRoC")
        ->type_name("FILE");
    addTopicOptions(app, settings.dataset.topics);
    app.add_option("--max-dt", settings.dataset.max_time_difference,
                   "Largest time between a colour and its depth image, s")
        ->capture_default_str()
        ->check(CLI::Range(0.0, 10.0));
    app.footer(
        "Examples:\n"
        "  bag2rawlog --input office.bag --output office.rawlog\n"
        "  bag2rawlog --input office.bag --list");
    if (auto code = parseCommandLine(app, argc, argv)) return *code;
    if (list) {
        printTopics(BagFile(settings.input));
        return 0;
    }
    if (settings.output.empty()) throw UsageError("--output is required");
    if (std::filesystem::path(settings.output).extension() != ".rawlog")
        throw UsageError("--output must end in .rawlog: " + settings.output);
    settings.dataset.format = "bag";
    convertRecording(kName, settings);
    return 0;
}

}  // namespace
}  // namespace roevo

int main(int argc, char** argv) {
    return roevo::runProgram(roevo::kName, [&] { return roevo::run(argc, argv); });
}
