#pragma once
#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <opencv2/imgproc.hpp>
#include <string>
#include <vector>

#include "apps/memory_source.h"
#include "core/support/simulated.h"
#include "study.h"
#include "support/csv_lines.h"
#include "support/run_program.h"
#include "support/tum_folder.h"

namespace roevo::test {

/// The first frames of a room, with the noise of a Kinect. Every case is a process of its own: no more than
/// needed.
inline testing::Sequence room(int frames) {
    simulator::SimulationOptions options = testing::smallRoom();
    options.useKinectNoise();
    return testing::simulate(options, frames);
}

/// What slidingRecording() draws, in no time: a camera that slides sideways before a wall, without noise.
inline testing::Sequence sliding(int frames) {
    testing::Sequence sequence;
    sequence.camera.width = 320;
    sequence.camera.height = 240;
    sequence.camera.fx = sequence.camera.fy = 300;
    sequence.camera.cx = 160;
    sequence.camera.cy = 120;
    for (const TumFrame& drawn : slidingRecording(frames)) {
        RgbdFrame frame{drawn.timestamp, {}, {}, {}};
        cv::cvtColor(drawn.colour, frame.grey, cv::COLOR_BGR2GRAY);
        drawn.depth.convertTo(frame.depth, CV_32F, 1 / 5000.);
        const double x = 0.01 * static_cast<double>(sequence.frames.size());
        sequence.truth.push_back({drawn.timestamp, Pose(Eigen::Translation3d(x, 0, 0))});
        sequence.frames.push_back(frame);
    }
    return sequence;
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
