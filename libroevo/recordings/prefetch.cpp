#include <optional>
#include <utility>

#include "programs/ahead.h"
#include "recordings/forwarding_source.h"

namespace roevo {
namespace {

class PrefetchingSource : public ForwardingSource {
  public:
    using ForwardingSource::ForwardingSource;

    bool next(SourceFrame& frame) override {
        if (!ahead_) ahead_.emplace([this] { return decode(); });
        std::optional<SourceFrame> decoded = ahead_->next();
        if (!decoded) return false;
        frame = std::move(*decoded);
        return true;
    }

    /// From the first next() on the thread owns the source: the frame is then decoded in vain.
    bool skip() override {
        SourceFrame left_out;
        return ahead_ ? next(left_out) : ForwardingSource::skip();
    }

    std::string warning() const override {
        // What has been read so far may be changing under the thread's hands until it has ended.
        return ahead_ && ahead_->isBusy() ? std::string() : ForwardingSource::warning();
    }

  private:
    std::optional<SourceFrame> decode() {
        std::optional<SourceFrame> frame(std::in_place);
        if (!ForwardingSource::next(*frame)) frame.reset();
        return frame;
    }

    std::optional<Ahead<SourceFrame>> ahead_;
};

}  // namespace

std::unique_ptr<FrameSource> prefetch(std::unique_ptr<FrameSource> source) {
    return std::make_unique<PrefetchingSource>(std::move(source));
}

}  // namespace roevo
