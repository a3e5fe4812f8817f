#pragma once
#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <string>
#include <vector>

#include "apps/memory_source.h"
#include "core/support/simulated.h"
#include "study.h"
#include "support/csv_lines.h"
#include "support/run_program.h"

namespace roevo::test {

/// The first frames of a room, with the noise of a Kinect. Every case is a process of its own: no more than
/// needed.
inline testing::Sequence room(int frames) {
    simulator::SimulationOptions options = testing::smallRoom();
    options.useKinectNoise();
    return testing::simulate(options, frames);
}

/// An experiment on recordings in memory, with a folder for what it writes.
class StudyFolder : public ::testing::Test {
  protected:
    static StudyInput input(const std::string& name, const testing::Sequence& sequence, bool with_truth,
                            bool damaged = false) {
        StudyInput input;
        input.name = input.path = name;
        input.camera = sequence.camera;
        input.open = [&sequence, damaged] {
            return std::make_unique<MemorySource>(sequence.camera, sequence.frames,
                                                  damaged ? 2 : MemorySource::kNone);
        };
        if (with_truth) input.ground_truth = sequence.truth;
        input.ground_truth_note = with_truth ? "simulated" : "no ground truth was found";
        return input;
    }
    /// A recording that is gone by the time it is opened.
    static StudyInput lostInput(const std::string& name, const testing::Sequence& sequence) {
        StudyInput lost = input(name, sequence, true);
        lost.open = [name]() -> std::unique_ptr<FrameSource> {
            throw std::runtime_error("cannot read " + name);
        };
        return lost;
    }
    std::vector<std::vector<std::string>> table(const std::string& name) const {
        return csvLines(readFile(folder_ / name));
    }
    std::string folder() const { return folder_.path().string(); }
    bool exists(const std::string& name) const { return std::filesystem::exists(folder_ / name); }

    static bool says(const StudyReport& report, const std::string& text) {
        return std::any_of(report.notes.begin(), report.notes.end(),
                           [&](const std::string& note) { return note.find(text) != std::string::npos; });
    }

    TemporaryFolder folder_;
};

}  // namespace roevo::test
