#include <sched.h>

#include <condition_variable>
#include <deque>
#include <exception>
#include <mutex>
#include <thread>
#include <utility>

#include "frame_source.h"

namespace roevo {
namespace {

constexpr std::size_t kQueueLength = 4;

class PrefetchingSource : public FrameSource {
  public:
    explicit PrefetchingSource(std::unique_ptr<FrameSource> source) : source_(std::move(source)) {}

    ~PrefetchingSource() override {
        {
            const std::lock_guard<std::mutex> lock(mutex_);
            stop_ = true;
        }
        room_.notify_all();
        if (thread_.joinable()) thread_.join();
    }

    bool next(SourceFrame& frame) override {
        if (!thread_.joinable()) thread_ = std::thread([this] { decodeAll(); });
        std::unique_lock<std::mutex> lock(mutex_);
        news_.wait(lock, [this] { return !queue_.empty() || ended_; });
        if (queue_.empty()) {
            if (failure_) std::rethrow_exception(std::exchange(failure_, nullptr));
            return false;
        }
        frame = std::move(queue_.front());
        queue_.pop_front();
        lock.unlock();
        room_.notify_one();
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
        const std::lock_guard<std::mutex> lock(mutex_);
        return ended_ || !thread_.joinable() ? source_->warning() : std::string();
    }

  private:
    void decodeAll() {
        try {
            for (SourceFrame frame; source_->next(frame); frame = SourceFrame()) {
                std::unique_lock<std::mutex> lock(mutex_);
                room_.wait(lock, [this] { return queue_.size() < kQueueLength || stop_; });
                if (stop_) break;
                queue_.push_back(std::move(frame));
                lock.unlock();
                news_.notify_one();
            }
        } catch (...) {
            const std::lock_guard<std::mutex> lock(mutex_);
            failure_ = std::current_exception();
        }
        const std::lock_guard<std::mutex> lock(mutex_);
        ended_ = true;
        news_.notify_all();
    }

    std::unique_ptr<FrameSource> source_;
    std::thread thread_;
    mutable std::mutex mutex_;
    std::condition_variable news_, room_;
    std::deque<SourceFrame> queue_;
    std::exception_ptr failure_;
    bool ended_ = false, stop_ = false;
};

}  // namespace

std::unique_ptr<FrameSource> prefetch(std::unique_ptr<FrameSource> source) {
    // On one processor the thread would only take time from the tracking that is being timed
    cpu_set_t allowed;
    if (sched_getaffinity(0, sizeof allowed, &allowed) == 0 && CPU_COUNT(&allowed) < 2) return source;
    return std::make_unique<PrefetchingSource>(std::move(source));
}

}  // namespace roevo
