// The hot loops: baseline and AVX2 give the same bytes, and both what plain double loops give.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>

#include "core/support/random_pose.h"
#include "kernels/kernels.h"

namespace roevo::kernels {
namespace {

using roevo::testing::uniform;

struct Points {
    std::vector<float> x, y, z;
};

Points randomPoints(std::mt19937& random, std::size_t n) {
    Points points;
    for (std::size_t i = 0; i < n; ++i) {
        points.x.push_back(static_cast<float>(uniform(random, -3, 3)));
        points.y.push_back(static_cast<float>(uniform(random, -2, 2)));
        points.z.push_back(static_cast<float>(uniform(random, -1, 6)));  // some lie behind the camera
    }
    return points;
}

Projection randomProjection(std::mt19937& random, bool rolling) {
    const Pose pose = roevo::testing::randomPose(random, 0.3, 0.3);
    Projection m{};
    for (int r = 0; r < 3; ++r) {
        for (int c = 0; c < 3; ++c) m.rotation[3 * r + c] = static_cast<float>(pose.linear()(r, c));
        m.translation[r] = static_cast<float>(pose.translation()[r]);
        m.rows.velocity[r] = rolling ? static_cast<float>(uniform(random, -5e-5, 5e-5)) : 0;
        m.rows.turn[r] = rolling ? static_cast<float>(uniform(random, -1e-4, 1e-4)) : 0;
    }
    m.fx = 517.3F;
    m.fy = 516.5F;
    m.cx = 318.6F;
    m.cy = 255.3F;
    m.rows.reference_row = 240;
    m.last_row = 479;
    return m;
}

struct Projected {
    std::vector<float> x, y, z, u, v;
};

Projected project(const Table& table, const Projection& m, const Points& p) {
    const std::size_t n = p.x.size();
    Projected out{std::vector<float>(n), std::vector<float>(n), std::vector<float>(n), std::vector<float>(n),
                  std::vector<float>(n)};
    table.project(m, p.x.data(), p.y.data(), p.z.data(), n,
                  {out.x.data(), out.y.data(), out.z.data(), out.u.data(), out.v.data()});
    return out;
}

template <class T>
bool sameBytes(const std::vector<T>& a, const std::vector<T>& b) {
    return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(T)) == 0;
}

struct PatchScene {
    std::vector<std::uint8_t> image;
    int width = 97, height = 71, stride = 101;
    std::vector<Patch> patches;
    std::vector<float> u, v, axis_x, axis_y;
    ImageView view() const { return {image.data(), stride, width, height}; }
};

PatchScene randomPatches(std::mt19937& random, std::size_t n) {
    PatchScene scene;
    scene.image.resize(static_cast<std::size_t>(scene.stride * scene.height));
    for (auto& pixel : scene.image) pixel = static_cast<std::uint8_t>(random() & 255U);
    for (std::size_t i = 0; i < n; ++i) {
        Patch patch{};
        for (int j = 0; j < kPatchSize; ++j) {
            patch.intensity[j] = static_cast<float>(uniform(random, 0, 255));
            patch.slope_u[j] = static_cast<float>(uniform(random, -60, 60));
            patch.slope_v[j] = static_cast<float>(uniform(random, -60, 60));
        }
        scene.patches.push_back(patch);
        scene.u.push_back(static_cast<float>(uniform(random, -10, 107)));  // some leave the image
        scene.v.push_back(static_cast<float>(uniform(random, -10, 81)));
        const double angle = uniform(random, -4, 4);
        scene.axis_x.push_back(static_cast<float>(std::cos(angle)));
        scene.axis_y.push_back(static_cast<float>(std::sin(angle)));
    }
    scene.u[0] = scene.v[1] = -1e6F;
    return scene;
}

std::vector<PatchResidual> residuals(const Table& table, const PatchScene& s, float gain, float offset) {
    std::vector<PatchResidual> out(s.patches.size());
    table.patches(s.view(), s.patches.data(), s.u.data(), s.v.data(), s.axis_x.data(), s.axis_y.data(),
                  s.patches.size(), gain, offset, out.data());
    return out;
}

struct Information {
    Points points;
    std::vector<float> matrix[6], vector[3];
    NormalEquations accumulate(const Table& table) {
        InformationArrays rows{points.x.data(), points.y.data(), points.z.data(), {}, {}};
        for (int k = 0; k < 6; ++k) rows.matrix[k] = matrix[k].data();
        for (int k = 0; k < 3; ++k) rows.vector[k] = vector[k].data();
        NormalEquations out;
        table.accumulate(rows, points.x.size(), out);
        return out;
    }
};

Information randomInformation(std::mt19937& random, std::size_t n) {
    Information info;
    info.points = randomPoints(random, n);
    for (auto& array : info.matrix) {
        for (std::size_t i = 0; i < n; ++i) array.push_back(static_cast<float>(uniform(random, -100, 400)));
    }
    for (auto& array : info.vector) {
        for (std::size_t i = 0; i < n; ++i) array.push_back(static_cast<float>(uniform(random, -50, 50)));
    }
    return info;
}

class Kernels : public ::testing::TestWithParam<bool> {
  protected:
    void SetUp() override {
        if (GetParam() && avx2() == nullptr) GTEST_SKIP() << "this processor has no AVX2";
    }
    const Table& table() const { return GetParam() ? *avx2() : baseline(); }
};
INSTANTIATE_TEST_SUITE_P(Tables, Kernels, ::testing::Bool(),
                         [](const auto& info) { return info.param ? "Avx2" : "Baseline"; });

TEST_P(Kernels, ProjectIsThePlainFormula) {
    std::mt19937 random(81);
    for (const bool rolling : {false, true}) {
        for (int repeat = 0; repeat < 10; ++repeat) {
            const Projection m = randomProjection(random, rolling);
            const Points p = randomPoints(random, 200);
            const Projected out = project(table(), m, p);
            const Eigen::Vector3d w(m.rows.turn[0], m.rows.turn[1], m.rows.turn[2]),
                velocity(m.rows.velocity[0], m.rows.velocity[1], m.rows.velocity[2]);
            Eigen::Matrix3d R;
            for (int k = 0; k < 9; ++k) R(k / 3, k % 3) = m.rotation[k];
            for (std::size_t i = 0; i < 200; ++i) {
                Eigen::Vector3d c = R * Eigen::Vector3d(p.x[i], p.y[i], p.z[i]) +
                                    Eigen::Vector3d(m.translation[0], m.translation[1], m.translation[2]);
                if (std::abs(c.z()) < 0.3)
                    continue;  // the row correction may carry it across the image plane
                if (c.z() > 1e-3) {
                    const double row = m.fy * c.y() / c.z() + m.cy;  // no row lies outside the image
                    const double rows =
                        std::clamp(row, 0.0, static_cast<double>(m.last_row)) - m.rows.reference_row;
                    c -= rows * (velocity + w.cross(c));
                }
                if (c.z() <= 1e-3) {
                    EXPECT_EQ(out.u[i], -1e6F);
                    EXPECT_EQ(out.v[i], -1e6F);
                    continue;
                }
                EXPECT_NEAR(out.x[i], c.x(), 1e-4);
                EXPECT_NEAR(out.y[i], c.y(), 1e-4);
                EXPECT_NEAR(out.z[i], c.z(), 1e-4);
                const double scale = 1 + std::abs(c.x() / c.z()) + std::abs(c.y() / c.z());
                EXPECT_NEAR(out.u[i], m.fx * c.x() / c.z() + m.cx, 2e-3 * scale / std::min(1.0, c.z()));
                EXPECT_NEAR(out.v[i], m.fy * c.y() / c.z() + m.cy, 2e-3 * scale / std::min(1.0, c.z()));
            }
        }
    }
}

TEST_P(Kernels, PatchesAreBilinearSamplesInTheTurnedFrame) {
    std::mt19937 random(82);
    const PatchScene s = randomPatches(random, 1000);
    const double gain = 1.13, offset = -7.5;
    const auto out = residuals(table(), s, static_cast<float>(gain), static_cast<float>(offset));
    int inside = 0;
    for (std::size_t i = 0; i < s.patches.size(); ++i) {
        const double u = s.u[i], v = s.v[i];
        const bool fits = u >= 4 && v >= 4 && u <= s.width - 5 && v <= s.height - 5;
        if (!fits) {
            EXPECT_LT(out[i].squared, 0) << "a patch that leaves the image must say so";
            continue;
        }
        ++inside;
        double squared = 0, gu = 0, gv = 0, current = 0, cross = 0;
        for (int j = 0; j < kPatchSize; ++j) {
            const double x = u + static_cast<double>(s.axis_x[i]) * kPatchU[j] -
                             static_cast<double>(s.axis_y[i]) * kPatchV[j];
            const double y = v + static_cast<double>(s.axis_y[i]) * kPatchU[j] +
                             static_cast<double>(s.axis_x[i]) * kPatchV[j];
            const int ix = static_cast<int>(std::floor(x)), iy = static_cast<int>(std::floor(y));
            const double fx = x - ix, fy = y - iy;
            const auto at = [&](int dx, int dy) {
                return static_cast<double>(s.image[static_cast<std::size_t>((iy + dy) * s.stride + ix + dx)]);
            };
            const double value =
                (1 - fy) * ((1 - fx) * at(0, 0) + fx * at(1, 0)) + fy * ((1 - fx) * at(0, 1) + fx * at(1, 1));
            const double reference = s.patches[i].intensity[j];
            const double e = value - gain * reference - offset;
            squared += e * e;
            gu += static_cast<double>(s.patches[i].slope_u[j]) * e;
            gv += static_cast<double>(s.patches[i].slope_v[j]) * e;
            current += value;
            cross += value * reference;
        }
        EXPECT_NEAR(out[i].squared, squared, 0.5 + 1e-4 * squared);
        EXPECT_NEAR(out[i].gradient_u, gu, 3);
        EXPECT_NEAR(out[i].gradient_v, gv, 3);
        EXPECT_NEAR(out[i].current, current, 0.05);
        EXPECT_NEAR(out[i].cross, cross, 1e-4 * cross + 1);
    }
    EXPECT_GT(inside, 400);
}

TEST_P(Kernels, AccumulateIsTheSumOfTheJacobians) {
    std::mt19937 random(83);
    for (const std::size_t n : {std::size_t{8}, std::size_t{256}, std::size_t{264}, std::size_t{2000}}) {
        Information info = randomInformation(random, n);
        const NormalEquations out = info.accumulate(table());
        Matrix6d hessian = Matrix6d::Zero(), size = Matrix6d::Zero();
        Vector6d gradient = Vector6d::Zero(), gradient_size = Vector6d::Zero();
        for (std::size_t i = 0; i < n; ++i) {
            Eigen::Matrix3d m;
            m << info.matrix[0][i], info.matrix[1][i], info.matrix[2][i], info.matrix[1][i],
                info.matrix[3][i], info.matrix[4][i], info.matrix[2][i], info.matrix[4][i], info.matrix[5][i];
            const Eigen::Vector3d v(info.vector[0][i], info.vector[1][i], info.vector[2][i]);
            Eigen::Matrix<double, 3, 6> j;
            j << Eigen::Matrix3d::Identity(), -skew({info.points.x[i], info.points.y[i], info.points.z[i]});
            hessian += j.transpose() * m * j;
            gradient += j.transpose() * v;
            size += j.cwiseAbs().transpose() * m.cwiseAbs() * j.cwiseAbs();
            gradient_size += j.cwiseAbs().transpose() * v.cwiseAbs();
        }
        int k = 0;
        for (int r = 0; r < 6; ++r) {
            EXPECT_NEAR(out.gradient[r], gradient[r], 1e-5 * gradient_size[r]) << n;
            for (int c = r; c < 6; ++c, ++k) {
                EXPECT_NEAR(out.hessian[k], hessian(r, c), 1e-5 * size(r, c)) << n << " " << r << "," << c;
            }
        }
    }
}

TEST_P(Kernels, PaddingWithZeroInformationChangesNothing) {
    std::mt19937 random(84);
    Information info = randomInformation(random, 64);
    const NormalEquations before = info.accumulate(table());
    for (int i = 0; i < kLanes; ++i) {
        info.points.x.push_back(0);
        info.points.y.push_back(0);
        info.points.z.push_back(1);
        for (auto& array : info.matrix) array.push_back(0);
        for (auto& array : info.vector) array.push_back(0);
    }
    const NormalEquations after = info.accumulate(table());
    EXPECT_EQ(std::memcmp(&before, &after, sizeof before), 0);
    const NormalEquations none = Information().accumulate(table());
    for (const double value : none.hessian) EXPECT_EQ(value, 0);
}

TEST(KernelTables, Avx2GivesTheSameBytesAsTheBaseline) {
    if (avx2() == nullptr) GTEST_SKIP() << "this processor has no AVX2";
    std::mt19937 random(85);
    for (int repeat = 0; repeat < 20; ++repeat) {
        const Projection m = randomProjection(random, repeat % 2 == 0);
        const Points p = randomPoints(random, 512);
        const Projected a = project(baseline(), m, p), b = project(*avx2(), m, p);
        EXPECT_TRUE(sameBytes(a.x, b.x) && sameBytes(a.y, b.y) && sameBytes(a.z, b.z));
        EXPECT_TRUE(sameBytes(a.u, b.u) && sameBytes(a.v, b.v));
        Points moved[] = {p, p};
        const std::vector<float> rows(p.x.rbegin(), p.x.rend());
        for (int k = 0; k < 2; ++k)  // not in whole blocks
            (k == 0 ? baseline() : *avx2())
                .exchangeMotion({{0.1F, -0.2F, 0.3F}, {0.3F, 0.1F, -0.2F}, 0.7F},
                                {{0.2F, 0.1F, -0.3F}, {-0.3F, 0.2F, 0.1F}, 0.2F}, rows.data(),
                                500 + repeat % 8, moved[k].x.data(), moved[k].y.data(), moved[k].z.data());
        EXPECT_TRUE(sameBytes(moved[0].x, moved[1].x) && sameBytes(moved[0].y, moved[1].y) &&
                    sameBytes(moved[0].z, moved[1].z));
        EXPECT_FALSE(sameBytes(moved[0].x, p.x));
        const PatchScene s = randomPatches(random, 500);
        EXPECT_TRUE(sameBytes(residuals(baseline(), s, 0.9F, 12), residuals(*avx2(), s, 0.9F, 12)));
        Information info = randomInformation(random, 1000);
        const NormalEquations first = info.accumulate(baseline()), second = info.accumulate(*avx2());
        EXPECT_EQ(std::memcmp(&first, &second, sizeof first), 0);
    }
}

TEST(KernelTables, EliminatingAPointTakesTheProductsOfAllPairsFromTheirBlocks) {
    using Coupling = Eigen::Matrix<double, 6, 3>;
    using Block = Eigen::Matrix<double, 6, 6>;
    std::mt19937 random(11);
    constexpr int kSlots = 5;
    for (int n = 0; n <= kSlots; ++n) {
        std::vector<std::int32_t> slots{0, 1, 2, 3, 4};
        std::shuffle(slots.begin(), slots.end(), random);
        slots.resize(static_cast<std::size_t>(n));
        std::sort(slots.begin(), slots.end());
        std::vector<double> coupling(18 * kSlots), through(18 * kSlots), blocks(36 * kSlots * kSlots);
        for (auto* values : {&coupling, &through, &blocks})
            for (double& value : *values) value = uniform(random, -2, 2);
        std::vector<double> expected = blocks, wide = blocks;
        for (int a = 0; a < n; ++a) {
            for (int c = a; c < n; ++c) {
                const auto at = static_cast<std::size_t>(slots[static_cast<std::size_t>(a)] * kSlots +
                                                         slots[static_cast<std::size_t>(c)]);
                Eigen::Map<Block>(&expected[36 * at]) -=
                    Eigen::Map<const Coupling>(&through[18 * static_cast<std::size_t>(a)]) *
                    Eigen::Map<const Coupling>(&coupling[18 * static_cast<std::size_t>(c)]).transpose();
            }
        }
        baseline().eliminatePoint(coupling.data(), through.data(), slots.data(), n, kSlots, blocks.data());
        for (std::size_t i = 0; i < blocks.size(); ++i) EXPECT_NEAR(blocks[i], expected[i], 1e-12);
        if (avx2() == nullptr) continue;
        avx2()->eliminatePoint(coupling.data(), through.data(), slots.data(), n, kSlots, wide.data());
        EXPECT_TRUE(sameBytes(wide, blocks));
    }
}

TEST(KernelTables, BestIsOneOfThemAndPaddingIsWholeBlocks) {
    EXPECT_TRUE(&best() == &baseline() || &best() == avx2());
    for (std::size_t n = 0; n < 40; ++n) {
        EXPECT_EQ(paddedSize(n) % kLanes, 0U);
        EXPECT_GE(paddedSize(n), n);
        EXPECT_LT(paddedSize(n), n + kLanes);
    }
}

}  // namespace
}  // namespace roevo::kernels
