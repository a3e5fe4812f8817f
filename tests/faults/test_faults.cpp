// Faults between a recording and the odometry: whatever comes, no crash, no NaN, no wrong pose without a
// word, and tracking goes on. A quick part always; the whole table with ROEVO_FAULT_TABLE=FILE ('-': stdout).
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <iostream>
#include <map>
#include <optional>
#include <sstream>

#include "core/support/real_clip.h"
#include "core/support/simulated.h"
#include "judge.h"
#include "tracking/se3.h"

namespace roevo::faults {
namespace {

using testing::simulate;

constexpr std::size_t kFrom = 20;  ///< first frame that something is done to

std::optional<Recording> clip(const std::string& name, std::size_t count) {
    auto real = testing::realClip(name, count);
    if (!real) return std::nullopt;
    Recording recording{name, real->camera, {}, {}};
    std::size_t next = 1;
    for (RgbdFrame& frame : real->frames) {
        while (next < real->truth.size() && real->truth[next].timestamp < frame.timestamp) ++next;
        if (next == real->truth.size()) break;
        const StampedPose &a = real->truth[next - 1], &b = real->truth[next];
        if (frame.timestamp < a.timestamp - 0.02) continue;  // the truth has not begun yet
        frame.colour = cv::Mat();
        recording.frames.push_back(frame);
        recording.truth.push_back(interpolate(a.T_world_camera, b.T_world_camera,
                                              (frame.timestamp - a.timestamp) / (b.timestamp - a.timestamp)));
    }
    return recording;
}

Recording simulated(const std::string& scene, int count, simulator::SimulationOptions options = {}) {
    options.scene = scene;
    options.useKinectNoise();
    const auto sequence = simulate(options, count);
    Recording recording{"simulated " + scene, sequence.camera, sequence.frames, {}};
    for (const StampedPose& pose : sequence.truth) recording.truth.push_back(pose.T_world_camera);
    return recording;
}

const Recording& smallRoom() {
    static const Recording recording = simulated("livingroom", 26, testing::smallRoom());
    return recording;
}

const Played& cleanRun(const Recording& recording) {
    static std::map<std::string, Played> runs;
    const auto found = runs.find(recording.name);
    if (found != runs.end()) return found->second;
    return runs[recording.name] = play(recording, inject(recording, allFaults().front(), 0, 0, 0));
}

std::string joined(const std::vector<std::string>& lines) {
    std::string text;
    for (const std::string& line : lines) text += (text.empty() ? "" : "; ") + line;
    return text;
}

class QuickFaults : public ::testing::TestWithParam<std::size_t> {};

/// The frames that are not plainly ok, for whoever looks for the reason.
std::string story(const std::vector<Shown>& frames, const Played& played) {
    std::string text;
    for (std::size_t i = 0; i < frames.size(); ++i) {
        const FrameResult& result = played.results[i];
        if (result.reason.empty() && !frames[i].faulty && played.jump[i] <= 0) continue;
        char line[160];
        std::snprintf(line, sizeof line,
                      "\n%3zu %s %-11s jump %5.1f cm, sigma %5.1f cm, matched %3.0f %%%s: ", i,
                      frames[i].faulty ? "faulty" : "whole ", toString(result.status), 100 * played.jump[i],
                      100 * result.sigmaTranslation(), 100 * result.matched_ratio,
                      result.new_keyframe ? ", keyframe" : "");
        text += line + result.reason;
    }
    return text;
}

TEST_P(QuickFaults, AreNamedAndForgotten) {
    constexpr std::size_t kBefore = 12;
    const Fault& fault = allFaults()[GetParam()];
    constexpr std::size_t kFaulty = 5;
    const auto frames = inject(smallRoom(), fault, kBefore, kFaulty, 1);
    const Played played = play(smallRoom(), frames);
    const Verdict verdict = judge(frames, played, cleanRun(smallRoom()), fault.expected, kFaulty);
    EXPECT_TRUE(verdict.broken.empty())
        << fault.name << ": " << joined(verdict.broken) << story(frames, played);
}

INSTANTIATE_TEST_SUITE_P(Kinds, QuickFaults, ::testing::Range(std::size_t{0}, allFaults().size()),
                         [](const auto& info) {
                             std::string name;
                             for (const char c : allFaults()[info.param].name)
                                 name += std::isalnum(static_cast<unsigned char>(c)) ? c : '_';
                             return name;
                         });

TEST(CleanRecording, BreaksNoPromise) {
    const auto frames = inject(smallRoom(), allFaults().front(), 0, 0, 0);
    const Verdict verdict =
        judge(frames, cleanRun(smallRoom()), cleanRun(smallRoom()), Expected::kTracked, 0);
    EXPECT_TRUE(verdict.broken.empty()) << joined(verdict.broken);
}

const Fault& faultNamed(const std::string& name) {
    return *std::find_if(allFaults().begin(), allFaults().end(),
                         [&](const Fault& fault) { return fault.name == name; });
}

TEST(FramesThatAreMissing, AFastTurnMeanwhileIsCoveredByTheSigma) {
    const std::optional<Recording> recording = clip("tum_fr1_rpy_100", 60);
    if (!recording) GTEST_SKIP() << "needs the real clips";
    std::vector<double> ates;
    double clean = 0;
    for (std::size_t from = kFrom - 2; from <= kFrom + 2; ++from) {
        const auto frames = inject(*recording, faultNamed("frames dropped"), from, 5, 1);
        const Played played = play(*recording, frames);
        const Verdict verdict = judge(frames, played, cleanRun(*recording), Expected::kTracked, 5);
        EXPECT_GT(verdict.until_ok, 0) << from;
        EXPECT_LE(verdict.until_ok, 5) << from;
        EXPECT_LE(verdict.worst_named, 0) << from << story(frames, played);
        ates.push_back(verdict.ate);
        if (from != kFrom) continue;
        EXPECT_TRUE(verdict.broken.empty()) << joined(verdict.broken) << story(frames, played);
        clean = verdict.clean_ate;
    }
    // Which wrong pose one gap ends in is luck
    std::sort(ates.begin(), ates.end());
    EXPECT_LT(ates[2], 1.5 * clean + 0.002);
}

TEST(DepthThatDropsOut, TheReferenceIsWorthMoreThanAScrap) {
    const std::optional<Recording> recording = clip("icl_office_kt0_50", 50);
    if (!recording) GTEST_SKIP() << "needs the real clips";
    const auto frames = inject(*recording, faultNamed("depth in a corner only"), 10, 30, 1);
    const Played played = play(*recording, frames);
    const Verdict verdict = judge(frames, played, cleanRun(*recording), Expected::kTracked, 30);
    EXPECT_TRUE(verdict.broken.empty()) << joined(verdict.broken);
    EXPECT_LT(verdict.ate, std::max(1.5 * verdict.clean_ate, 0.002)) << "0.94 cm with keyframes made of it";
}

std::string describeStatuses(const Verdict& verdict) {
    std::string text;
    for (const auto& [status, count] : verdict.statuses)
        text += (text.empty() ? "" : ", ") + std::to_string(count) + " " + status;
    return text;
}

struct Row {
    std::string recording, fault, length;
    Verdict verdict;
};

void print(std::ostream& out, const Row& row) {
    const Verdict& v = row.verdict;
    char numbers[96];
    std::snprintf(numbers, sizeof numbers, "%d | %.2f / %.2f", v.until_ok, 100 * v.ate, 100 * v.clean_ate);
    out << "| " << row.recording << " | " << row.fault << " | " << row.length << " | " << describeStatuses(v)
        << " | " << v.reason << " | " << numbers << " | " << (v.broken.empty() ? "held" : joined(v.broken))
        << " |" << std::endl;
}

std::vector<Recording> recordings(const char* only) {
    std::vector<Recording> all;
    const auto wanted = [&](const std::string& name) {
        return !only || name.find(only) != std::string::npos;
    };
    for (const char* name :
         {"tum_fr1_xyz_150", "tum_fr1_rpy_100", "tum_fr3_structure_notexture_far_80", "icl_office_kt0_50"})
        if (wanted(name))
            if (auto recording = clip(name, 60)) all.push_back(std::move(*recording));
    for (const char* scene : {"livingroom", "corridor"})
        if (wanted(std::string("simulated ") + scene)) all.push_back(simulated(scene, 60));
    return all;
}

TEST(FaultTable, Whole) {
    const char* file = std::getenv("ROEVO_FAULT_TABLE");
    if (!file) GTEST_SKIP() << "takes many minutes; ROEVO_FAULT_TABLE=FILE writes it";
    std::ofstream written(file);
    std::ostream& out = std::string(file) == "-" ? std::cout : written;
    const char* only = std::getenv("ROEVO_FAULT_RECORDING");
    const char* kind = std::getenv("ROEVO_FAULT_KIND");
    int cases = 0, held = 0;
    const auto add = [&](const Row& row) {
        ++cases;
        held += row.verdict.broken.empty() ? 1 : 0;
        print(out, row);
    };
    out << "| recording | fault | frames | these were | reason | ok again after | ATE, clean, cm | promises "
           "|\n"
           "|---|---|---|---|---|---|---|---|\n";
    for (const Recording& recording : recordings(only)) {
        const Played& clean = cleanRun(recording);
        const auto whole = inject(recording, allFaults().front(), 0, 0, 0);
        add({recording.name, "none", "0", judge(whole, clean, clean, Expected::kTracked, 0)});
        for (const Fault& fault : allFaults()) {
            if (kind && fault.name.find(kind) == std::string::npos) continue;
            for (const std::size_t count : {1, 5, 15, 1000}) {
                const auto frames = inject(recording, fault, kFrom, count, 1);
                const Played played = play(recording, frames);
                add({recording.name, fault.name, count < 1000 ? std::to_string(count) : "to the end",
                     judge(frames, played, clean, fault.expected, count)});
                if (kind) out << story(frames, played) << "\n";
            }
        }
        if (kind && std::string("mix").find(kind) == std::string::npos) continue;
        for (std::uint64_t seed = 1; seed <= 6; ++seed) {
            std::string names;
            const auto frames = injectMix(recording, seed, names);
            const Played played = play(recording, frames);
            add({recording.name, "mix: " + names, "1 to 5", judge(frames, played, clean, Expected::kAny, 5)});
            if (kind) out << story(frames, played) << "\n";
        }
    }
    out << "\n" << held << " of " << cases << " cases hold all promises.\n";
    EXPECT_EQ(held, cases);
    EXPECT_GT(cases, 0) << "no recording of that name, or no real clips";
}

}  // namespace
}  // namespace roevo::faults
