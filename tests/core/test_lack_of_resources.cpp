// Threads that cannot be started and memory that runs out, in the middle of a recording. The functions that
// ask for them are replaced in this whole program.
#include <dlfcn.h>
#include <gtest/gtest.h>
#include <pthread.h>

#include <atomic>
#include <cerrno>
#include <chrono>
#include <cstdlib>
#include <new>
#include <sstream>
#include <thread>

#include "core/support/mapped_run.h"

namespace {

std::atomic<bool> no_threads{false};
std::atomic<int> refused_threads{0};
/// Allocations until all fail; negative: none does.
std::atomic<int> left_in_this_thread{-1}, left_in_other_threads{-1};
const std::thread::id main_thread = std::this_thread::get_id();

}  // namespace

extern "C" int pthread_create(pthread_t* thread, const pthread_attr_t* attributes, void* (*start)(void*),
                              void* argument) {
    using Create = int (*)(pthread_t*, const pthread_attr_t*, void* (*)(void*), void*);
    static const auto create = reinterpret_cast<Create>(dlsym(RTLD_NEXT, "pthread_create"));
    if (!no_threads) return create(thread, attributes, start, argument);
    ++refused_threads;
    return EAGAIN;
}

// Not inlined, where GCC takes free() for the wrong end of what new began
[[gnu::noinline]] void* operator new(std::size_t size) {
    auto& left = std::this_thread::get_id() == main_thread ? left_in_this_thread : left_in_other_threads;
    int before = left;
    while (before > 0 && !left.compare_exchange_weak(before, before - 1)) {
    }
    if (before == 0) throw std::bad_alloc();
    if (void* const memory = std::malloc(size)) return memory;
    throw std::bad_alloc();
}
void* operator new(std::size_t size, const std::nothrow_t&) noexcept {
    try {
        return operator new(size);
    } catch (const std::bad_alloc&) {
        return nullptr;
    }
}
[[gnu::noinline]] void operator delete(void* memory) noexcept {
    std::free(memory);
}
void operator delete(void* memory, const std::nothrow_t&) noexcept {
    std::free(memory);
}
[[gnu::noinline]] void operator delete(void* memory, std::size_t) noexcept {
    std::free(memory);
}

namespace roevo {
namespace {

using testing::backAndForth;
using testing::Sequence;

OdometryOptions withThreads() {
    OdometryOptions options = testing::manyKeyframes();
    options.threads = 2;
    return options;
}

/// With a gap in the middle, after which the camera is recognised.
Sequence withGap() {
    Sequence path = backAndForth(70);
    for (std::size_t i = 40; i < path.frames.size(); ++i) path.frames[i].timestamp += 2;
    return path;
}

class LackOfResources : public ::testing::Test {
  protected:
    LackOfResources() { cv::setNumThreads(1); }
    ~LackOfResources() override {
        no_threads = false;
        left_in_this_thread = left_in_other_threads = -1;
    }
    const testing::ThreadsRestored restored_;  // OpenCV's threads do not survive it
};

TEST_F(LackOfResources, WhereNoThreadCanBeStartedTheWorkIsDoneInTheCallers) {
    const Sequence path = withGap();
    const auto run = [&](bool starts) {
        Odometry odometry(path.camera, withThreads(), path.start());
        no_threads = !starts;
        std::vector<FrameResult> results;
        for (const RgbdFrame& frame : path.frames) results.push_back(odometry.processFrame(frame));
        no_threads = false;
        return results;
    };
    const std::vector<FrameResult> usual = run(true), without = run(false);
    EXPECT_GT(refused_threads, 0);
    EXPECT_NE(usual[40].reason, "") << "nothing was looked up";
    for (std::size_t i = 0; i < usual.size(); ++i) {
        EXPECT_EQ(without[i].reason, usual[i].reason) << i;
        EXPECT_EQ(without[i].T_world_camera.matrix(), usual[i].T_world_camera.matrix()) << i;
    }
}

/// What is left of an odometry after a frame that threw.
void expectBrokenForGood(Odometry& odometry, const Sequence& path, std::size_t processed) {
    for (std::size_t i = processed; i < processed + 3; ++i)
        EXPECT_THROW((void)odometry.processFrame(path.frames[i]), std::bad_alloc) << i;
    std::ostringstream map;
    EXPECT_THROW(odometry.saveMap(map), std::bad_alloc);
    EXPECT_THROW(odometry.refineAll(), std::bad_alloc);
    EXPECT_THROW((void)odometry.map(), std::bad_alloc);
    EXPECT_THROW((void)odometry.keyframeEdges(), std::bad_alloc);
    (void)odometry.semiDense();
    EXPECT_GE(odometry.trajectory().size() + 1, processed);
    EXPECT_FALSE(odometry.keyframes().empty());
    for (const StampedPose& pose : odometry.trajectory()) EXPECT_TRUE(pose.T_world_camera.isFinite());
}

TEST_F(LackOfResources, MemoryThatRunsOutInAThreadEndsTheOdometryNotTheProgram) {
    const Sequence path = withGap();
    for (const int more : {0, 30, 300}) {
        SCOPED_TRACE(more);
        Odometry odometry(path.camera, withThreads(), path.start());
        std::size_t processed = 0;
        try {
            for (; processed < 60; ++processed) {
                if (processed == 20) left_in_other_threads = more;
                (void)odometry.processFrame(path.frames[processed]);
            }
        } catch (const std::bad_alloc&) {
        }
        left_in_other_threads = -1;
        ASSERT_LT(processed, 60u) << "nothing ran out";
        expectBrokenForGood(odometry, path, processed);
    }
}

TEST_F(LackOfResources, AMapperThatFailedIsHeardOfLiveToo) {
    const Sequence path = backAndForth(70);
    OdometryOptions options = withThreads();
    options.mapping.deterministic = false;
    options.mapping.close_loops = options.loss.recognise = false;  // so that no other thread allocates
    Odometry odometry(path.camera, options, path.start());
    bool threw = false;
    for (std::size_t i = 0; i < path.frames.size() && !threw; ++i) {
        if (i == 20) left_in_other_threads = 0;
        try {
            (void)odometry.processFrame(path.frames[i]);
        } catch (const std::bad_alloc&) {
            threw = true;
            EXPECT_GE(i, 20u);
        }
        std::this_thread::sleep_for(std::chrono::milliseconds(10));  // in which the map is worked on
    }
    EXPECT_TRUE(threw);
}

/// Whether the frame that follows some threw.
bool throwsAfter(int allocations, Odometry& odometry, const Sequence& path, std::size_t processed) {
    PreparedFrame next = odometry.prepareFrame(path.frames[processed]);
    bool threw = false;
    try {
        left_in_this_thread = allocations;
        (void)odometry.processFrame(std::move(next));
    } catch (const std::bad_alloc&) {
        threw = true;
    }
    left_in_this_thread = -1;
    return threw;
}

TEST_F(LackOfResources, AFrameThatMemoryIsTooShortForEndsTheOdometryNotTheProgram) {
    const Sequence path = withGap();
    std::size_t keyframe = 6;  // of which most is made
    {
        Odometry odometry(path.camera, withThreads(), path.start());
        for (std::size_t i = 0; i < keyframe; ++i) (void)odometry.processFrame(path.frames[i]);
        while (!odometry.processFrame(path.frames[keyframe]).new_keyframe) ++keyframe;
    }
    for (const int threads : {1, 2}) {
        OdometryOptions options = withThreads();
        options.threads = threads;
        int enough = 0;
        for (bool threw = true; threw; enough += 1 + enough / 8) {
            SCOPED_TRACE(enough);
            Odometry odometry(path.camera, options, path.start());
            for (std::size_t i = 0; i < keyframe; ++i) (void)odometry.processFrame(path.frames[i]);
            threw = throwsAfter(enough, odometry, path, keyframe);
            if (threw) expectBrokenForGood(odometry, path, keyframe + 1);
        }
        EXPECT_GT(enough, 100);
    }
}

}  // namespace
}  // namespace roevo
