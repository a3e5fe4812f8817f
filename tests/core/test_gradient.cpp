// Sobel gradient of a ramp; Otsu's threshold.
#include <gtest/gtest.h>

#include <opencv2/imgproc.hpp>
#include <random>

#include "core/support/analytic_image.h"
#include "edges/gradient.h"

namespace roevo {
namespace {

TEST(Gradient, RampHasEightPerGreyLevel) {
    for (const double blur : {0.0, 0.8}) {
        const cv::Mat ramp = testing::renderGrey(
            60, 50, [](double x, double y) { return 5 + 2 * x + 1 * y; }, 2);
        Gradient gradient;
        computeGradient(ramp, blur, gradient);
        for (int y = 6; y < 44; ++y) {
            for (int x = 6; x < 54; ++x) {
                EXPECT_NEAR(gradient.gx.at<std::int16_t>(y, x), 16, blur > 0 ? 4 : 0);
                EXPECT_NEAR(gradient.gy.at<std::int16_t>(y, x), 8, blur > 0 ? 4 : 0);
                const float expected = std::hypot(static_cast<float>(gradient.gx.at<std::int16_t>(y, x)),
                                                  static_cast<float>(gradient.gy.at<std::int16_t>(y, x)));
                EXPECT_NEAR(gradient.magnitude.at<float>(y, x), expected, 1e-4);
            }
        }
    }
}

TEST(Gradient, IsOpenCvsSobelOnNoise) {
    cv::Mat noise(40, 70, CV_8UC1);
    cv::theRNG().state = 7;
    cv::randu(noise, 0, 256);
    Gradient gradient;
    computeGradient(noise, 0, gradient);
    cv::Mat gx, gy;
    cv::Sobel(noise, gx, CV_16S, 1, 0, 3, 1, 0, cv::BORDER_REPLICATE);
    cv::Sobel(noise, gy, CV_16S, 0, 1, 3, 1, 0, cv::BORDER_REPLICATE);
    EXPECT_EQ(cv::norm(gradient.gx, gx, cv::NORM_INF), 0);
    EXPECT_EQ(cv::norm(gradient.gy, gy, cv::NORM_INF), 0);
}

TEST(Gradient, BlurWeakensAStep) {
    cv::Mat step(40, 40, CV_8UC1, cv::Scalar(0));
    step.colRange(20, 40).setTo(200);
    Gradient sharp, soft;
    computeGradient(step, 0, sharp);
    computeGradient(step, 1.5, soft);
    EXPECT_EQ(sharp.magnitude.at<float>(20, 20), 800);
    EXPECT_LT(soft.magnitude.at<float>(20, 20), 600);
    EXPECT_EQ(soft.blurred.at<std::uint8_t>(20, 2), 0);
}

TEST(Otsu, SeparatesTwoClasses) {
    cv::Mat magnitude(64, 64, CV_32FC1);
    std::mt19937 random(3);
    for (int y = 0; y < 64; ++y) {
        for (int x = 0; x < 64; ++x) {
            const bool strong = (x / 2 + y / 2) % 4 == 0;
            magnitude.at<float>(y, x) =
                std::normal_distribution<float>(strong ? 400.0F : 30.0F, strong ? 20.0F : 5.0F)(random);
        }
    }
    const double threshold = otsuThreshold(magnitude);
    EXPECT_GT(threshold, 44);   // 30 + 2.8 sigma
    EXPECT_LT(threshold, 330);  // 400 - 3.5 sigma
}

TEST(Otsu, OfTheRootsIsTheBestOfAllThresholdsByDefinition) {
    std::mt19937 random(4);
    cv::Mat magnitude(80, 80, CV_32FC1);
    for (int y = 0; y < 80; ++y) {
        for (int x = 0; x < 80; ++x) {
            magnitude.at<float>(y, x) =
                std::min(1440.0F, std::exponential_distribution<float>(1.0F / 120)(random));
        }
    }
    const auto variance = [&](double threshold) {  // between the classes, over the same subsample
        double n[2] = {0, 0}, sum[2] = {0, 0};
        for (int y = 0; y < 80; y += 2) {
            for (int x = 0; x < 80; x += 2) {
                const double m = magnitude.at<float>(y, x);
                n[m >= threshold] += 1;
                sum[m >= threshold] += std::sqrt(m);
            }
        }
        if (n[0] == 0 || n[1] == 0) return 0.0;
        const double difference = sum[0] / n[0] - sum[1] / n[1];
        return n[0] * n[1] * difference * difference;
    };
    const double found = variance(otsuThreshold(magnitude));
    for (double threshold = 4; threshold < 1440; threshold += 4)
        EXPECT_LE(variance(threshold), 1.002 * found);
}

TEST(Otsu, FlatAndSaturatedImagesGiveAFiniteThreshold) {
    EXPECT_TRUE(std::isfinite(otsuThreshold(cv::Mat::zeros(32, 32, CV_32FC1))));
    EXPECT_TRUE(std::isfinite(otsuThreshold(cv::Mat(32, 32, CV_32FC1, cv::Scalar(1442.5)))));
}

}  // namespace
}  // namespace roevo
