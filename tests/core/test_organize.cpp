// Properties of organized edges on random masks and on images.
#include <gtest/gtest.h>

#include <cmath>
#include <opencv2/imgproc.hpp>
#include <set>

#include "core/support/analytic_image.h"
#include "core/support/edge_masks.h"
#include "edges/edge_extractor.h"

namespace roevo {
namespace {

/// A gradient that turns slowly over the image, with some noise.
Gradient turningGradient(std::mt19937& random, const cv::Size& size, double noise_deg) {
    Gradient gradient = testing::evenGradient(size);
    std::normal_distribution<double> noise(0, 1);
    for (int y = 0; y < size.height; ++y) {
        for (int x = 0; x < size.width; ++x) {
            const double angle = 0.03 * x + 0.05 * y + noise_deg * CV_PI / 180 * noise(random);
            const double gx = std::round(400 * std::cos(angle)), gy = std::round(400 * std::sin(angle));
            gradient.gx.at<std::int16_t>(y, x) = static_cast<std::int16_t>(gx);
            gradient.gy.at<std::int16_t>(y, x) = static_cast<std::int16_t>(gy);
            gradient.magnitude.at<float>(y, x) = static_cast<float>(std::hypot(gx, gy));
        }
    }
    return gradient;
}

void expectWellFormed(const OrganizedEdges& edges, int min_length, double angle_deg) {
    ASSERT_EQ(edges.begin.front(), 0);
    ASSERT_EQ(edges.begin.back(), static_cast<int>(edges.size()));
    for (const auto* array : {&edges.y, &edges.gradient_x, &edges.gradient_y, &edges.strength}) {
        ASSERT_EQ(array->size(), edges.size());
    }
    ASSERT_EQ(edges.edge_of.size(), edges.size());
    const double min_cosine = std::cos((angle_deg + 0.01) * CV_PI / 180);
    for (int e = 0; e < edges.numEdges(); ++e) {
        const auto first = static_cast<std::size_t>(edges.begin[static_cast<std::size_t>(e)]);
        const auto end = static_cast<std::size_t>(edges.begin[static_cast<std::size_t>(e) + 1]);
        ASSERT_GE(end - first, static_cast<std::size_t>(min_length));
        for (std::size_t i = first; i < end; ++i) {
            EXPECT_EQ(edges.edge_of[i], e);
            EXPECT_NEAR(std::hypot(edges.gradient_x[i], edges.gradient_y[i]), 1, 1e-5);
            EXPECT_GT(edges.strength[i], 0);
            if (i == first) continue;
            // 8-neighbours, each at most half a pixel off along each axis
            EXPECT_LE(std::abs(edges.x[i] - edges.x[i - 1]), 2.001F);
            EXPECT_LE(std::abs(edges.y[i] - edges.y[i - 1]), 2.001F);
            EXPECT_GE(
                edges.gradient_x[i] * edges.gradient_x[i - 1] + edges.gradient_y[i] * edges.gradient_y[i - 1],
                min_cosine);
        }
    }
}

TEST(Organize, EdgesOfRandomMasksAreOrderedChains) {
    std::mt19937 random(31);
    EdgeOrganizer organizer;
    OrganizedEdges edges;
    int found = 0;
    for (const double share : {0.1, 0.2, 0.3, 0.5, 0.9}) {
        for (const double noise : {0.0, 8.0}) {
            for (int repeat = 0; repeat < 10; ++repeat) {
                EdgeMask mask = testing::randomMask(random, 70, 60, share);
                adjustAdjacency(mask);
                const Gradient gradient = turningGradient(random, mask.mask.size(), noise);
                organizer.organize(gradient, mask, 20, 4, edges);
                expectWellFormed(edges, 4, 20);
                found += edges.numEdges();
            }
        }
    }
    EXPECT_GT(found, 1000);
}

TEST(Organize, NoPixelIsUsedTwiceAndAllAreOfTheMask) {
    std::mt19937 random(32);
    EdgeOrganizer organizer;
    OrganizedEdges edges;
    for (int repeat = 0; repeat < 50; ++repeat) {
        EdgeMask mask = testing::randomMask(random, 64, 64, 0.25);
        adjustAdjacency(mask);
        const Gradient gradient = testing::evenGradient(mask.mask.size());  // no sub-pixel offsets
        organizer.organize(gradient, mask, 20, 3, edges);
        std::set<std::pair<float, float>> used;
        for (std::size_t i = 0; i < edges.size(); ++i) {
            EXPECT_TRUE(used.insert({edges.x[i], edges.y[i]}).second);
            EXPECT_EQ(mask.mask.at<std::uint8_t>(static_cast<int>(edges.y[i]), static_cast<int>(edges.x[i])),
                      1);
        }
    }
}

cv::Mat shapes() {
    return testing::renderGrey(
        200, 160,
        [](double x, double y) {
            double level = 60;
            if (x > 20.4 && x < 90.2 && y > 25.7 && y < 80.1) level = 190;
            if (std::hypot(x - 140.3, y - 60.8) < 30.5) level = 130;
            if (y - 0.4 * x > 75.2) level = 200;
            return level;
        },
        6);
}

TEST(Organize, IsTheSameOnASecondCall) {
    EdgeOptions options;
    EdgeExtractor extractor(options);
    OrganizedEdges first, second;
    EdgeMask mask;
    extractor.extract(shapes(), first, mask);
    extractor.extract(shapes(), second, mask);
    ASSERT_GT(first.numEdges(), 3);
    EXPECT_EQ(first.x, second.x);
    EXPECT_EQ(first.y, second.y);
    EXPECT_EQ(first.begin, second.begin);
    EXPECT_EQ(first.normal_x, second.normal_x);
    expectWellFormed(first, options.min_length, options.angle_deg);
}

/// Share of the points of `a` that have one of `b` within half a pixel.
double shareFound(const OrganizedEdges& a, const OrganizedEdges& b) {
    std::size_t found = 0;
    for (std::size_t i = 0; i < a.size(); ++i) {
        for (std::size_t j = 0; j < b.size(); ++j) {
            if (std::hypot(a.x[i] - b.x[j], a.y[i] - b.y[j]) < 0.5F) {
                ++found;
                break;
            }
        }
    }
    return static_cast<double>(found) / static_cast<double>(a.size());
}

TEST(Organize, BrightnessAndContrastHardlyMatter) {
    const cv::Mat image = shapes();
    OrganizedEdges plain;
    EdgeMask mask;
    EdgeExtractor(EdgeOptions()).extract(image, plain, mask);
    for (const auto& [gain, offset] : {std::pair(0.5, 0.0), {0.5, 100.0}, {1.0, 50.0}, {1.2, 0.0}}) {
        cv::Mat changed;
        image.convertTo(changed, CV_8U, gain, offset);
        OrganizedEdges edges;
        EdgeExtractor(EdgeOptions()).extract(changed, edges, mask);
        EXPECT_GT(shareFound(plain, edges), 0.95) << gain << " " << offset;
        EXPECT_GT(shareFound(edges, plain), 0.95) << gain << " " << offset;
    }
}

TEST(Organize, StrengthIsGreyLevelsPerPixel) {
    const cv::Mat image = testing::renderGrey(60, 60, [](double x, double) {
        return std::clamp(100 + 12 * (x - 30), 40.0,
                          160.0);  // a ramp of 12 levels per pixel, ten pixels wide
    });
    OrganizedEdges edges;
    EdgeOptions options;
    options.min_high_threshold = 16;
    options.canny_factor = 0.5;
    EdgeMask mask;
    EdgeExtractor(options).extract(image, edges, mask);
    for (const float strength : edges.strength) EXPECT_NEAR(strength, 12, 0.8);
}

TEST(Organize, KeepsNothingOfTheImageBefore) {
    cv::Mat faint;
    shapes().convertTo(faint, CV_8U, 0.4, 80);
    OrganizedEdges alone, after;
    EdgeMask mask;
    EdgeExtractor(EdgeOptions()).extract(faint, alone, mask);
    EdgeExtractor extractor{EdgeOptions()};
    for (const cv::Mat& before : {shapes(), cv::Mat(cv::Mat::zeros(120, 160, CV_8UC1))}) {
        extractor.extract(before, after, mask);
        extractor.extract(faint, after, mask);
        EXPECT_EQ(after.x, alone.x);
        EXPECT_EQ(after.y, alone.y);
        EXPECT_EQ(after.begin, alone.begin);
    }
    EXPECT_GT(alone.numEdges(), 3);
}

TEST(Organize, ABlackImageHasNoEdges) {
    OrganizedEdges edges;
    EdgeMask mask;
    EdgeExtractor extractor{EdgeOptions()};
    extractor.extract(cv::Mat::zeros(120, 160, CV_8UC1), edges, mask);
    EXPECT_TRUE(mask.pixels.empty());
    EXPECT_EQ(edges.numEdges(), 0);
    EXPECT_EQ(edges.size(), 0U);
}

}  // namespace
}  // namespace roevo
