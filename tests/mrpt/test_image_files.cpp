// Image files that are not whole: one error, and not a word from the libraries that decode them.
#include <gtest/gtest.h>

#include <opencv2/imgcodecs.hpp>

#include "mrpt/synthetic_scan.h"
#include "mrpt/test_helpers.h"
#include "roevo_mrpt/image_conversions.h"
#include "support/images.h"

namespace roevo {
namespace {

using test::errorOf;
using test::readFile;
using test::same;
using test::TemporaryFolder;
using test::writeFile;

class ImageFiles : public ::testing::Test {
  protected:
    ImageFiles() {
        cv::imwrite(folder_ / "depth.png", test::patternDepth(test::smallCamera(), 1));
        cv::imwrite(folder_ / "colour.png", test::patternColour(test::smallCamera(), 1));
        cv::imwrite(folder_ / "colour.jpg", test::patternColour(test::smallCamera(), 1));
        cv::imwrite(folder_ / "progressive.jpg", test::patternColour(test::smallCamera(), 1),
                    {cv::IMWRITE_JPEG_PROGRESSIVE, 1, cv::IMWRITE_JPEG_RST_INTERVAL, 2});
    }

    void SetUp() override { ::testing::internal::CaptureStderr(); }
    void TearDown() override { EXPECT_EQ(::testing::internal::GetCapturedStderr(), ""); }

    /// What reading a file with these bytes throws.
    std::string fault(const std::string& bytes) {
        writeFile(folder_ / "spoilt", bytes);
        return errorOf([&] { readColourFile(folder_ / "spoilt"); });
    }

    TemporaryFolder folder_;
};

TEST_F(ImageFiles, WholeOnesAreDecodedAsOpenCvDoes) {
    for (const char* name : {"colour.png", "colour.jpg", "progressive.jpg"}) {
        const cv::Mat expected = cv::imread(folder_ / name, cv::IMREAD_ANYCOLOR);
        EXPECT_TRUE(same(readColourFile(folder_ / name), expected)) << name;
        EXPECT_EQ(fault(readFile(folder_ / name) + "bytes after the image"), "") << name;
    }
    EXPECT_TRUE(same(readDepthFile(folder_ / "depth.png"), test::patternDepth(test::smallCamera(), 1)));
}

TEST_F(ImageFiles, TruncatedAnywhere) {
    for (const char* name : {"depth.png", "colour.png", "colour.jpg", "progressive.jpg"}) {
        const std::string whole = readFile(folder_ / name);
        for (std::size_t kept = 1; kept < whole.size(); kept += kept < 100 ? 1 : 97)
            ASSERT_EQ(fault(whole.substr(0, kept)), "cannot decode image (truncated after " +
                                                        std::to_string(kept) +
                                                        " bytes): " + (folder_ / "spoilt"))
                << name;
        EXPECT_NE(fault(whole.substr(0, whole.size() - 1)), "") << name;
    }
    EXPECT_EQ(fault(""), "cannot decode image (empty file): " + (folder_ / "spoilt"));
}

TEST_F(ImageFiles, AFlippedBitInAPng) {
    const std::string whole = readFile(folder_ / "depth.png");
    for (std::size_t at = 8; at < whole.size(); at += at < 60 ? 1 : 37) {
        std::string spoilt = whole;
        spoilt[at] = static_cast<char>(spoilt[at] ^ 0x10);
        EXPECT_EQ(fault(spoilt).rfind("cannot decode image (", 0), 0u) << "byte " << at;
    }
}

// A decoder makes pixels of whatever is there: OpenCV's picture of such a file moved a trajectory by 2 cm
TEST_F(ImageFiles, BytesOverwrittenInAJpeg) {
    constexpr std::size_t kOverwritten = 40;
    for (const char* name : {"colour.jpg", "progressive.jpg"}) {
        const std::string whole = readFile(folder_ / name);
        for (std::size_t at = whole.size() / 3; at + kOverwritten < whole.size(); at += 61) {
            std::string spoilt = whole;
            for (std::size_t i = 0; i < kOverwritten; ++i)
                spoilt[at + i] = static_cast<char>((37 * (at + i) + i * i) % 251);
            EXPECT_EQ(fault(spoilt).rfind("cannot decode image (", 0), 0u) << name << ", byte " << at;
        }
    }
}

TEST_F(ImageFiles, ACameraMayPadItsJpegs) {
    std::string padded = readFile(folder_ / "colour.jpg");
    padded.insert(padded.size() - 2, 2, '\0');  // before "end of image"
    EXPECT_EQ(fault(padded), "");
    (void)::testing::internal::GetCapturedStderr();  // OpenCV may warn of it
    ::testing::internal::CaptureStderr();
}

TEST_F(ImageFiles, OtherFiles) {
    EXPECT_EQ(fault("no image at all"),
              "cannot decode image (damaged or not an image): " + (folder_ / "spoilt"));
    EXPECT_EQ(fault("\xff\xd8 no JPEG"),
              "cannot decode image (damaged or not an image): " + (folder_ / "spoilt"));
}

}  // namespace
}  // namespace roevo
