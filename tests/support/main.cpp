#include <gtest/gtest.h>

#include <cstdio>
#include <cstdlib>

/// As GoogleTest's own, but that a program ends with 77 where something was skipped and nothing failed, and
/// with 1 where there was nothing to run.
int main(int argc, char** argv) {
    constexpr int kSkipped = 77;  // SKIP_RETURN_CODE of its ctest entry
    ::testing::InitGoogleTest(&argc, argv);
    const int failed = RUN_ALL_TESTS();
    const ::testing::UnitTest& all = *::testing::UnitTest::GetInstance();
    if (failed == 0 && all.test_to_run_count() + all.reportable_disabled_test_count() == 0) {
        std::fprintf(stderr, "no test has such a name\n");
        return EXIT_FAILURE;
    }
    return failed == 0 && all.skipped_test_count() > 0 ? kSkipped : failed;
}
