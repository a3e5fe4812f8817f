#include "study_source.h"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>
#include <utility>

#include "programs/text.h"
#include "recordings/forwarding_source.h"

namespace roevo {
namespace {

class FirstFrames : public ForwardingSource {
  public:
    FirstFrames(std::unique_ptr<FrameSource> source, std::size_t count)
        : ForwardingSource(std::move(source)), left_(count), count_(count) {}

    bool next(SourceFrame& frame) override {
        if (left_ == 0 || !ForwardingSource::next(frame)) return false;
        --left_;
        return true;
    }
    bool skip() override {
        if (left_ == 0 || !ForwardingSource::skip()) return false;
        --left_;
        return true;
    }
    std::size_t size() const override { return std::min(ForwardingSource::size(), count_); }

  private:
    std::size_t left_, count_;
};

/// Without those from `first` on.
class GappedSource : public ForwardingSource {
  public:
    GappedSource(std::unique_ptr<FrameSource> source, std::size_t first, std::size_t count)
        : ForwardingSource(std::move(source)), before_(first), cut_(count) {}

    bool next(SourceFrame& frame) override { return cross() && ForwardingSource::next(frame); }
    bool skip() override { return cross() && ForwardingSource::skip(); }

  private:
    bool cross() {
        if (before_ > 0) {
            --before_;
            return true;
        }
        for (; cut_ > 0; --cut_)
            if (!ForwardingSource::skip()) return false;
        return true;
    }

    std::size_t before_, cut_;
};

/// Grey and colour averaged or interpolated, depth and mask by the nearest pixel.
class ResizedSource : public ForwardingSource {
  public:
    ResizedSource(std::unique_ptr<FrameSource> source, double factor)
        : ForwardingSource(std::move(source)), camera_(ForwardingSource::camera()) {
        camera_.width = static_cast<int>(std::lround(camera_.width * factor));
        camera_.height = static_cast<int>(std::lround(camera_.height * factor));
        const double across = static_cast<double>(camera_.width) / ForwardingSource::camera().width,
                     down = static_cast<double>(camera_.height) / ForwardingSource::camera().height;
        camera_.fx *= across, camera_.fy *= down;
        camera_.cx = (camera_.cx + 0.5) * across - 0.5;  // pixel centres are at integers
        camera_.cy = (camera_.cy + 0.5) * down - 0.5;
    }

    bool next(SourceFrame& frame) override {
        if (!ForwardingSource::next(frame)) return false;
        const int smooth =
            camera_.width < ForwardingSource::camera().width ? cv::INTER_AREA : cv::INTER_CUBIC;
        resize(frame.frame.grey, smooth);
        resize(frame.frame.colour, smooth);
        resize(frame.frame.depth, cv::INTER_NEAREST);
        resize(frame.frame.mask, cv::INTER_NEAREST);
        return true;
    }
    const PinholeCamera& camera() const override { return camera_; }

  private:
    void resize(cv::Mat& image, int interpolation) const {
        if (image.empty()) return;
        cv::Mat other;  // the source may show the same pixels again
        cv::resize(image, other, {camera_.width, camera_.height}, 0, 0, interpolation);
        image = other;
    }
    PinholeCamera camera_;
};

class WatchedSource : public ForwardingSource {
  public:
    WatchedSource(std::unique_ptr<FrameSource> source, std::shared_ptr<RecordingDamage> damage)
        : ForwardingSource(std::move(source)), damage_(std::move(damage)) {}

    bool next(SourceFrame& frame) override {
        if (!ForwardingSource::next(frame)) {
            seen_.warning = warning();
            if (seen_.frames >= damage_->frames) *damage_ = seen_;  // else frames were left out
            return false;
        }
        ++seen_.frames;
        if (frame.fault.empty()) return true;
        if (seen_.unreadable++ == 0) seen_.first_fault = frame.fault;
        return true;
    }

  private:
    std::shared_ptr<RecordingDamage> damage_;
    RecordingDamage seen_;
};

}  // namespace

std::unique_ptr<FrameSource> firstFrames(std::unique_ptr<FrameSource> source, std::size_t count) {
    return std::make_unique<FirstFrames>(std::move(source), count);
}

std::unique_ptr<FrameSource> withoutFrames(std::unique_ptr<FrameSource> source, std::size_t first,
                                           std::size_t count) {
    return std::make_unique<GappedSource>(std::move(source), first, count);
}

std::unique_ptr<FrameSource> resized(std::unique_ptr<FrameSource> source, double factor) {
    return std::make_unique<ResizedSource>(std::move(source), factor);
}

std::unique_ptr<FrameSource> watched(std::unique_ptr<FrameSource> source,
                                     std::shared_ptr<RecordingDamage> damage) {
    return std::make_unique<WatchedSource>(std::move(source), std::move(damage));
}

std::string RecordingDamage::text() const {
    std::string text;
    if (unreadable > 0)
        text = std::to_string(unreadable) + " of " + counted(frames, "frame") +
               " could not be read and were left out, the first: " + first_fault;
    if (!warning.empty()) text += (text.empty() ? "" : "; ") + warning;
    return text;
}

}  // namespace roevo
