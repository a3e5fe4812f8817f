// bag2rawlog: an RGB-D recording in a ROS 1 bag as an MRPT rawlog.
#include <CLI/CLI.hpp>
#include <cstdio>
#include <filesystem>

#include "bag2rawlog/convert.h"
#include "bag2rawlog/ros_home.h"
#include "output_check.h"
#include "programs/program.h"
#include "recordings/depth_times.h"

namespace roevo {
namespace {

constexpr char kName[] = "bag2rawlog";

void printTopics(const BagFile& bag) {
    for (const BagTopic& topic : bag.topics())
        std::printf("%-48s %8zu  %s%s%s%s%s\n", topic.name.c_str(), topic.messages, topic.type.c_str(),
                    topic.encoding.empty() ? "" : ", ", topic.encoding.c_str(),
                    topic.frame_id.empty() ? "" : ", frame ", topic.frame_id.c_str());
}

int run(int argc, char** argv) {
    const TemporaryRosHome ros_home;
    std::string input, output;
    BagTopicNames topics;
    double max_time_difference = 0.02;
    bool list = false;
    CLI::App app(
        "Turns colour, depth and camera_info of a ROS 1 bag into an MRPT rawlog: depth lossless inside, "
        "colour "
        "as PNG beside it.",
        kName);
    app.add_option("--input", input, "Bag to read (.bag)")->required();
    app.add_option("--output", output, "Rawlog to write; images go to <stem>_Images beside it");
    app.add_flag("--list", list,
                 "List the topics with number of messages, type, encoding and frame, and end");
    app.add_option("--colour-topic", topics.colour,
                   "Images in rgb8, bgr8 or mono8 (default: the only such topic)");
    app.add_option("--depth-topic", topics.depth,
                   "Depth in 16UC1 (mm) or 32FC1 (m) (default: the only such topic, or the one in the colour "
                   "camera's frame)");
    app.add_option("--info-topic", topics.colour_info,
                   "camera_info of the colour images (default: the one beside them)");
    app.add_option("--depth-info-topic", topics.depth_info,
                   "camera_info of the depth images (default: the one beside them)");
    app.add_option("--max-dt", max_time_difference, "Largest time between a colour and its depth image, s")
        ->capture_default_str()
        ->check(CLI::Range(0.0, 10.0));
    app.footer(
        "Examples:\n"
        "  bag2rawlog --input office.bag --output office.rawlog\n"
        "  bag2rawlog --input office.bag --list");
    if (auto code = parseCommandLine(app, argc, argv)) return *code;
    if (!list && output.empty()) throw UsageError("--output is required");
    if (!list && std::filesystem::path(output).extension() != ".rawlog")
        throw UsageError("--output must end in .rawlog: " + output);
    if (!list) checkOutputFolder(output);

    const BagFile bag(input);
    if (list) {
        printTopics(bag);
        return 0;
    }
    topics = chooseTopics(bag, topics);
    std::printf("colour: %s\ndepth: %s\n", topics.colour.c_str(), topics.depth.c_str());
    const BagCameras cameras = readCameras(bag, topics);
    for (const std::string& note : cameras.notes) std::printf("%s\n", note.c_str());

    const BagConversion result = convertBag(bag, topics, cameras, max_time_difference, output);
    std::printf("%s\n", result.association.toText().c_str());
    for (const std::string& reason : result.reasons) std::printf("left out: %s\n", reason.c_str());
    if (result.left_out > result.reasons.size())
        std::printf("left out: and %zu more\n", result.left_out - result.reasons.size());
    if (result.too_far > 0)
        std::printf("%zu depth values beyond 13.107 m do not fit into 16 bits and are now unknown\n",
                    result.too_far);
    std::printf("%s: %zu frames written, sensor label %s\n", output.c_str(), result.written,
                cameras.label.c_str());
    warnOfForeignGroundTruth(kName, output);
    warnOfForeignFile(kName, depthTimesFile(output), "depth times");
    return 0;
}

}  // namespace
}  // namespace roevo

int main(int argc, char** argv) {
    return roevo::runProgram(roevo::kName, [&] { return roevo::run(argc, argv); });
}
