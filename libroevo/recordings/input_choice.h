#pragma once
#include <string>
#include <utility>
#include <vector>

#include "recordings/bags/topic_names.h"
#include "recordings/folder_choice.h"

namespace CLI {
class App;
}

namespace roevo {

/// What a user says of an input: which frames, where it has several cameras; and what it does not tell
/// itself.
struct InputChoice {
    std::string sensor_label;  ///< rawlogs: only this sensor; empty: the first with range images
    BagTopicNames topics;      ///< bags: those that are not to be found by themselves
    FolderChoice folder;       ///< folders: what is not in them, or wrong there
    std::string ground_truth;  ///< trajectory file in place of what lies beside the input; empty: that
    std::string mask;          ///< image file: where it is black, nothing is used (recordings/masked.h)
};

/// The options --ground-truth, --sensor-label, --mask and those of addTopicOptions() and addFolderOptions().
void addInputOptions(CLI::App& app, InputChoice& choice);

/// The options by which the topics of bags are chosen: --colour-topic, --depth-topic, --info-topic,
/// --depth-info-topic.
void addTopicOptions(CLI::App& app, BagTopicNames& topics);

/// What was chosen as a command line has it: options and their values.
std::vector<std::pair<std::string, std::string>> chosenOptions(const InputChoice& choice);

}  // namespace roevo
