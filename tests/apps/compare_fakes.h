#pragma once
/// Recordings and methods for tests of the comparison that need no images.

#include <Eigen/Geometry>
#include <chrono>
#include <functional>
#include <opencv2/core.hpp>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "recordings/frame_source.h"
#include "roevo-compare/method.h"

namespace roevo::test {

/// Keeps the processor busy.
inline void work(double ms) {
    const auto start = std::chrono::steady_clock::now();
    while (std::chrono::steady_clock::now() - start < std::chrono::duration<double, std::milli>(ms)) {
    }
}

/// Frames without images, 0.1 s apart from 1 s on, unless a test changes them.
class FakeSource : public FrameSource {
  public:
    explicit FakeSource(std::size_t count) {
        for (std::size_t i = 0; i < count; ++i) {
            SourceFrame frame;
            frame.timestamp = frame.frame.timestamp = 1 + 0.1 * static_cast<double>(i);
            frame.progress = static_cast<double>(i + 1) / static_cast<double>(count);
            frames.push_back(frame);
        }
    }

    bool next(SourceFrame& frame) override {
        if (index_ == frames.size()) return false;
        work(decoding_ms);
        frame = frames[index_++];
        frame.ms_decode = decoding_ms;
        return true;
    }
    bool skip() override { return index_ < frames.size() && ++index_; }
    const PinholeCamera& camera() const override { return camera_; }
    std::string kind() const override { return "fake"; }
    std::string cameraSource() const override { return {}; }
    GroundTruth groundTruth() const override { return {}; }
    std::vector<std::string> notes() const override { return {}; }
    std::size_t size() const override { return frames.size(); }
    std::string warning() const override { return damage; }

    std::vector<SourceFrame> frames;
    double decoding_ms = 0;
    std::string damage;

  private:
    PinholeCamera camera_{320, 240, 300, 300, 160, 120, {}};
    std::size_t index_ = 0;
};

/// Goes along x, 1 cm per frame; a test replaces what it wants to see fail.
class FakeMethod : public Method {
  public:
    std::vector<std::string> stages() const override { return stage_names; }

    MethodFrame processFrame(const RgbdFrame& frame) override {
        seen.push_back(frame.timestamp);
        MethodFrame out;
        out.tracked = true;
        out.T_world_camera = Pose(Eigen::Translation3d(0.01 * static_cast<double>(seen.size() - 1), 0, 0));
        out.stage_ms.assign(stage_names.size(), 2.0);
        if (change) change(seen.size() - 1, out);
        return out;
    }

    void refused(const RgbdFrame& frame) override { refused_stamps.push_back(frame.timestamp); }

    std::optional<std::vector<StampedPose>> finalTrajectory() override {
        return final_trajectory ? final_trajectory() : std::nullopt;
    }
    std::optional<Background> background() const override { return background_work; }
    bool writeScene(const std::string& path) override { return scene && scene(path); }

    std::vector<std::string> stage_names{"one", "two"};
    std::vector<double> seen;  ///< stamps of the frames that came
    std::vector<double> refused_stamps;
    std::function<void(std::size_t frame, MethodFrame& out)> change;
    std::function<std::optional<std::vector<StampedPose>>()> final_trajectory;
    std::function<bool(const std::string& path)> scene;
    std::optional<Background> background_work;
};

}  // namespace roevo::test
