#include "inputs.h"

#include <algorithm>
#include <filesystem>
#include <stdexcept>
#include <utility>

#include "programs/program.h"
#include "programs/text.h"
#include "study_source.h"

namespace roevo {
namespace {

std::unique_ptr<FrameSource> openFrames(const std::string& path, const InputSettings& settings) {
    auto source = openSource(path, settings.choice);
    skipFrames(*source, settings.skip, path);
    if (settings.first == 0) return source;
    return firstFrames(std::move(source), settings.first);
}

std::string shortName(const std::string& path, const std::vector<StudyInput>& others) {
    namespace fs = std::filesystem;
    fs::path whole = fs::absolute(path).lexically_normal();
    if (!whole.has_filename()) whole = whole.parent_path();  // ends in a slash
    const std::string stem = fs::is_directory(path) ? whole.filename().string() : whole.stem().string();
    std::string name = stem;
    const auto taken = [&] {
        return std::any_of(others.begin(), others.end(),
                           [&](const auto& other) { return other.name == name; });
    };
    for (int number = 2; taken(); ++number) name = stem + "-" + std::to_string(number);
    return name;
}

// Reads so far that it is known to be worth a study.
void checkFrames(FrameSource& source, const std::string& path) {
    DepthScaleCheck depth_scale;
    SourceFrame frame;
    for (std::size_t count = 0; count < kFewestFrames || !depth_scale.isDone(); ++count) {
        if (!source.next(frame))
            throw std::runtime_error(count < kFewestFrames
                                         ? path + ": only " + counted(count, "frame") +
                                               "; a study needs at least " + std::to_string(kFewestFrames)
                                         : path + ": no frame can be read; the last one: " + frame.fault);
        if (const std::string fault = depth_scale.faultOf(frame); !fault.empty())
            throw std::runtime_error(path + ": " + fault);
    }
}

void setGroundTruth(StudyInput& input, const InputSettings& settings, const FrameSource& source) {
    if (settings.ignore_ground_truth) {
        input.ground_truth_note = "no ground truth, as asked";
        return;
    }
    GroundTruth truth = source.groundTruth();
    input.ground_truth = std::move(truth.poses);
    if (!input.ground_truth.empty())
        input.ground_truth_note = "ground truth: " + truth.file;
    else
        input.ground_truth_note = truth.note.empty() ? "no ground truth" : "no ground truth: " + truth.note;
}

StudyInput openInput(const std::string& path, const InputSettings& settings,
                     const std::vector<StudyInput>& others) {
    const auto source = openFrames(path, settings);
    StudyInput input;
    input.name = shortName(path, others);
    input.path = path;
    input.camera = source->camera();
    input.options = settings.options;
    input.modes = settings.modes;
    input.truth_noise = settings.truth_noise;
    input.gaps = settings.gaps;
    setGroundTruth(input, settings, *source);
    checkFrames(*source, path);
    input.damage = std::make_shared<RecordingDamage>();
    input.open = [path, settings, damage = input.damage] {
        return watched(prefetch(openFrames(path, settings)), damage);
    };
    return input;
}

}  // namespace

OpenedInputs openInputs(const InputSettings& settings) {
    OpenedInputs opened;
    for (const std::string& path : settings.paths) {
        try {
            opened.usable.push_back(openInput(path, settings, opened.usable));
        } catch (const std::exception& e) {
            opened.left_out.push_back({path, firstLine(e.what())});
        }
    }
    if (opened.usable.empty())
        throw std::runtime_error(
            opened.left_out.empty() ? "no recording"
            : opened.left_out.size() == 1
                ? opened.left_out.front().reason
                : "none of the " + std::to_string(opened.left_out.size()) +
                      " recordings can be used; the first: " + opened.left_out.front().reason);
    return opened;
}

}  // namespace roevo
