#pragma once
#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include "recordings/frame_source.h"

namespace roevo::test {

/// Frames from memory. The bad one cannot be read.
class MemorySource : public FrameSource {
  public:
    static constexpr std::size_t kNone = static_cast<std::size_t>(-1);

    MemorySource(PinholeCamera camera, std::vector<RgbdFrame> frames, std::size_t bad = kNone)
        : camera_(std::move(camera)), frames_(std::move(frames)), bad_(bad) {}

    bool next(SourceFrame& frame) override {
        if (next_ == frames_.size()) return false;
        frame = SourceFrame();
        frame.timestamp = frames_[next_].timestamp;
        if (next_ == bad_) {
            frame.fault = "cannot be read";
        } else {
            frame.frame = frames_[next_];
        }
        ++next_;
        return true;
    }
    bool skip() override { return next_ < frames_.size() && ++next_; }
    const PinholeCamera& camera() const override { return camera_; }
    std::string kind() const override { return "memory"; }
    std::string cameraSource() const override { return "the test"; }
    GroundTruth groundTruth() const override { return {}; }
    std::vector<std::string> notes() const override { return {}; }
    std::size_t size() const override { return frames_.size(); }
    std::string warning() const override { return {}; }

  private:
    PinholeCamera camera_;
    std::vector<RgbdFrame> frames_;
    std::size_t bad_, next_ = 0;
};

}  // namespace roevo::test
