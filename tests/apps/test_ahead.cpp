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
    if (hasSecondProcessor()) {
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

}  // namespace
}  // namespace roevo
