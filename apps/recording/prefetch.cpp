#include <optional>
#include <utility>

#include "frame_source.h"
#include "support/ahead.h"

namespace roevo {
namespace {

class PrefetchingSource : public FrameSource {
  public:
    explicit PrefetchingSource(std::unique_ptr<FrameSource> source) : source_(std::move(source)) {}

    bool next(SourceFrame& frame) override {
        if (!ahead_) ahead_.emplace([this] { return decode(); });
        std::optional<SourceFrame> decoded = ahead_->next();
        if (!decoded) return false;
        frame = std::move(*decoded);
        return true;
    }

    // Only before the first next(): the thread owns the source from then on.
    bool skip() override { return source_->skip(); }

    const PinholeCamera& camera() const override { return source_->camera(); }
    std::string kind() const override { return source_->kind(); }
    std::string cameraSource() const override { return source_->cameraSource(); }
    GroundTruth groundTruth() const override { return source_->groundTruth(); }
    std::vector<std::string> notes() const override { return source_->notes(); }
    std::size_t size() const override { return source_->size(); }
    std::string warning() const override {
        // What has been read so far may be changing under the thread's hands until it has ended.
        return ahead_ && ahead_->isBusy() ? std::string() : source_->warning();
    }

  private:
    std::optional<SourceFrame> decode() {
        std::optional<SourceFrame> frame(std::in_place);
        if (!source_->next(*frame)) frame.reset();
        return frame;
    }

    std::unique_ptr<FrameSource> source_;
    std::optional<Ahead<SourceFrame>> ahead_;
};

}  // namespace

std::unique_ptr<FrameSource> prefetch(std::unique_ptr<FrameSource> source) {
    return std::make_unique<PrefetchingSource>(std::move(source));
}

}  // namespace roevo
