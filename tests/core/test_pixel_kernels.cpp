// The loops over pixels: baseline and AVX2 give the same bytes, and both what plain loops and OpenCV give.
#include <gtest/gtest.h>

#include <cmath>
#include <opencv2/imgproc.hpp>
#include <random>

#include "camera/undistorter.h"
#include "core/support/kernel_tables.h"
#include "edges/gradient.h"

namespace roevo {
namespace {

cv::Mat noise(int width, int height, int levels = 256) {
    cv::Mat image(height, width, CV_8UC1);
    std::mt19937 random(5);
    for (int i = 0; i < width * height; ++i)
        image.data[i] = static_cast<std::uint8_t>(random() % static_cast<unsigned>(levels) * 255U /
                                                  static_cast<unsigned>(levels - 1));
    return image;
}

cv::Mat checkerboard(int width, int height) {
    cv::Mat image(height, width, CV_8UC1);
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) image.at<std::uint8_t>(y, x) = (x + y) % 2 == 0 ? 0 : 255;
    return image;
}

Gradient plainGradient(const cv::Mat& image) {
    Gradient plain;
    cv::Sobel(image, plain.gx, CV_16S, 1, 0, 3, 1, 0, cv::BORDER_REPLICATE);
    cv::Sobel(image, plain.gy, CV_16S, 0, 1, 3, 1, 0, cv::BORDER_REPLICATE);
    plain.magnitude.create(image.size(), CV_32FC1);
    for (int y = 0; y < image.rows; ++y)
        for (int x = 0; x < image.cols; ++x) {
            const double gx = plain.gx.at<std::int16_t>(y, x), gy = plain.gy.at<std::int16_t>(y, x);
            plain.magnitude.at<float>(y, x) = static_cast<float>(std::sqrt(gx * gx + gy * gy));
        }
    return plain;
}

TEST(PixelKernels, GradientIsSobelsInAllWidths) {
    for (const int width : {32, 33, 39, 47, 64, 101}) {
        const cv::Mat image = noise(width, 3);
        const Gradient plain = plainGradient(image);
        for (const auto* table : tables()) {
            std::vector<std::int16_t> gx(static_cast<std::size_t>(width)), gy(gx);
            std::vector<float> magnitude(gx.size());
            table->gradient(image.ptr(0), image.ptr(1), image.ptr(2), width, gx.data(), gy.data(),
                            magnitude.data());
            for (int x = 0; x < width; ++x) {
                const auto i = static_cast<std::size_t>(x);
                ASSERT_EQ(gx[i], plain.gx.at<std::int16_t>(1, x)) << table->name << ' ' << width << ' ' << x;
                ASSERT_EQ(gy[i], plain.gy.at<std::int16_t>(1, x)) << table->name << ' ' << width << ' ' << x;
                ASSERT_EQ(magnitude[i], plain.magnitude.at<float>(1, x)) << table->name << ' ' << x;
            }
        }
    }
}

/// A ridge by interpolation with divisions, in double precision: between the two neighbours that the line
/// along the gradient passes. @return 0 or 1; 2 where rounding may decide either way
int plainRidge(const Gradient& g, int x, int y, double low) {
    const int gx = g.gx.at<std::int16_t>(y, x), gy = g.gy.at<std::int16_t>(y, x);
    const auto at = [&](int dx, int dy) {
        return static_cast<double>(g.magnitude.at<float>(y + dy, x + dx));
    };
    const double here = at(0, 0);
    if (here < low) return 0;
    const int sx = gx >= 0 ? 1 : -1, sy = gy >= 0 ? 1 : -1;
    const bool by_column = std::abs(gx) >= std::abs(gy);
    const double share = by_column ? std::abs(gy) / static_cast<double>(std::abs(gx))
                                   : std::abs(gx) / static_cast<double>(std::abs(gy));
    const auto along = [&](int sign) {
        const double side = by_column ? at(sign * sx, 0) : at(0, sign * sy);
        return side + share * (at(sign * sx, sign * sy) - side);
    };
    const double after = along(1), before = along(-1);
    const bool exact = share == 0 || share == 1;
    if (!exact && std::min(std::abs(here - after), std::abs(here - before)) < 1e-5 * here) return 2;
    return here > before && here >= after ? 1 : 0;
}

TEST(PixelKernels, RidgesAreThoseOfPlainInterpolation) {
    const int width = 111, height = 60;
    for (const cv::Mat& image :
         {noise(width, height), noise(width, height, 3), checkerboard(width, height)}) {
        const Gradient g = plainGradient(image);
        const auto stride = static_cast<std::ptrdiff_t>(g.magnitude.step1());
        for (const float low : {0.5F, 200.F, 2000.F}) {
            int found = 0;
            for (int y = 4; y < height - 4; ++y) {
                for (const int count : {1, 7, 8, 37, 63, 64}) {
                    std::vector<std::uint64_t> bits;
                    const float high = 1.5F * low;
                    for (const auto* table : tables()) {
                        const auto ridges = table->ridges(g.magnitude.ptr<float>(y) + 4, stride,
                                                          g.gx.ptr<std::int16_t>(y) + 4,
                                                          g.gy.ptr<std::int16_t>(y) + 4, count, low, high);
                        bits.push_back(ridges.all);
                        for (int i = 0; i < 64; ++i) {
                            const bool strong =
                                (ridges.all >> i & 1) != 0 && g.magnitude.at<float>(y, 4 + i) >= high;
                            ASSERT_EQ(ridges.strong >> i & 1, strong ? 1U : 0U) << i << ' ' << y;
                        }
                    }
                    ASSERT_EQ(bits.front(), bits.back());
                    for (int i = 0; i < 64; ++i) {
                        const int bit = static_cast<int>(bits[0] >> i & 1);
                        const int plain = i < count ? plainRidge(g, 4 + i, y, static_cast<double>(low)) : 0;
                        if (plain != 2) {
                            ASSERT_EQ(bit, plain) << i << ' ' << y << ' ' << count;
                        }
                        found += bit;
                    }
                }
            }
            if (low == 2000.F) {
                EXPECT_EQ(found, 0) << "no gradient is as strong as that";
            }
        }
    }
}

TEST(PixelKernels, RemapReadsWhatItShouldAndNothingElse) {
    const int width = 37, height = 23;
    // On its own on the heap, so that a sanitizer sees what is read beside it
    const cv::Mat pixels = noise(width, height);
    const std::vector<std::uint8_t> image(pixels.datastart, pixels.dataend);
    std::mt19937 random(8);
    for (const int count : {1, 7, 8, 9, 100}) {
        std::vector<std::int32_t> offset;
        std::vector<std::int16_t> fraction;
        for (int i = 0; i < count; ++i) {
            const int x = static_cast<int>(random() % (width - 1)),
                      y = static_cast<int>(random() % (height - 1));
            offset.push_back(i == 0 ? (height - 2) * width + width - 2 : y * width + x);
            const int right = i == 0 ? 32 : static_cast<int>(random() % 33);
            const int down = i == 0 ? 32 : static_cast<int>(random() % 33);
            fraction.push_back(static_cast<std::int16_t>(right + 256 * down));
        }
        fraction.resize(fraction.size() + kernels::kRemapPadding);
        offset.resize(fraction.size());
        for (const auto* table : tables()) {
            std::vector<std::uint8_t> out(static_cast<std::size_t>(count));
            table->remap(image.data(), image.data() + image.size(), width, {offset.data(), fraction.data()},
                         count, out.data());
            for (std::size_t i = 0; i < out.size(); ++i) {
                const auto* p = &image[static_cast<std::size_t>(offset[i])];
                const double fx = fraction[i] % 256 / 32.0, fy = fraction[i] / 256 / 32.0;
                const double plain =
                    (1 - fy) * ((1 - fx) * p[0] + fx * p[1]) + fy * ((1 - fx) * p[width] + fx * p[width + 1]);
                ASSERT_EQ(out[i], static_cast<int>(std::floor(plain + 0.5))) << table->name << ' ' << i;
            }
        }
    }
}

TEST(PixelKernels, UndistortedImageIsOpenCvs) {
    // Strong enough that the corners of the ideal image lie outside the real one
    const PinholeCamera camera{160, 120, 130, 129, 79, 61, {0.3, -0.9, -0.005, 0.03, 1.2}};
    cv::Mat map(camera.height, camera.width, CV_32FC2), places, fractions, expected, buffer;
    int outside = 0;
    for (int v = 0; v < camera.height; ++v)
        for (int u = 0; u < camera.width; ++u) {
            const Eigen::Vector2d p = camera.distortPixel(Eigen::Vector2d(u, v));
            map.at<cv::Vec2f>(v, u) = cv::Vec2f(static_cast<float>(p.x()), static_cast<float>(p.y()));
            if (p.x() < 0 || p.y() < 0 || p.x() > camera.width - 1 || p.y() > camera.height - 1) ++outside;
        }
    EXPECT_GT(outside, 100);
    cv::convertMaps(map, cv::noArray(), places, fractions, CV_16SC2);
    const cv::Mat image = noise(camera.width, camera.height);
    cv::remap(image, expected, places, fractions, cv::INTER_LINEAR, cv::BORDER_REPLICATE);
    const Undistorter undistorter(camera);
    EXPECT_EQ(cv::norm(undistorter.apply(image, buffer), expected, cv::NORM_INF), 0);
    cv::Mat wide(camera.height, camera.width + 9, CV_8UC1);  // rows that are not next to each other
    image.copyTo(wide.colRange(5, 5 + camera.width));
    EXPECT_EQ(cv::norm(undistorter.apply(wide.colRange(5, 5 + camera.width), buffer), expected, cv::NORM_INF),
              0);
}

}  // namespace
}  // namespace roevo
