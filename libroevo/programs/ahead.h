#pragma once
/// A pipeline: other threads make items, the caller works on them.

#include <algorithm>
#include <condition_variable>
#include <deque>
#include <exception>
#include <functional>
#include <mutex>
#include <optional>
#include <thread>
#include <utility>
#include <vector>

#include "roevo/options.h"

namespace roevo {

/// Items made ahead by other threads, a few at most, and handed out in order. An item may take two steps:
/// each is done to one item after the other, by one thread at a time, but both go on at once. With one thread
/// all is done by the caller, when it asks.
template <class Item>
class Ahead {
  public:
    using Make = std::function<std::optional<Item>()>;
    using Finish = std::function<void(Item&)>;

    /// @param make     gives items until it gives none
    /// @param finish   what is left to do to each; none: nothing. What either throws ends the items, too:
    ///                 next() throws it after the items before it
    /// @param threads  that work at a time, the caller's among them. On a single processor more would only
    ///                 take time from the work that is being timed
    explicit Ahead(Make make, Finish finish = nullptr, int threads = threadCount(0))
        : make_(std::move(make)), finish_(std::move(finish)) {
        const int useful = finish_ ? 2 : 1;
        for (int i = 0; i < std::min(threads - 1, useful); ++i) workers_.emplace_back([this] { work(); });
    }
    /// Does not wait for items that nobody asked for, but for those that are being made.
    ~Ahead() {
        {
            const std::lock_guard<std::mutex> lock(mutex_);
            stop_ = true;
        }
        changed_.notify_all();
        for (std::thread& worker : workers_) worker.join();
    }
    Ahead(const Ahead&) = delete;
    Ahead& operator=(const Ahead&) = delete;

    std::optional<Item> next() {
        Lock lock(mutex_);
        while (ready().empty()) {
            if (canFinish())
                finishOne(lock);  // it is the one that is waited for
            else if (workers_.empty() && canMake())
                makeOne(lock);
            else if (isOver())
                return end();
            else
                changed_.wait(lock);
        }
        std::optional<Item> item(std::move(ready().front()));
        ready().pop_front();
        lock.unlock();
        changed_.notify_all();
        return item;
    }

    /// Whether a thread may be making items: hands off what make() uses.
    bool isBusy() const {
        const std::lock_guard<std::mutex> lock(mutex_);
        return !workers_.empty() && !(ended_ && !making_);
    }

  private:
    using Lock = std::unique_lock<std::mutex>;
    /// Items that wait, at most.
    static constexpr std::size_t kMade = 4, kMadeToFinish = 2, kFinished = 2;

    std::deque<Item>& ready() { return finish_ ? finished_ : made_; }
    bool canMake() const { return !making_ && !ended_ && made_.size() < (finish_ ? kMadeToFinish : kMade); }
    bool canFinish() const {
        return finish_ && !finishing_ && !made_.empty() && finished_.size() < kFinished;
    }
    bool isOver() const { return ended_ && !making_ && !finishing_ && made_.empty(); }

    std::optional<Item> end() {
        if (failure_) std::rethrow_exception(std::exchange(failure_, nullptr));
        return std::nullopt;
    }

    // Making comes first: it is what takes long where finishing must wait, and the caller can finish itself.
    void work() {
        Lock lock(mutex_);
        while (true) {
            changed_.wait(lock, [this] { return stop_ || canMake() || canFinish() || isOver(); });
            if (stop_ || isOver()) return;
            if (canMake())
                makeOne(lock);
            else
                finishOne(lock);
        }
    }

    void makeOne(Lock& lock) {
        making_ = true;
        lock.unlock();
        try {
            std::optional<Item> item = make_();
            lock.lock();
            if (!item)
                ended_ = true;
            else if (!ended_)
                made_.push_back(std::move(*item));
        } catch (...) {
            if (!lock.owns_lock()) lock.lock();
            // Else it is of an item after one whose finishing failed
            if (!ended_) failure_ = std::current_exception();
            ended_ = true;
        }
        making_ = false;
        changed_.notify_all();
    }

    void finishOne(Lock& lock) {
        finishing_ = true;
        Item item = std::move(made_.front());
        made_.pop_front();
        lock.unlock();
        try {
            finish_(item);
            lock.lock();
            finished_.push_back(std::move(item));
        } catch (...) {
            if (!lock.owns_lock()) lock.lock();
            failure_ = std::current_exception();
            ended_ = true;
            made_.clear();
        }
        finishing_ = false;
        changed_.notify_all();
    }

    Make make_;
    Finish finish_;
    mutable std::mutex mutex_;
    std::condition_variable changed_;
    std::deque<Item> made_, finished_;
    std::exception_ptr failure_;
    bool making_ = false, finishing_ = false, ended_ = false, stop_ = false;
    std::vector<std::thread> workers_;  // last: they use all of the above
};

}  // namespace roevo
