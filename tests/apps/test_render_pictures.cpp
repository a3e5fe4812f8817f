// What roevo-render puts around the map, and where the camera is.
#include <cmath>
#include <filesystem>
#include <opencv2/videoio.hpp>

#include "render_fixture.h"

namespace roevo {
namespace {

using test::expectError;

constexpr char kRender[] = "roevo-render";
constexpr int kWidth = 800, kHeight = 600, kStrip = 60;  // px; the legend is in the strip

class RenderPictures : public test::RenderProgram {
  protected:
    cv::Mat draw(std::vector<std::string> more) const {
        more.insert(more.end(), {"--size", "800x600"});
        const auto result = render(more);
        EXPECT_EQ(result.exit_code, 0) << result.all();
        cv::Mat picture = cv::imread(folder_ / "room.png");
        EXPECT_EQ(picture.size(), cv::Size(kWidth, kHeight));
        return picture;
    }
};

std::size_t countOf(const cv::Mat& picture, const cv::Vec3b& bgr) {
    std::size_t count = 0;
    for (const auto& p : cv::Mat3b(picture)) count += p == bgr;
    return count;
}

TEST_F(RenderPictures, TheBackgroundIsExactlyWhatIsAskedFor) {
    const std::pair<const char*, cv::Vec3b> cases[] = {{"dark", {0x17, 0x11, 0x0e}},
                                                       {"white", {255, 255, 255}},
                                                       {"black", {0, 0, 0}},
                                                       {"#f4f1e8", {0xe8, 0xf1, 0xf4}}};
    for (const auto& [name, bgr] : cases) {
        const cv::Mat picture = draw({"--background", name, "--view", "top"});
        EXPECT_EQ(picture.at<cv::Vec3b>(0, 0), bgr) << name;
        EXPECT_EQ(picture.at<cv::Vec3b>(kHeight - 1, kWidth - 1), bgr) << name << ", below the legend";
        EXPECT_GT(countOf(picture, bgr), picture.total() / 2) << name;
    }
}

TEST_F(RenderPictures, TheViewFromAboveCutsNothingOff) {
    for (const bool legend : {true, false}) {
        const cv::Mat picture =
            draw(legend ? std::vector<std::string>{"--view", "top", "--background", "white"}
                        : std::vector<std::string>{"--view", "top", "--background", "white", "--no-legend"});
        for (const cv::Mat& border : {picture.row(0), picture.row(kHeight - 1), picture.col(0).clone(),
                                      picture.col(kWidth - 1).clone()})
            EXPECT_EQ(countOf(border, {255, 255, 255}), border.total()) << legend;
    }
}

TEST_F(RenderPictures, TheLegendNamesWhatIsThereAndNothingElse) {
    const cv::Vec3b trajectory(30, 60, 230), reference(60, 170, 40), keyframes(240, 110, 40);
    const cv::Rect strip(0, kHeight - kStrip, kWidth, kStrip);
    const cv::Mat with = draw({"--view", "iso"})(strip);
    EXPECT_GT(countOf(with, trajectory), 30u);
    EXPECT_GT(countOf(with, keyframes), 30u);
    EXPECT_EQ(countOf(with, reference), 0u) << "this scene has no ground truth";
    const cv::Mat without = draw({"--view", "iso", "--no-legend"})(strip);
    EXPECT_EQ(countOf(without, trajectory), 0u);
    EXPECT_EQ(countOf(without, keyframes), 0u);
}

// Length of the longest horizontal line of bright pixels.
int longestLine(const cv::Mat& picture) {
    int longest = 0;
    for (int y = 0; y < picture.rows; ++y)
        for (int x = 0, length = 0; x < picture.cols; ++x) {
            length = picture.at<cv::Vec3b>(y, x)[0] > 150 ? length + 1 : 0;
            longest = std::max(longest, length);
        }
    return longest;
}

TEST_F(RenderPictures, TheScaleBarIsOfARoundLength) {
    for (const std::string zoom : {"1", "0.6", "0.35"}) {
        const cv::Mat picture = draw({"--view", "top", "--background", "black", "--zoom", zoom});
        const cv::Rect room = brightBox(picture.rowRange(0, kHeight - kStrip));  // 4 m wide
        const int bar = longestLine(picture.rowRange(kHeight - kStrip / 2, kHeight));
        ASSERT_GT(bar, 30);
        const double metres = bar / (room.width / 4.0);
        const double digit = metres / std::pow(10, std::floor(std::log10(metres * 1.03)));
        const double off = std::min({std::abs(digit - 1), std::abs(digit / 2 - 1), std::abs(digit / 5 - 1)});
        EXPECT_LT(off, 0.03) << metres << " m at zoom " << zoom;
    }
}

TEST_F(RenderPictures, ZoomMagnifiesTheMiddle) {
    const auto width = [&](const char* zoom) {
        return brightBox(draw({"--view", "top", "--no-legend", "--zoom", zoom})).width;
    };
    EXPECT_NEAR(width("0.5"), width("1") / 2.0, 4);
}

// The brightest pixel near the picture's middle.
int brightnessInTheMiddle(const cv::Mat& picture) {
    double brightest = 0;
    cv::minMaxLoc(picture(cv::Rect(kWidth / 2 - 4, kHeight / 2 - 4, 8, 8)).clone().reshape(1), nullptr,
                  &brightest);
    return static_cast<int>(brightest);
}

TEST_F(RenderPictures, ThePointToLookAtIsInTheMiddle) {
    // An upper corner of the room, left and ahead; below it there is no line
    const auto middle = [&](std::vector<std::string> camera) {
        camera.insert(camera.end(), {"--no-legend"});
        return brightnessInTheMiddle(draw(camera));
    };
    for (const char* x : {"-1.5", "-0.5"}) {
        EXPECT_GT(middle({"--from", x, "-0.4", "0.5", "--look-at", "2", "2", "1.25"}), 120) << x;
        EXPECT_LT(middle({"--from", x, "-0.4", "0.5", "--look-at", "2", "2", "0.6"}), 60) << x;
    }
    for (const std::string view : {"iso", "front", "top"}) {
        EXPECT_GT(middle({"--view", view, "--look-at", "2", "2", "1.25"}), 120) << view;
        EXPECT_LT(middle({"--view", view, "--look-at", "3", "3", "1.25"}), 60) << view;
    }
}

TEST_F(RenderPictures, AMovieIsOneTurn) {
    const std::string file = folder_ / "room.mp4";
    const auto result = test::runProgram(kRender, {"--scene", folder_ / "room.3Dscene", "--output", file,
                                                   "--size", "200x150", "--seconds", "1"});
    if (result.all().find("no FFmpeg") != std::string::npos) GTEST_SKIP() << result.all();
    ASSERT_EQ(result.exit_code, 0) << result.all();
    cv::VideoCapture movie(file);
    std::vector<cv::Mat> pictures;
    for (cv::Mat picture; movie.read(picture);) pictures.push_back(picture.clone());
    ASSERT_EQ(pictures.size(), 30u);
    EXPECT_EQ(pictures[0].size(), cv::Size(200, 150));
    // The room's left edge is red, its right one green; half a turn later they have changed sides
    const auto redIsLeft = [&](std::size_t i) {
        double sum[2] = {0, 0}, count[2] = {0, 0};
        for (int y = 0; y < 150; ++y)
            for (int x = 0; x < 200; ++x) {
                const auto& p = pictures[i].at<cv::Vec3b>(y, x);
                for (const int c : {1, 2})
                    if (p[c] > 90 && p[c] > 2 * p[3 - c]) sum[c - 1] += x, ++count[c - 1];
            }
        EXPECT_GT(std::min(count[0], count[1]), 20) << i;
        return sum[1] / count[1] < sum[0] / count[0];
    };
    EXPECT_TRUE(redIsLeft(0));
    EXPECT_FALSE(redIsLeft(15));
    EXPECT_TRUE(redIsLeft(29)) << "the end goes on at the beginning";
}

TEST_F(RenderPictures, WrongCamerasAndColoursAreOneLine) {
    const auto refused = [&](const std::vector<std::string>& arguments,
                             const std::vector<std::string>& words) {
        expectError(render(arguments), 2, kRender, words);
    };
    refused({"--background", "#12345g"}, {"--background", "#12345g"});
    refused({"--background", "blue"}, {"--background", "blue"});
    refused({"--zoom", "0"}, {"--zoom", "0.1 to 100"});
    refused({"--zoom", "nan"}, {"--zoom", "nan"});
    refused({"--from", "1", "2", "3"}, {"--look-at"});
    refused({"--from", "1", "2", "3", "--look-at", "1", "2", "3"}, {"--from", "same point"});
    refused({"--from", "1", "2", "inf", "--look-at", "1", "2", "3"}, {"--from", "inf"});
    refused({"--view", "orbit"}, {"orbit", ".mp4"});
    refused({"--seconds", "3"}, {"--seconds", ".mp4"});
    const auto movie = [&](const std::vector<std::string>& more, const std::string& file) {
        std::vector<std::string> arguments{"--scene", folder_ / "room.3Dscene", "--output", file};
        arguments.insert(arguments.end(), more.begin(), more.end());
        return test::runProgram(kRender, arguments);
    };
    const std::string file = folder_ / "room.mp4";
    expectError(movie({"--view", "top"}, file), 2, kRender, {"top", "orbit"});
    expectError(movie({"--size", "201x150"}, file), 2, kRender, {"--size", "201x150", "even"});
    expectError(movie({"--seconds", "0"}, file), 2, kRender, {"--seconds"});
    expectError(movie({}, folder_ / "no/such/room.mp4"), 1, kRender, {"room.mp4"});
    EXPECT_FALSE(std::filesystem::exists(file));
}

}  // namespace
}  // namespace roevo
