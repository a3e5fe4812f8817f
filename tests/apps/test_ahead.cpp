#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <stdexcept>
#include <string>
#include <thread>

#include "programs/ahead.h"

namespace roevo {
namespace {

std::function<std::optional<int>()> countTo(int last, std::atomic<int>& made) {
    return [=, &made]() -> std::optional<int> {
        if (made == last) return std::nullopt;
        return ++made;
    };
}

TEST(Ahead, HandsOutEveryItemInOrderThenNothing) {
    std::atomic<int> made{0};
    Ahead<int> ahead(countTo(100, made));
    for (int i = 1; i <= 100; i++) EXPECT_EQ(ahead.next(), i);
    EXPECT_EQ(ahead.next(), std::nullopt);
    EXPECT_EQ(ahead.next(), std::nullopt);
    EXPECT_FALSE(ahead.isBusy());
}

TEST(Ahead, IsAFewItemsAheadAtMost) {
    std::atomic<int> made{0};
    Ahead<int> ahead(countTo(100, made));
    EXPECT_EQ(ahead.next(), 1);
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
    EXPECT_LE(made, 6) << "the one handed out, four in the queue, one in hand";
    if (threadCount(0) > 1) {
        EXPECT_GE(made, 5);
        EXPECT_TRUE(ahead.isBusy());
    }
}

TEST(Ahead, AFailureComesAfterTheItemsBeforeIt) {
    int made = 0;
    Ahead<int> ahead([&]() -> std::optional<int> {
        if (++made > 2) throw std::runtime_error("out of items");
        return made;
    });
    EXPECT_EQ(ahead.next(), 1);
    EXPECT_EQ(ahead.next(), 2);
    EXPECT_THROW(ahead.next(), std::runtime_error);
}

TEST(Ahead, BothStepsSeeEveryItemInOrderWithAnyNumberOfThreads) {
    for (const int threads : {1, 2, 3, 8}) {
        std::atomic<int> made{0}, in_step{0};
        int last = 0;
        bool together = false, out_of_order = false;
        Ahead<int> ahead(
            countTo(200, made),
            [&](int& item) {
                together = together || ++in_step > 1;
                out_of_order = out_of_order || item != last + 1;
                last = item;
                item *= 10;
                --in_step;
            },
            threads);
        for (int i = 1; i <= 200; i++) ASSERT_EQ(ahead.next(), 10 * i) << threads << " threads";
        EXPECT_EQ(ahead.next(), std::nullopt);
        EXPECT_FALSE(together || out_of_order) << threads << " threads";
        EXPECT_FALSE(ahead.isBusy());
    }
}

TEST(Ahead, OneThreadMakesNothingThatIsNotAskedFor) {
    std::atomic<int> made{0};
    const auto caller = std::this_thread::get_id();
    bool elsewhere = false;
    Ahead<int> ahead(
        countTo(100, made), [&](int&) { elsewhere = elsewhere || std::this_thread::get_id() != caller; }, 1);
    EXPECT_EQ(made, 0);
    EXPECT_EQ(ahead.next(), 1);
    EXPECT_EQ(ahead.next(), 2);
    EXPECT_EQ(made, 2);
    EXPECT_FALSE(elsewhere);
}

TEST(Ahead, WaitsForASlowCallerWithFewItems) {
    std::atomic<int> made{0}, finished{0};
    Ahead<int> ahead(
        countTo(100, made), [&](int&) { ++finished; }, 3);
    EXPECT_EQ(ahead.next(), 1);
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
    EXPECT_LE(finished, 3) << "the one handed out and two that wait";
    EXPECT_LE(made, 6) << "two more that wait and one in hand";
}

TEST(Ahead, TheFirstFailureOfEitherStepComesAfterTheItemsBeforeIt) {
    for (const int threads : {1, 2, 3}) {
        int made = 0;
        Ahead<int> ahead(
            [&]() -> std::optional<int> {
                if (++made > 4) throw std::runtime_error("made");
                return made;
            },
            [](int& item) {
                if (item == 3) throw std::logic_error("finished");
            },
            threads);
        EXPECT_EQ(ahead.next(), 1);
        EXPECT_EQ(ahead.next(), 2);
        EXPECT_THROW(ahead.next(), std::logic_error) << threads << " threads";
        EXPECT_EQ(ahead.next(), std::nullopt);
    }
}

}  // namespace
}  // namespace roevo
