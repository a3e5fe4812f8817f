#include "sequences.h"

#include <sys/stat.h>

#include <algorithm>
#include <filesystem>
#include <functional>
#include <map>
#include <set>
#include <stdexcept>

#include "evaluation/trajectory_io.h"
#include "programs/interrupt.h"
#include "programs/program.h"
#include "recordings/frame_source.h"

namespace roevo {
namespace {

namespace fs = std::filesystem;

fs::path wholePath(const std::string& input) {
    std::error_code fault;
    fs::path path = fs::weakly_canonical(input, fault);
    if (fault) path = input;
    return path.has_filename() ? path : path.parent_path();  // "folder/"
}

std::string nameOf(const fs::path& path) {
    std::error_code ignored;
    const std::string name = (fs::is_directory(path, ignored) ? path.filename() : path.stem()).string();
    return name.empty() ? "recording" : name;
}

// Goes on to the first frame that can be decoded. @return empty, or what is wrong with the recording
std::string faultOf(FrameSource& source, const SequenceInput& sequence) {
    skipFrames(source, sequence.skip, sequence.input);
    std::size_t count = 0;
    std::string first_fault;
    DepthScaleCheck depth_scale;
    for (SourceFrame frame; (sequence.first == 0 || count < sequence.first) && source.next(frame); ++count) {
        const std::string fault = depth_scale.faultOf(frame);
        if (depth_scale.isDone()) return fault;
        if (first_fault.empty()) first_fault = frame.fault;
        InterruptGuard::check();
    }
    if (count == 0) return "it has no frame";
    return "none of its " + std::to_string(count) + " frames can be read: " + first_fault;
}

void setGroundTruth(SequenceComparison& out, const SequenceInput& sequence, const FrameSource& source) {
    GroundTruth truth = groundTruthFor(sequence.ground_truth, source);
    out.ground_truth = truth.file;
    out.reference = std::move(truth.poses);
    if (!out.reference.empty()) {
        if (!truth.note.empty()) out.notes.push_back("ground truth: " + truth.note);
        return;
    }
    out.ground_truth_fault = truth.note;
    if (truth.note.empty() && !sequence.expected_ground_truth.empty())
        out.ground_truth_fault = "there is no ground truth in " + sequence.input + " (the list says " +
                                 sequence.expected_ground_truth + ")";
}

void addFile(const fs::path& file, const std::string& name, std::set<std::string>& files) {
    struct stat state {};
    if (stat(file.c_str(), &state) == 0)
        files.insert(name + " " + std::to_string(state.st_size) + " " + std::to_string(state.st_mtim.tv_sec) +
                     "." + std::to_string(state.st_mtim.tv_nsec));
}

// All files in the folder and those below it, but for the folder `left_out`.
void addBelow(const fs::path& folder, const fs::path& left_out, std::set<std::string>& files) {
    constexpr int kDeepest = 3;  // datasets need one or two; links can lead round in circles
    constexpr auto kOptions =
        fs::directory_options::skip_permission_denied | fs::directory_options::follow_directory_symlink;
    std::error_code fault, ignored;
    fs::recursive_directory_iterator at(folder, kOptions, fault);
    for (; !fault && at != fs::recursive_directory_iterator(); at.increment(fault)) {
        const bool is_folder = at->is_directory(ignored);
        if (is_folder && (at.depth() >= kDeepest || wholePath(at->path().string()) == left_out))
            at.disable_recursion_pending();
        if (!is_folder) addFile(at->path(), at->path().lexically_relative(folder).string(), files);
    }
}

}  // namespace

std::vector<std::string> sequenceNames(const std::vector<std::string>& inputs) {
    std::vector<fs::path> paths;
    std::map<std::string, int> count;
    for (const std::string& input : inputs) {
        paths.push_back(wholePath(input));
        ++count[nameOf(paths.back())];
    }
    std::vector<std::string> names;
    std::set<std::string> taken;
    for (const fs::path& path : paths) {
        std::string name = nameOf(path);
        if (count[name] > 1 && path.parent_path().has_filename())
            name = path.parent_path().filename().string() + "_" + name;
        std::string unique = name;
        for (int i = 2; !taken.insert(unique).second; ++i) unique = name + "_" + std::to_string(i);
        names.push_back(unique);
    }
    return names;
}

std::string partOf(const SequenceInput& sequence, std::size_t size) {
    std::size_t end = sequence.first > 0 ? sequence.skip + sequence.first : 0;
    if (size > 0 && (end == 0 || end > size)) end = size;
    if (sequence.skip == 0 && end == size) return {};
    const std::string begin = std::to_string(sequence.skip);
    return end == 0 ? "frames from number " + begin + " on"
                    : "frames " + begin + " to " + std::to_string(end - 1);
}

SequenceComparison openSequence(const SequenceInput& sequence) {
    SequenceComparison out;
    out.name = sequence.name;
    out.input = sequence.input;
    if (!sequence.note.empty()) out.notes.push_back(sequence.note);
    out.paper_ate_cm = sequence.paper_ate_cm;
    // Before all else: a file that was asked for must be good even if the recording is not
    if (!sequence.ground_truth.empty()) readTumTrajectory(sequence.ground_truth);
    try {
        const auto source = openSource(sequence.input, sequence.choice);
        out.part = partOf(sequence, source->size());
        for (const std::string& note : source->notes())  // ground truth may be another one: told by itself
            if (note.rfind("ground truth:", 0) != 0) out.notes.push_back(note);
        setGroundTruth(out, sequence, *source);
        out.failure = faultOf(*source, sequence);
    } catch (const UsageError&) {
        throw;
    } catch (const Interrupted&) {
        throw;
    } catch (const std::exception& e) {
        out.failure = firstLine(e.what());
    }
    return out;
}

std::string recordingState(const std::string& input, const std::string& output) {
    const fs::path path = wholePath(input);
    const fs::path images = fs::path(path).replace_filename(path.stem().string() + "_Images");
    std::set<std::string> files;  // in an order that does not depend on the file system
    std::error_code fault;
    if (fs::is_directory(path, fault)) {
        addBelow(path, wholePath(output), files);
    } else {
        addFile(path, path.filename().string(), files);
        if (fs::is_directory(images, fault)) addBelow(images, wholePath(output), files);
    }
    std::string all;
    for (const std::string& file : files) all += file + "\n";
    return path.string() + " (state " + std::to_string(std::hash<std::string>()(all)) + ")";
}

}  // namespace roevo
