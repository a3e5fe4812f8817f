#include "sequences.h"

#include <algorithm>
#include <filesystem>
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
    const fs::path path = fs::absolute(input).lexically_normal();  // a link is called as it is given
    return path.has_filename() ? path : path.parent_path();        // "folder/"
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

void setGroundTruth(SequenceComparison& out, const FrameSource& source) {
    GroundTruth truth = source.groundTruth();
    out.ground_truth = truth.file;
    out.reference = std::move(truth.poses);
    if (!out.reference.empty()) {
        if (!truth.note.empty()) out.notes.push_back("ground truth: " + truth.note);
        return;
    }
    out.ground_truth_fault = truth.note;
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
    if (!sequence.choice.ground_truth.empty()) readTrajectory(sequence.choice.ground_truth);
    try {
        const auto source = openSource(sequence.input, sequence.choice);
        for (const std::string& note : source->notes())  // of the ground truth setGroundTruth() tells
            if (note.rfind("ground truth:", 0) != 0) out.notes.push_back(note);
        setGroundTruth(out, *source);
        out.failure = faultOf(*source, sequence);
    } catch (const UsageError&) {
        throw;
    } catch (const Interrupted&) {
        throw;
    } catch (const std::exception& e) {
        out.failure = describe(e);
    }
    return out;
}

}  // namespace roevo
