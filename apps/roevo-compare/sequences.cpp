#include "sequences.h"

#include <algorithm>
#include <filesystem>
#include <functional>
#include <map>
#include <set>
#include <stdexcept>

#include "evaluation/trajectory_io.h"
#include "recording/frame_source.h"
#include "support/interrupt.h"
#include "support/program.h"

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

void append(std::string& text, const std::string& more) {
    if (!more.empty()) text += (text.empty() ? "" : "; ") + more;
}

// Goes on to the first frame that can be decoded. @return empty, or what is wrong with the recording
std::string faultOf(FrameSource& source, const SequenceInput& sequence) {
    skipFrames(source, sequence.skip, sequence.input);
    std::size_t count = 0;
    std::string first_fault;
    for (SourceFrame frame; (sequence.first == 0 || count < sequence.first) && source.next(frame); ++count) {
        if (frame.fault.empty()) return depthScaleFault(frame.frame);
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
        append(out.note, truth.note);
        return;
    }
    out.ground_truth_fault = truth.note;
    if (truth.note.empty() && !sequence.expected_ground_truth.empty())
        out.ground_truth_fault = "there is no ground truth in " + sequence.input + " (the list says " +
                                 sequence.expected_ground_truth + ")";
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

SequenceComparison openSequence(const SequenceInput& sequence) {
    SequenceComparison out;
    out.name = sequence.name;
    out.input = sequence.input;
    out.note = sequence.note;
    out.paper_ate_cm = sequence.paper_ate_cm;
    // Before all else: a file that was asked for must be good even if the recording is not
    if (!sequence.ground_truth.empty()) readTumTrajectory(sequence.ground_truth);
    try {
        const auto source = openSource(sequence.input, sequence.sensor_label);
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

std::string recordingState(const std::string& input) {
    const fs::path path = wholePath(input);
    std::set<std::string> files;  // in an order that does not depend on the file system
    const auto add = [&](const fs::path& file) {
        std::error_code fault;
        if (!fs::exists(file, fault)) return;
        const auto time = fs::last_write_time(file, fault).time_since_epoch().count();
        const bool regular = fs::is_regular_file(file, fault);
        files.insert(file.filename().string() + " " + std::to_string(time) + " " +
                     (regular ? std::to_string(fs::file_size(file, fault)) : "folder"));
    };
    std::error_code fault;
    if (fs::is_directory(path, fault))
        for (const auto& entry : fs::directory_iterator(path, fault)) add(entry.path());
    else
        for (const fs::path& file : {path, fs::path(path).replace_filename(path.stem().string() + "_Images")})
            add(file);
    std::string all;
    for (const std::string& file : files) all += file + "\n";
    return path.string() + " (state " + std::to_string(std::hash<std::string>()(all)) + ")";
}

}  // namespace roevo
