// The same recording gives the same bytes, on whatever processor: a short demo by its checksums. They hold
// for Debian 12's compiler and libraries (others may round otherwise), whatever the machine: our loops give
// the same bytes with AVX2 and without (test_core_tracking, test_core_edges), those of OpenCV and of the C
// library as well. A change of the method changes the values for the trajectory: where that was meant, put in
// what is said here.
#include <gnu/libc-version.h>
#include <gtest/gtest.h>
#include <sched.h>

#include <Eigen/Core>
#include <cstdlib>
#include <opencv2/core/version.hpp>

#include "support/environment.h"
#include "support/run_program.h"

namespace roevo {
namespace {

using test::readFile;
using test::runProgram;

constexpr char kRecording[] = "53c4974eeec5163c", kTrajectory[] = "155586ac20f4fca4";

/// FNV-1a, as 16 digits.
std::string checksum(const std::string& bytes) {
    std::uint64_t sum = 0xCBF29CE484222325U;
    for (const char byte : bytes) sum = (sum ^ static_cast<unsigned char>(byte)) * 0x100000001B3U;
    char text[17];
    std::snprintf(text, sizeof text, "%016llx", static_cast<unsigned long long>(sum));
    return text;
}

/// As on a single processor that lacks what newer ones have.
class OldMachine {
  public:
    OldMachine() {
        sched_getaffinity(0, sizeof before_, &before_);
        cpu_set_t one;
        CPU_ZERO(&one);
        CPU_SET(sched_getcpu(), &one);
        sched_setaffinity(0, sizeof one, &one);
    }
    ~OldMachine() { sched_setaffinity(0, sizeof before_, &before_); }
    OldMachine(const OldMachine&) = delete;
    OldMachine& operator=(const OldMachine&) = delete;

  private:
    cpu_set_t before_{};
    test::WithEnvironment libc_{"GLIBC_TUNABLES",
                                "glibc.cpu.hwcaps=-AVX2,-FMA,-AVX,-AVX2_Usable,-FMA_Usable,-AVX_Usable"};
    test::WithEnvironment opencv_{"OPENCV_CPU_DISABLE", "AVX2,FMA3,AVX,FP16,SSSE3"};
};

bool isDebian12() {
    return __GNUC__ == 12 && std::string(gnu_get_libc_version()) == "2.36" &&
           std::string(CV_VERSION) == "4.6.0" && EIGEN_WORLD_VERSION == 3 && EIGEN_MAJOR_VERSION == 4;
}

TEST(SameBytes, AShortDemoHasItsChecksumOnAnyMachine) {
#if !defined(__x86_64__) || defined(__AVX__)
    GTEST_SKIP() << "the checksums are those of x86-64 in its common form";
#endif
    if (!isDebian12()) GTEST_SKIP() << "the checksums are those of Debian 12's compiler and libraries";
    const test::TemporaryFolder folder;
    const std::string rawlog = folder / "demo.rawlog";
    ASSERT_EQ(runProgram("rawlog-simulate",
                         {"--scene", "livingroom", "--frames", "16", "--size", "320x240", "--output", rawlog})
                  .exit_code,
              0);
    EXPECT_EQ(checksum(readFile(rawlog)), kRecording);
    const auto track = [&](const std::string& name) {
        const auto result =
            runProgram("roevo-odometry", {"--input", rawlog, "--output", folder / name, "--quiet", "--set",
                                          "keyframe.max_translation=0.03"});
        EXPECT_EQ(result.exit_code, 0) << result.all();
        return readFile(folder / (name + "/trajectory.txt")) +
               readFile(folder / (name + "/trajectory_live.txt"));
    };
    const std::string usual = track("usual");
    EXPECT_EQ(checksum(usual), kTrajectory);
    const OldMachine machine;
    EXPECT_TRUE(track("old_machine") == usual);
}

}  // namespace
}  // namespace roevo
