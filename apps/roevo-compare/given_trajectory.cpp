#include "given_trajectory.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

#include "evaluation/evaluate.h"
#include "evaluation/trajectory_io.h"
#include "programs/program.h"
#include "programs/text.h"
#include "report/ranking.h"

namespace roevo {
namespace {

constexpr std::size_t kLongestName = 60;  // characters

std::string faultOf(const std::string& name) {
    if (name.empty()) return "expected NAME=FILE";
    if (cleanText(name) != name || countCharacters(name) > kLongestName)
        return "a name has up to " + std::to_string(kLongestName) + " printable characters";
    if (!isNameOfAFolder(name) || name.find(kVariantMark) != std::string::npos)
        return "a name must be fit for a folder, without / and @";
    if (isOurs(name)) return "names that begin with roevo are those of its own methods";
    for (const MethodInfo& method : knownMethods())
        if (name == method.name || name == method.label) return "that is the name of a method";
    return {};
}

}  // namespace

GivenTrajectory::GivenTrajectory(std::string file, std::vector<StampedPose> poses)
    : file_(std::move(file)), poses_(std::move(poses)) {}

MethodFrame GivenTrajectory::processFrame(const RgbdFrame& frame) {
    if (!has_frames_) first_frame_ = frame.timestamp;
    has_frames_ = true;
    last_frame_ = frame.timestamp;
    const auto distance = [&](std::size_t i) { return std::abs(poses_[i].timestamp - frame.timestamp); };
    while (next_ + 1 < poses_.size() && distance(next_ + 1) <= distance(next_)) ++next_;
    MethodFrame result;
    if (next_ < poses_.size() && distance(next_) <= kDefaultMaxDt) {
        result.tracked = true;
        result.T_world_camera = poses_[next_].T_world_camera;
        used_.push_back(poses_[next_++]);
    } else {
        result.reason = "no pose within " + plainNumber(kDefaultMaxDt) + " s";
    }
    return result;
}

std::optional<std::vector<StampedPose>> GivenTrajectory::finalTrajectory() {
    if (used_.empty() && has_frames_)
        throw std::runtime_error("no pose of " + file_ + " is within " + plainNumber(kDefaultMaxDt) +
                                 " s of a frame: frames are from " + stampText(first_frame_) + " to " +
                                 stampText(last_frame_) + " s, its poses from " +
                                 stampText(poses_.front().timestamp) + " to " +
                                 stampText(poses_.back().timestamp) + " s");
    return used_;
}

std::vector<MethodInfo> givenTrajectories(const std::vector<std::string>& arguments) {
    std::vector<MethodInfo> given;
    for (const std::string& argument : arguments) {
        const NamedFile named = splitNamedFile(argument);
        if (const std::string fault = faultOf(named.name); !fault.empty())
            throw UsageError("--trajectory " + cleanText(argument) + ": " + fault);
        if (std::any_of(given.begin(), given.end(),
                        [&](const MethodInfo& m) { return m.name == named.name; }))
            throw UsageError("--trajectory " + cleanText(argument) + ": that name is there twice");
        MethodInfo info;
        info.name = info.label = named.name;
        info.note = "Poses that another program made, from " + named.file +
                    ": it was not run here, so its times and its memory are not known. A frame counts as "
                    "tracked where "
                    "there is a pose within " +
                    plainNumber(kDefaultMaxDt) + " s.";
        info.trajectory = named.file;
        given.push_back(info);
    }
    std::sort(given.begin(), given.end(),
              [](const MethodInfo& a, const MethodInfo& b) { return a.name < b.name; });
    return given;
}

std::vector<StampedPose> readGivenTrajectory(const std::string& file,
                                             const std::vector<StampedPose>& reference,
                                             const std::string& reference_file) {
    return readTrajectory(file, {}, {stampsOf(reference), reference_file});
}

void forgetCosts(MethodRun& run) {
    run.stages.clear();
    run.total = {"total", 0, 0, 0};
    run.decode = {"decode", 0, 0, 0};
    run.cpu_ms_per_frame = run.core_lost = run.memory_peak_mb = 0;
}

bool isNameOfAFolder(const std::string& name) {
    const std::string partial = ".partial";  // of a run that is under way
    const bool is_partial = name.size() >= partial.size() &&
                            name.compare(name.size() - partial.size(), partial.size(), partial) == 0;
    return name.empty() || (name[0] != '.' && name.find('/') == std::string::npos && !is_partial);
}

}  // namespace roevo
