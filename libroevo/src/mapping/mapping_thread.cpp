#include "roevo/mapping/mapping_thread.h"

#include <chrono>
#include <condition_variable>
#include <deque>
#include <exception>
#include <mutex>
#include <thread>

namespace roevo {
namespace {

constexpr std::size_t kMostWaiting = 8;  ///< jobs

}  // namespace

struct MappingThread::Impl {
    Impl(const PinholeCamera& camera, const OdometryOptions& options)
        : mapper(camera, options), worker([this] { work(); }) {}

    void work();
    MapResult run(MapJob job);

    LocalMapper mapper;  // touched by the worker only, or by the caller while the worker is idle
    mutable std::mutex mutex;
    mutable std::condition_variable changed;
    std::deque<MapJob> jobs;
    std::deque<MapResult> results;
    std::exception_ptr failure;
    int pending = 0;  // submitted and not taken
    bool busy = false, stop = false;
    std::thread worker;  // last: starts when all else is there
};

MapResult MappingThread::Impl::run(MapJob job) {
    using Clock = std::chrono::steady_clock;
    const auto start = Clock::now();
    if (job.previous >= 0) {
        mapper.setFound(job.previous, std::move(job.found));
        mapper.setRowMotion(job.previous, job.previous_rows);
    }
    mapper.setReadout(job.seconds_per_row);
    MapResult result;
    result.update = mapper.insert(std::move(job.keyframe));
    result.milliseconds = std::chrono::duration<double, std::milli>(Clock::now() - start).count();
    return result;
}

void MappingThread::Impl::work() {
    std::unique_lock<std::mutex> lock(mutex);
    while (true) {
        changed.wait(lock, [&] { return stop || !jobs.empty(); });
        if (stop) return;
        MapJob job = std::move(jobs.front());
        jobs.pop_front();
        busy = true;
        lock.unlock();
        MapResult result;
        std::exception_ptr thrown;
        try {
            result = run(std::move(job));
        } catch (...) {
            thrown = std::current_exception();
        }
        lock.lock();
        busy = false;
        if (thrown) failure = thrown;
        results.push_back(std::move(result));
        changed.notify_all();
    }
}

MappingThread::MappingThread(const PinholeCamera& camera, const OdometryOptions& options)
    : impl_(std::make_unique<Impl>(camera, options)) {}

MappingThread::~MappingThread() {
    {
        const std::lock_guard<std::mutex> lock(impl_->mutex);
        impl_->stop = true;
    }
    impl_->changed.notify_all();
    impl_->worker.join();
}

void MappingThread::submit(MapJob job) {
    std::unique_lock<std::mutex> lock(impl_->mutex);
    impl_->changed.wait(lock, [&] { return impl_->jobs.size() < kMostWaiting; });
    impl_->jobs.push_back(std::move(job));
    ++impl_->pending;
    impl_->changed.notify_all();
}

int MappingThread::pending() const {
    const std::lock_guard<std::mutex> lock(impl_->mutex);
    return impl_->pending;
}

bool MappingThread::ready() const {
    const std::lock_guard<std::mutex> lock(impl_->mutex);
    return !impl_->results.empty();
}

MapResult MappingThread::take() {
    std::unique_lock<std::mutex> lock(impl_->mutex);
    impl_->changed.wait(lock, [&] { return !impl_->results.empty(); });
    if (impl_->failure) std::rethrow_exception(impl_->failure);
    MapResult result = std::move(impl_->results.front());
    impl_->results.pop_front();
    --impl_->pending;
    return result;
}

const LocalMapper& MappingThread::finished() const {
    std::unique_lock<std::mutex> lock(impl_->mutex);
    impl_->changed.wait(lock, [&] { return impl_->jobs.empty() && !impl_->busy; });
    if (impl_->failure) std::rethrow_exception(impl_->failure);
    return impl_->mapper;
}

}  // namespace roevo
