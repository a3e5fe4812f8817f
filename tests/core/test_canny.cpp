// Canny against analytic edges and against OpenCV's.
#include <gtest/gtest.h>

#include <opencv2/imgproc.hpp>
#include <random>

#include "core/support/analytic_image.h"
#include "edges/canny.h"
#include "kernels/kernels.h"

namespace roevo {
namespace {

struct Detected {
    Gradient gradient;
    EdgeMask edges;
    std::vector<cv::Point2f> points;
};

/// From an edge pixel to the ridge of the gradient's magnitude, px.
cv::Point2f subpixelOffset(const Gradient& gradient, int x, int y) {
    const std::int32_t pixel = y * gradient.magnitude.cols + x;
    if (gradient.gx.at<std::int16_t>(y, x) == 0 && gradient.gy.at<std::int16_t>(y, x) == 0) return {0, 0};
    cv::Point2f point;
    float gradient_x, gradient_y, strength;
    kernels::best().refine(gradient.view(), &pixel, 1,
                           {&point.x, &point.y, &gradient_x, &gradient_y, &strength});
    return point - cv::Point2f(static_cast<float>(x), static_cast<float>(y));
}

Detected detect(const cv::Mat& image, double low, double high, double blur = 0) {
    Detected result;
    computeGradient(image, blur, result.gradient);
    canny(result.gradient, {low, high}, result.edges);
    for (const auto p : result.edges.pixels) {
        const int x = p % image.cols, y = p / image.cols;
        result.points.push_back(cv::Point2f(static_cast<float>(x), static_cast<float>(y)) +
                                subpixelOffset(result.gradient, x, y));
    }
    return result;
}

struct Errors {
    double mean = 0, root_mean_square = 0, worst = 0;
};

/// Errors of the signed distances from the analytic edge.
template <class Distance>
Errors errorsOf(const std::vector<cv::Point2f>& points, Distance&& distance) {
    Errors errors;
    for (const auto& p : points) {
        const double d = distance(static_cast<double>(p.x), static_cast<double>(p.y));
        errors.mean += d / static_cast<double>(points.size());
        errors.root_mean_square += d * d / static_cast<double>(points.size());
        errors.worst = std::max(errors.worst, std::abs(d));
    }
    errors.root_mean_square = std::sqrt(errors.root_mean_square);
    return errors;
}

TEST(Canny, UprightStepIsFoundWhereItIs) {
    for (const double where : {40.0, 40.2, 40.35, 40.5, 40.65, 40.8}) {
        const cv::Mat image = testing::renderGrey(
            80, 60, [&](double x, double) { return x < where ? 60.0 : 190.0; }, 40);
        const Detected found = detect(image, 60, 120);
        EXPECT_EQ(found.points.size(), 52U) << "one pixel in each row within the border, at " << where;
        const Errors errors = errorsOf(found.points, [&](double x, double) { return x - where; });
        EXPECT_LT(errors.worst, 0.1) << where;
    }
}

/// Worst root mean square over all directions of a step seen through a lens with a Gaussian blur of `sigma`
/// px.
Errors worstOverDirections(double sigma) {
    Errors worst;
    for (int degrees = 0; degrees < 360; degrees += 17) {
        const double angle = degrees * CV_PI / 180, nx = std::cos(angle), ny = std::sin(angle);
        const auto distance = [&](double x, double y) { return nx * (x - 50.3) + ny * (y - 49.6); };
        const auto level = [&](double x, double y) {
            const double d = distance(x, y);
            return sigma > 0 ? 120 + 80 * std::erf(d / sigma / std::sqrt(2.0)) : (d < 0 ? 40.0 : 200.0);
        };
        // 20 samples per pixel put the step at 50.3 exactly
        const Detected found = detect(testing::renderGrey(100, 100, level, 20), 60, 120);
        EXPECT_GE(found.points.size(), 88U) << degrees;
        const Errors errors = errorsOf(found.points, distance);
        worst.root_mean_square = std::max(worst.root_mean_square, errors.root_mean_square);
        worst.mean = std::max(worst.mean, std::abs(errors.mean));
        worst.worst = std::max(worst.worst, errors.worst);
    }
    return worst;
}

TEST(Canny, StepOfAnyDirectionThroughALensIsFoundWithinAFifteenthOfAPixel) {
    const Errors errors = worstOverDirections(1.0);
    EXPECT_LT(errors.root_mean_square, 0.045);
    EXPECT_LT(errors.mean, 0.015);
    EXPECT_LT(errors.worst, 0.08);
}

TEST(Canny, StepWithNoBlurButThePixelsIsFoundNearlyAsWell) {
    const Errors errors = worstOverDirections(0);
    EXPECT_LT(errors.root_mean_square, 0.08);  // a diagonal is the worst: three samples 1.4 px apart
    EXPECT_LT(errors.mean, 0.05);
    EXPECT_LT(errors.worst, 0.12);
}

TEST(Canny, RimOfADiscIsFoundWithinATenthOfAPixel) {
    for (const double radius : {12.0, 25.3, 40.7}) {
        const cv::Mat image = testing::renderGrey(
            120, 120,
            [&](double x, double y) { return std::hypot(x - 60.2, y - 59.7) < radius ? 180.0 : 50.0; }, 12);
        const Detected found = detect(image, 60, 120);
        EXPECT_GE(found.points.size(), static_cast<std::size_t>(5.4 * radius)) << radius;
        const Errors errors = errorsOf(
            found.points, [&](double x, double y) { return std::hypot(x - 60.2, y - 59.7) - radius; });
        EXPECT_LT(errors.root_mean_square, 0.065) << radius;
        EXPECT_LT(std::abs(errors.mean), 0.041) << radius;
    }
}

TEST(Canny, AgreesWithOpenCvOnShapesWithNoise) {
    cv::Mat image(240, 320, CV_8UC1, cv::Scalar(90));
    cv::rectangle(image, {40, 30, 90, 70}, 200, cv::FILLED);
    cv::circle(image, {220, 90}, 45, 30, cv::FILLED, cv::LINE_AA);
    cv::ellipse(image, {120, 180}, {60, 25}, 30, 0, 360, 150, cv::FILLED, cv::LINE_AA);
    cv::line(image, {180, 220}, {300, 150}, 220, 6, cv::LINE_AA);
    cv::Mat noise(image.size(), CV_16SC1), noisy;
    cv::theRNG().state = 11;
    cv::randn(noise, 0, 6);
    cv::add(image, noise, noisy, cv::noArray(), CV_8U);
    cv::GaussianBlur(noisy, noisy, {5, 5}, 1);

    // In one thread: how TBB hands over memory in OpenCV's Canny, ThreadSanitizer cannot see and calls a race
    const int usual_threads = cv::getNumThreads();
    cv::setNumThreads(1);
    for (const double high : {60.0, 120.0, 200.0}) {
        const Detected ours = detect(noisy, high / 2, high);
        cv::Mat theirs;
        cv::Canny(noisy, theirs, high / 2, high, 3, true);
        theirs = theirs / 255;
        cv::Mat inside = cv::Mat::zeros(theirs.size(), CV_8UC1);
        constexpr int b = EdgeMask::kBorder;
        inside(cv::Rect(b, b, 320 - 2 * b, 240 - 2 * b)).setTo(1);
        theirs = theirs.mul(inside);
        const auto shareNear = [](const cv::Mat& of, const cv::Mat& in) {
            cv::Mat wide;
            cv::dilate(in, wide, cv::Mat::ones(3, 3, CV_8U));
            return static_cast<double>(cv::countNonZero(of.mul(wide))) / cv::countNonZero(of);
        };
        EXPECT_GT(shareNear(theirs, ours.edges.mask), 0.95) << high;
        EXPECT_GT(shareNear(ours.edges.mask, theirs), 0.95) << high;
        EXPECT_NEAR(static_cast<double>(ours.edges.pixels.size()) / cv::countNonZero(theirs), 1, 0.1) << high;
    }
    cv::setNumThreads(usual_threads);
}

TEST(Canny, HysteresisKeepsWeakPixelsOnlyWhereAStrongOneReachesThem) {
    // Two upright steps; the left one fades below the high threshold half way down, the right one is weak all
    // along
    const cv::Mat image = testing::renderGrey(100, 80, [](double x, double y) {
        const double left = x > 30 ? std::clamp(70 - y, 20.0, 40.0) : 0.0;
        return 50 + left + (x > 70 ? 20.0 : 0.0);
    });
    const Detected found = detect(image, 40, 120);  // 40 levels give 160, 20 levels give 80
    int left_weak = 0, right = 0;
    for (const auto& p : found.points) {
        if (p.x < 40 && p.y > 52) ++left_weak;
        if (p.x > 60) ++right;
    }
    EXPECT_GT(left_weak, 20);
    EXPECT_EQ(right, 0);
}

TEST(Canny, MaskAndPixelsSayTheSameInRasterOrderAndKeepOffTheBorder) {
    cv::Mat noise(57, 83, CV_8UC1);
    cv::theRNG().state = 12;
    cv::randu(noise, 0, 256);
    const Detected found = detect(noise, 100, 300);
    ASSERT_FALSE(found.edges.pixels.empty());
    EXPECT_TRUE(std::is_sorted(found.edges.pixels.begin(), found.edges.pixels.end()));
    EXPECT_EQ(static_cast<int>(found.edges.pixels.size()), cv::countNonZero(found.edges.mask));
    double largest = 0;
    cv::minMaxLoc(found.edges.mask, nullptr, &largest);
    EXPECT_EQ(largest, 1);
    constexpr int b = EdgeMask::kBorder;
    EXPECT_EQ(cv::countNonZero(found.edges.mask(cv::Rect(b, b, 83 - 2 * b, 57 - 2 * b))),
              cv::countNonZero(found.edges.mask));
    for (const auto p : found.edges.pixels) EXPECT_EQ(found.edges.mask.at<std::uint8_t>(p / 83, p % 83), 1);
}

TEST(Canny, FlatAndTinyImagesHaveNoEdges) {
    EXPECT_TRUE(detect(cv::Mat(60, 60, CV_8UC1, cv::Scalar(128)), 10, 20).points.empty());
    EXPECT_TRUE(detect(cv::Mat(8, 8, CV_8UC1, cv::Scalar(128)), 10, 20).points.empty());
}

TEST(Canny, SubpixelOffsetStaysWithinHalfAPixelOnNoise) {
    cv::Mat noise(60, 60, CV_8UC1);
    cv::theRNG().state = 13;
    cv::randu(noise, 0, 256);
    Gradient gradient;
    computeGradient(noise, 0, gradient);
    for (int y = 1; y < 59; ++y) {
        for (int x = 1; x < 59; ++x) {
            const cv::Point2f offset = subpixelOffset(gradient, x, y);
            EXPECT_LE(std::abs(offset.x), 0.5F);
            EXPECT_LE(std::abs(offset.y), 0.5F);
        }
    }
}

}  // namespace
}  // namespace roevo
