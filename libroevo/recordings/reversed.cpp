#include "recordings/reversed.h"

#include <algorithm>
#include <utility>

#include "recordings/forwarding_source.h"

namespace roevo {
namespace {

constexpr std::size_t kBlock = 64;  // frames; 150 MB of 640x480 in colour

class ReversedSource : public ForwardingSource {
  public:
    ReversedSource(std::function<std::unique_ptr<FrameSource>()> open, double mirror)
        : ForwardingSource(open()), open_(std::move(open)), mirror_(mirror) {
        while (ForwardingSource::skip()) ++left_;
        count_ = left_;
    }

    bool next(SourceFrame& frame) override {
        if (block_.empty()) readBlock();
        if (block_.empty()) return false;
        frame = std::move(block_.back());
        block_.pop_back();
        frame.timestamp = mirror_ - frame.timestamp;
        frame.frame.timestamp = mirror_ - frame.frame.timestamp;
        frame.progress = 1 - static_cast<double>(left_ + block_.size()) /
                                 static_cast<double>(std::max<std::size_t>(count_, 1));
        return true;
    }
    bool skip() override {
        if (!block_.empty()) {
            block_.pop_back();
            return true;
        }
        return left_ > 0 && left_--;
    }
    std::size_t size() const override { return count_; }

  private:
    void readBlock() {
        const std::size_t begin = left_ - std::min(left_, kBlock);
        if (begin == left_) return;
        const auto source = open_();
        for (std::size_t i = 0; i < begin; ++i) source->skip();
        for (SourceFrame frame; block_.size() < left_ - begin && source->next(frame);)
            block_.push_back(std::move(frame));
        left_ = begin;
    }

    std::function<std::unique_ptr<FrameSource>()> open_;
    double mirror_;
    std::vector<SourceFrame> block_;    ///< the last one comes next
    std::size_t left_ = 0, count_ = 0;  ///< frames before the block; in all
};

}  // namespace

std::unique_ptr<FrameSource> reversedFrames(std::function<std::unique_ptr<FrameSource>()> open,
                                            double mirror) {
    return std::make_unique<ReversedSource>(std::move(open), mirror);
}

std::vector<StampedPose> reversedPoses(const std::vector<StampedPose>& poses, double mirror) {
    std::vector<StampedPose> reversed(poses.rbegin(), poses.rend());
    for (StampedPose& pose : reversed) pose.timestamp = mirror - pose.timestamp;
    return reversed;
}

}  // namespace roevo
