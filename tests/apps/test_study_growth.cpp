// Time and memory against the size of the images, the number of edges and the length of the recording.
#include "study_fixture.h"
#include "study_source.h"

namespace roevo {
namespace {

using test::sliding;

using StudyGrowth = test::StudyFolder;

TEST_F(StudyGrowth, ImagesAndCameraChangeTogether) {
    testing::Sequence sequence = sliding(1);
    sequence.camera.cx = 150;
    RgbdFrame& frame = sequence.frames[0];
    frame.mask = cv::Mat(240, 320, CV_8U, cv::Scalar(255));
    frame.depth = cv::Mat(240, 320, CV_32F, cv::Scalar(2));
    frame.depth.colRange(0, 100) = 1.0;
    const cv::Mat before = frame.grey.clone();
    const StudyInput memory = input("slides", sequence, true);
    for (const double factor : {0.5, 1.5, 2.0}) {
        const auto source = resized(memory.open(), factor);
        const PinholeCamera& camera = source->camera();
        SourceFrame seen;
        ASSERT_TRUE(source->next(seen));
        const cv::Size size(static_cast<int>(320 * factor), static_cast<int>(240 * factor));
        EXPECT_EQ(cv::Size(camera.width, camera.height), size);
        for (const cv::Mat& image : {seen.frame.grey, seen.frame.depth, seen.frame.mask})
            EXPECT_EQ(image.size(), size) << factor;
        EXPECT_TRUE(seen.frame.colour.empty()) << "there was none";
        // What is seen at the border of depths is in the same direction as before
        const auto direction = [](const PinholeCamera& c, double u) { return (u - c.cx) / c.fx; };
        EXPECT_NEAR(direction(camera, 100 * factor - 0.5), direction(sequence.camera, 99.5), 1e-12) << factor;
        const int border = static_cast<int>(100 * factor);
        EXPECT_EQ(seen.frame.depth.at<float>(5, border - 1), 1);
        EXPECT_EQ(seen.frame.depth.at<float>(5, border), 2) << "no depth lies between the two";
        EXPECT_FALSE(source->next(seen));
    }
    EXPECT_EQ(cv::norm(frame.grey, before, cv::NORM_INF), 0) << "the recording itself stays as it was";
}

TEST_F(StudyGrowth, EverySizeIsARowAndEveryFrameAsRecorded) {
    const testing::Sequence sequence = sliding(45);
    const StudyReport report =
        studyGrowth({input("slides", sequence, true), lostInput("gone", sequence)}, folder());
    const auto sizes = table("growth_sizes.csv"), frames = table("growth_frames.csv");
    ASSERT_EQ(sizes.size(), 1u + 6);
    std::size_t recorded = 0;
    double points = 0;
    for (std::size_t row = 1; row < sizes.size(); ++row) {
        SCOPED_TRACE(sizes[row][1]);
        EXPECT_EQ(sizes[row][3], "45");
        EXPECT_EQ(sizes[row][4], "45") << "all are tracked";
        EXPECT_GT(std::stod(sizes[row][6]), points) << "more pixels, more points";
        points = std::stod(sizes[row][6]);
        EXPECT_GT(std::stod(sizes[row][7]), 0);
        EXPECT_GE(std::stod(sizes[row][8]), std::stod(sizes[row][7])) << "95 % are not below the median";
        EXPECT_LT(std::stod(sizes[row][11]), 0.01);
        if (sizes[row][1] == "320") recorded = row;
    }
#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)  // they have allocators of their own
    EXPECT_GT(std::stod(sizes[6][10]), 2 * std::stod(sizes[1][10])) << "MB; 36 times the pixels";
    EXPECT_GT(std::stod(sizes[1][10]), 0);
#endif
    ASSERT_GT(recorded, 0u) << "the size it was recorded with is one of them";
    ASSERT_EQ(frames.size(), 1u + 45);
    EXPECT_EQ(frames[45][3], sizes[recorded][5]) << "keyframes";
    EXPECT_TRUE(exists("growth_size.svg") && exists("growth_edges.svg") && exists("growth_length.svg"))
        << report.plot_fault;
    EXPECT_NE(report.table.find("| slides | 960 x 720 |"), std::string::npos) << report.table;
    ASSERT_EQ(report.left_out.size(), 1u);
    EXPECT_EQ(report.left_out[0].name, "gone");
}

}  // namespace
}  // namespace roevo
