#include <gtest/gtest.h>

/// As GoogleTest's own, but that a program in which something was skipped, and nothing failed, ends with 77.
int main(int argc, char** argv) {
    constexpr int kSkipped = 77;  // SKIP_RETURN_CODE of its ctest entry
    ::testing::InitGoogleTest(&argc, argv);
    const int failed = RUN_ALL_TESTS();
    if (failed != 0) return failed;
    return ::testing::UnitTest::GetInstance()->skipped_test_count() > 0 ? kSkipped : 0;
}
