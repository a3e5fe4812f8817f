#include "recordings/input_choice.h"

#include <CLI/CLI.hpp>

namespace roevo {
namespace {

constexpr char kSensorLabel[] = "--sensor-label", kMask[] = "--mask", kGroundTruth[] = "--ground-truth";

struct TopicOption {
    const char* name;
    std::string BagTopicNames::*topic;
    const char* help;
};

constexpr TopicOption kOptions[] = {
    {"--colour-topic", &BagTopicNames::colour,
     "Bags: images in rgb8, bgr8, mono8 or compressed (default: the only such topic)"},
    {"--depth-topic", &BagTopicNames::depth,
     "Bags: depth in 16UC1 (mm), 32FC1 (m) or compressed (default: the only such topic, or the one in the "
     "colour camera's frame)"},
    {"--info-topic", &BagTopicNames::colour_info,
     "Bags: camera_info of the colour images (default: the one beside them)"},
    {"--depth-info-topic", &BagTopicNames::depth_info,
     "Bags: camera_info of the depth images (default: the one beside them)"}};

}  // namespace

void addInputOptions(CLI::App& app, InputChoice& choice) {
    app.add_option(kGroundTruth, choice.ground_truth,
                   "Trajectory to compare with, TUM or EuRoC, of a single input (default: "
                   "<stem>_groundtruth.txt beside a rawlog or a bag, "
                   "groundtruth.txt or what the layout has in a folder)");
    app.add_option(kSensorLabel, choice.sensor_label, "Rawlogs with several cameras: which one");
    addTopicOptions(app, choice.topics);
    addFolderOptions(app, choice.folder);
    app.add_option(
           kMask, choice.mask,
           "Image of the colour camera's size, black where something is always in view that moves with "
           "the camera, such as the robot's arm: nothing there is used")
        ->type_name("FILE");
}

void addTopicOptions(CLI::App& app, BagTopicNames& topics) {
    for (const TopicOption& option : kOptions)
        app.add_option(option.name, topics.*option.topic, option.help)->type_name("TOPIC");
}

std::vector<std::pair<std::string, std::string>> chosenOptions(const InputChoice& choice) {
    std::vector<std::pair<std::string, std::string>> out;
    if (!choice.ground_truth.empty()) out.emplace_back(kGroundTruth, choice.ground_truth);
    if (!choice.sensor_label.empty()) out.emplace_back(kSensorLabel, choice.sensor_label);
    for (const TopicOption& option : kOptions)
        if (!(choice.topics.*option.topic).empty())
            out.emplace_back(option.name, choice.topics.*option.topic);
    if (!choice.mask.empty()) out.emplace_back(kMask, choice.mask);
    for (auto& option : choice.folder.options()) out.push_back(std::move(option));
    return out;
}

}  // namespace roevo
