#pragma once
/// A pipeline of two: one thread makes items, the caller works on them.

#include <sched.h>

#include <condition_variable>
#include <deque>
#include <exception>
#include <functional>
#include <mutex>
#include <optional>
#include <thread>
#include <utility>

namespace roevo {

/// Whether this process may use a second processor. On one, a thread would only take time from the work that
/// is being timed.
inline bool hasSecondProcessor() {
    cpu_set_t allowed;
    return sched_getaffinity(0, sizeof allowed, &allowed) != 0 || CPU_COUNT(&allowed) > 1;
}

/// Items made ahead in a thread of its own, a few at most, handed out in order; made when they are asked for
/// where there is one processor only.
template <class Item>
class Ahead {
  public:
    /// @param make  gives items until it gives none; called from one thread only, which starts here. What it
    /// throws ends the items, too: next() throws it after the items before it.
    explicit Ahead(std::function<std::optional<Item>()> make) : make_(std::move(make)) {
        if (hasSecondProcessor()) thread_ = std::thread([this] { makeAll(); });
    }
    /// Does not wait for items that nobody asked for, but for the one that is being made.
    ~Ahead() {
        {
            const std::lock_guard<std::mutex> lock(mutex_);
            stop_ = true;
        }
        room_.notify_all();
        if (thread_.joinable()) thread_.join();
    }
    Ahead(const Ahead&) = delete;
    Ahead& operator=(const Ahead&) = delete;

    std::optional<Item> next() {
        if (!thread_.joinable()) return make_();
        std::unique_lock<std::mutex> lock(mutex_);
        news_.wait(lock, [this] { return !queue_.empty() || ended_; });
        if (queue_.empty()) {
            if (failure_) std::rethrow_exception(std::exchange(failure_, nullptr));
            return std::nullopt;
        }
        std::optional<Item> item(std::move(queue_.front()));
        queue_.pop_front();
        lock.unlock();
        room_.notify_one();
        return item;
    }

    /// Whether the thread is making items: hands off what make() uses.
    bool isBusy() const {
        const std::lock_guard<std::mutex> lock(mutex_);
        return thread_.joinable() && !ended_;
    }

  private:
    static constexpr std::size_t kLength = 4;

    void makeAll() {
        try {
            while (std::optional<Item> item = make_()) {
                std::unique_lock<std::mutex> lock(mutex_);
                room_.wait(lock, [this] { return queue_.size() < kLength || stop_; });
                if (stop_) break;
                queue_.push_back(std::move(*item));
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

    std::function<std::optional<Item>()> make_;
    mutable std::mutex mutex_;
    std::condition_variable news_, room_;
    std::deque<Item> queue_;
    std::exception_ptr failure_;
    bool ended_ = false, stop_ = false;
    std::thread thread_;  // last: it uses all of the above
};

}  // namespace roevo
