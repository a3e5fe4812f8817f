// The loops over pixels and points of edges, baseline and AVX2: the same bytes, and what plain loops in
// double precision give.
#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <cstring>
#include <opencv2/imgproc.hpp>
#include <random>

#include "core/support/kernel_tables.h"
#include "edges/gradient.h"
#include "edges/organized_edges.h"
#include "nearest.h"

namespace roevo {
namespace {

using Floats = std::vector<float>;

cv::Mat smoothNoise(int width, int height, unsigned seed) {
    cv::Mat image(height, width, CV_8UC1), smooth;
    cv::theRNG().state = seed;
    cv::randu(image, 0, 256);
    cv::GaussianBlur(image, smooth, {5, 5}, 1.2);
    return smooth;
}

TEST(EdgeKernels, HalvedImageIsOpenCvs) {
    for (const int width : {2, 30, 32, 34, 126, 640}) {
        const cv::Mat image = smoothNoise(width, 6, 3);
        cv::Mat expected;
        cv::resize(image, expected, {width / 2, 3}, 0, 0, cv::INTER_AREA);
        for (const auto* table : tables()) {
            cv::Mat half(3, width / 2, CV_8UC1);
            for (int y = 0; y < 3; ++y)
                table->halve(image.ptr(2 * y), image.ptr(2 * y + 1), width / 2, half.ptr(y));
            EXPECT_EQ(cv::norm(half, expected, cv::NORM_INF), 0) << table->name << ' ' << width;
        }
    }
}

/// What the kernel should give for one pixel, with logarithms in double precision.
Eigen::Vector2d plainRidge(const Gradient& g, int x, int y) {
    const auto at = [&](double px, double py) {  // one of both is whole
        const int ix = static_cast<int>(std::floor(px)), iy = static_cast<int>(std::floor(py));
        const double fx = px - ix, fy = py - iy;
        const auto m = [&](int dx, int dy) {
            return static_cast<double>(g.magnitude.at<float>(iy + dy, ix + dx));
        };
        return (1 - fx) * (1 - fy) * m(0, 0) + (fx > 0 ? fx * m(1, 0) : 0) + (fy > 0 ? fy * m(0, 1) : 0);
    };
    const double gx = g.gx.at<std::int16_t>(y, x), gy = g.gy.at<std::int16_t>(y, x);
    const bool by_column = std::abs(gx) >= std::abs(gy);
    const Eigen::Vector2d step(by_column ? 1 : gx / gy, by_column ? gy / gx : 1);
    const double floor = 0.33 * at(x, y);
    const double before = std::log(at(x - step.x(), y - step.y()) + floor), here = std::log(at(x, y) + floor),
                 after = std::log(at(x + step.x(), y + step.y()) + floor);
    const double curvature = before - 2 * here + after;
    return Eigen::Vector2d(x, y) + std::clamp((before - after) / 2 / curvature, -0.5, 0.5) * step;
}

TEST(EdgeKernels, PixelsMoveToTheRidge) {
    Gradient g;
    computeGradient(smoothNoise(161, 93, 5), 0, g);
    std::vector<std::int32_t> ridges;
    for (int y = 4; y < 89; ++y) {
        const auto stride = static_cast<std::ptrdiff_t>(g.magnitude.step1());
        const auto found =
            kernels::baseline().ridges(g.magnitude.ptr<float>(y) + 60, stride, g.gx.ptr<std::int16_t>(y) + 60,
                                       g.gy.ptr<std::int16_t>(y) + 60, 64, 30, 30);
        for (int i = 0; i < 64; ++i)
            if ((found.all >> i & 1) != 0) ridges.push_back(y * 161 + 60 + i);
    }
    ASSERT_GT(ridges.size(), 200U);
    for (const std::size_t count : {std::size_t{1}, std::size_t{8}, std::size_t{13}, ridges.size()}) {
        std::vector<Floats> bytes;
        for (const auto* table : tables()) {
            Floats all(5 * count + 1, 77);  // the last one is to stay
            float* p = all.data();
            table->refine(g.view(), ridges.data(), count,
                          {p, p + count, p + 2 * count, p + 3 * count, p + 4 * count});
            EXPECT_EQ(all.back(), 77) << "written past the last point";
            for (std::size_t i = 0; i < count; ++i) {
                const int x = ridges[i] % 161, y = ridges[i] / 161;
                const Eigen::Vector2d plain = plainRidge(g, x, y);
                const float magnitude = g.magnitude.at<float>(y, x);
                EXPECT_NEAR(static_cast<double>(p[i]), plain.x(), 1e-4) << table->name << ' ' << i;
                EXPECT_NEAR(static_cast<double>(p[count + i]), plain.y(), 1e-4) << table->name << ' ' << i;
                EXPECT_EQ(p[2 * count + i], g.gx.at<std::int16_t>(y, x) / magnitude);
                EXPECT_EQ(p[3 * count + i], g.gy.at<std::int16_t>(y, x) / magnitude);
                EXPECT_EQ(p[4 * count + i], magnitude / 8);
            }
            bytes.push_back(all);
        }
        EXPECT_EQ(std::memcmp(bytes.front().data(), bytes.back().data(), 20 * count), 0);
    }
}

TEST(EdgeKernels, RowsOfLargeImagesAreNotMistaken) {
    // Where a row begins and ends is found by a division in single precision
    Gradient g;
    const cv::Size size(1921, 1083);
    g.gx = cv::Mat(size, CV_16SC1, cv::Scalar(100));
    g.gy = cv::Mat(size, CV_16SC1, cv::Scalar(0));
    g.magnitude = cv::Mat(size, CV_32FC1, cv::Scalar(100));
    for (const auto* table : tables()) {
        for (int y = 1; y < size.height - 1; ++y) {
            const std::int32_t ends[2] = {y * size.width + 1, y * size.width + size.width - 2};
            float x[2], found_y[2], rest[6];
            table->refine(g.view(), ends, 2, {x, found_y, rest, rest + 2, rest + 4});
            ASSERT_EQ(x[0], 1) << y;
            ASSERT_EQ(x[1], static_cast<float>(size.width - 2)) << y;
            ASSERT_EQ(found_y[0], static_cast<float>(y));
            ASSERT_EQ(found_y[1], static_cast<float>(y));
        }
    }
}

/// Unit normal to a chord (u, v) on the side of a gradient, Eqs. (4)-(6); the gradient where it has no
/// length.
std::pair<float, float> plainNormal(float u, float v, float gradient_x, float gradient_y) {
    const float length = std::sqrt(u * u + v * v);
    if (!(length > 0)) return {gradient_x, gradient_y};
    const float x = -v / length, y = u / length;
    return x * gradient_x + y * gradient_y < 0 ? std::pair(-x, -y) : std::pair(x, y);
}

TEST(EdgeKernels, NormalsAreOnTheSideOfTheGradient) {
    std::mt19937 random(4);
    std::normal_distribution<float> normal(0, 3);
    for (const std::size_t count : {std::size_t{1}, std::size_t{8}, std::size_t{21}}) {
        Floats u(count), v(count), gx(count), gy(count);
        for (auto* array : {&u, &v, &gx, &gy})
            for (float& value : *array) value = normal(random);
        u[0] = v[0] = 0;  // a chord without length
        for (const auto* table : tables()) {
            Floats nx = u, ny = v;  // in place
            table->normals(nx.data(), ny.data(), gx.data(), gy.data(), count, nx.data(), ny.data());
            for (std::size_t i = 0; i < count; ++i) {
                const auto [x, y] = plainNormal(u[i], v[i], gx[i], gy[i]);
                EXPECT_EQ(nx[i], x) << table->name << ' ' << i;
                EXPECT_EQ(ny[i], y) << table->name << ' ' << i;
            }
        }
    }
}

/// What depthPatch() finds, the same by every table.
kernels::DepthPatch patchOf(const Floats& depth, std::ptrdiff_t stride, int size,
                            const kernels::DepthLimits& limits, double u, double v) {
    Floats columns, rows;
    for (int k = 0; k < 8; ++k) {
        columns.push_back(static_cast<float>(k - size / 2));
        rows.push_back(2 * columns.back());
    }
    std::vector<kernels::DepthPatch> found;
    for (const auto* table : tables()) {
        found.emplace_back();
        table->depthPatch({depth.data(), stride, size, columns.data(), rows.data()}, limits,
                          static_cast<float>(u), static_cast<float>(v), found.back());
        EXPECT_EQ(std::memcmp(&found.front(), &found.back(), sizeof found.front()), 0) << table->name;
    }
    return found.front();
}

TEST(EdgeKernels, PlaneOfInverseDepthsIsTheLeastSquaresOne) {
    constexpr int kStride = 11;
    constexpr kernels::DepthLimits kLimits{0.2F, 9, 1.5F, 1};
    std::mt19937 random(6);
    std::uniform_real_distribution<double> unit(0, 1);
    int planes = 0;
    for (int repeat = 0; repeat < 400; ++repeat) {
        const int size = repeat % 2 == 0 ? 5 : 7;
        const double missing = repeat % 5 == 0 ? 0.7 : 0.15;
        Floats depth(kStride * 8, 0);
        const double base = 0.3 + unit(random), a = 0.002 * (unit(random) - 0.5),
                     b = 0.002 * (unit(random) - 0.5);
        const double u = unit(random) - 0.5, v = unit(random) - 0.5;
        Eigen::MatrixX3d A(0, 3);
        Eigen::VectorXd q(0);
        for (int y = 0; y < 8; ++y) {
            for (int x = 0; x < 8; ++x) {
                float& z = depth[static_cast<std::size_t>(y * kStride + x)];
                z = static_cast<float>(1 / (base + a * x + b * y + 0.0005 * unit(random)));
                if (unit(random) < missing) z = repeat % 3 == 0 ? 20.0F : (repeat % 3 == 1 ? 0.0F : NAN);
                if (x >= size || y >= size || !(z >= kLimits.near && z <= kLimits.far)) continue;
                A.conservativeResize(A.rows() + 1, 3);
                q.conservativeResize(q.rows() + 1);
                A.bottomRows(1) << 1, x - size / 2 - u, 2 * (y - size / 2) - v;
                q.tail(1) << 1 / static_cast<double>(z);
            }
        }
        const kernels::DepthPatch found = patchOf(depth, kStride, size, kLimits, u, v);
        ASSERT_EQ(found.count, A.rows());
        if (A.rows() == 0) continue;
        EXPECT_NEAR(found.nearest, 1 / q.maxCoeff(), 1e-5);
        EXPECT_NEAR(found.farthest, 1 / q.minCoeff(), 1e-5);
        const Eigen::Vector3d plane = A.colPivHouseholderQr().solve(q);
        const double inverse = found.inverse;
        if (A.rows() >= 15) {
            EXPECT_NEAR(inverse, plane[0], 1e-6) << repeat;
            ++planes;
        } else if (A.rows() < 6) {
            EXPECT_NEAR(inverse, q.mean(), 1e-6) << repeat;
        }
    }
    EXPECT_GT(planes, 200);
}

TEST(EdgeKernels, TheNearestSurfaceIsThatOfTheSortedDepths) {
    constexpr kernels::DepthLimits kLimits{0.2F, 9, 1.03F, 3};
    std::mt19937 random(8);
    std::uniform_real_distribution<float> unit(0, 1);
    int several = 0, speckled = 0, none = 0;
    for (int repeat = 0; repeat < 2000; ++repeat) {
        Floats depth(8 * 8), sorted;
        const int surfaces = 1 + repeat % 6;
        for (std::size_t i = 0; i < depth.size(); ++i) {
            const auto which =
                static_cast<float>(static_cast<int>(unit(random) * static_cast<float>(surfaces)));
            depth[i] = unit(random) < 0.8F * static_cast<float>(repeat % 3) / 2 ? 0.0F
                       : unit(random) < 0.04F                                   ? 0.3F + 8 * unit(random)
                                              : (1 + 0.12F * which) * (1 + 0.05F * unit(random));
            if (i % 8 < 5 && i / 8 < 5 && depth[i] > 0) sorted.push_back(depth[i]);
        }
        std::sort(sorted.begin(), sorted.end());
        std::size_t begin = 0, end = 0;
        for (; end < sorted.size(); ++end) {
            if (end == 0 || sorted[end] <= sorted[end - 1] * kLimits.jump) continue;
            if (end - begin >= 3) break;
            begin = end;
        }
        const kernels::DepthPatch found = patchOf(depth, 8, 5, kLimits, 0, 0);
        if (end - begin < 3) {
            ++none;
            EXPECT_EQ(found.count, 0);
            continue;
        }
        several += end < sorted.size() ? 1 : 0;
        speckled += begin > 0 ? 1 : 0;
        EXPECT_EQ(found.count, static_cast<int>(end - begin)) << repeat;
        EXPECT_EQ(found.nearest, sorted[begin]);
        EXPECT_EQ(found.farthest, sorted[end - 1]);
        if (found.count >= 6) continue;
        float mean = 0;
        for (std::size_t i = begin; i < end; ++i) mean += 1 / sorted[i] / static_cast<float>(found.count);
        EXPECT_NEAR(found.inverse, mean, 1e-6F);
    }
    EXPECT_GT(several, 500);
    EXPECT_GT(speckled, 200);
    EXPECT_GT(none, 20);
}

/// What side() should add: pixel by pixel.
kernels::SideSums plainSide(const cv::Mat& depth, const kernels::EdgePoint& at,
                            const kernels::SideReach& reach) {
    kernels::SideSums sums;
    const Eigen::Vector2d point(at.x, at.y), normal(at.normal_x, at.normal_y);
    const int main = reach.by_column ? 0 : 1;
    const double outwards = reach.along ? 1 : -1;
    const int least = reach.steps - 4 * ((reach.steps + 3) / 4);  // columns are taken by fours
    for (int y = 0; y < depth.rows; ++y) {
        for (int x = 0; x < depth.cols; ++x) {
            const Eigen::Vector2d p(x, y);
            const double away = p[main] - point[main];
            const double line = point[1 - main] + away * normal[1 - main] / normal[main];
            const double share = 1 - std::abs(p[1 - main] - line),
                         distance = outwards * normal.dot(p - point);
            const float z = depth.at<float>(y, x);
            const double column = (normal[main] > 0 ? outwards : -outwards) * (p[main] - reach.centre);
            if (column <= least || column > reach.steps || share <= 0 || distance < reach.clear ||
                !(z > 0 && std::isfinite(z)))
                continue;
            sums.seen += share;
            if (z - at.depth > reach.jump * at.depth) sums.behind += share;
            const double s = distance, q = static_cast<double>(at.depth / z) - 1;
            const double widened = reach.widening > 0 ? 1 + s / reach.widening : 1;
            if (std::abs(z - at.depth) > static_cast<float>(widened) * reach.jump * at.depth) continue;
            const double more[] = {share, share * s, share * q, share * s * s, share * s * q, share * q * q};
            double* const targets[] = {&sums.count, &sums.s, &sums.q, &sums.ss, &sums.sq, &sums.qq};
            for (int k = 0; k < 6; ++k) *targets[k] += more[k];
        }
    }
    return sums;
}

TEST(EdgeKernels, OneSideIsSummedPixelByPixel) {
    std::mt19937 random(7);
    std::uniform_real_distribution<double> unit(0, 1);
    cv::Mat depth(23, 31, CV_32FC1);
    double seen = 0, behind = 0, own = 0;
    for (int repeat = 0; repeat < 2000; ++repeat) {
        for (int y = 0; y < depth.rows; ++y) {
            for (int x = 0; x < depth.cols; ++x) {
                const double kind = unit(random);
                depth.at<float>(y, x) = kind < 0.05   ? 0.0F
                                        : kind < 0.07 ? NAN
                                        : kind < 0.09
                                            ? INFINITY
                                            : static_cast<float>((x > 15 ? 2.0 : 2.2) + 0.1 * unit(random));
            }
        }
        const double angle = repeat % 8 == 0 ? M_PI_2 * (repeat % 4) : 2 * M_PI * unit(random);
        const kernels::EdgePoint at{31 * unit(random), 23 * unit(random), std::cos(angle), std::sin(angle),
                                    static_cast<float>(2 + 0.1 * unit(random))};
        const bool by_column = std::abs(at.normal_x) >= std::abs(at.normal_y);
        const kernels::SideReach reach{by_column,
                                       nearestInteger(by_column ? at.x : at.y),
                                       1 + repeat / 2 % 9,
                                       repeat % 2 == 0,
                                       0.6,
                                       0.03F,
                                       repeat % 3 == 0 ? 4.0 : 0.0};
        const kernels::SideSums expected = plainSide(depth, at, reach);
        std::vector<kernels::SideSums> found;
        for (const auto* table : tables()) {
            found.emplace_back();
            table->side({depth.ptr<float>(), 31, 31, 23}, at, reach, found.back());
            EXPECT_EQ(std::memcmp(&found.front(), &found.back(), sizeof found.front()), 0) << table->name;
        }
        const double *plain = &expected.count, *sums = &found.front().count;
        // A weight is the rest to a whole row: as exact as a row's number is in single precision
        const double far = 12, scale[] = {1, far, 1, far * far, far, 1, 1, 1};
        for (int k = 0; k < 8; ++k)
            EXPECT_NEAR(sums[k], plain[k], 2e-6 * (scale[k] + std::abs(plain[k]))) << repeat << ' ' << k;
        seen += expected.seen;
        behind += expected.behind;
        own += expected.count;
    }
    EXPECT_GT(behind, 0.2 * seen);
    EXPECT_GT(own, 0.2 * seen);
}

}  // namespace
}  // namespace roevo
