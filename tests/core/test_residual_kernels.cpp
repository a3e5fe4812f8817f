// Residuals, weights and information of matched points: baseline and AVX2 give the same bytes, and both what
// plain double loops give.
#include <gtest/gtest.h>

#include <cstring>

#include "core/support/random_pose.h"
#include "tracking/motion_blur.h"
#include "tracking/photometric.h"
#include "tracking/robust.h"
#include "tracking/se3.h"

namespace roevo::kernels {
namespace {

using roevo::testing::uniform;
using Floats = std::vector<float>;

constexpr std::size_t kCount = 203, kPadded = 208, kEdgePoints = 300;
constexpr float kFx = 517.3F, kFy = 516.5F;

Floats randomFloats(std::mt19937& random, double low, double high, std::size_t count = kPadded) {
    Floats values;
    for (std::size_t i = 0; i < count; ++i) values.push_back(static_cast<float>(uniform(random, low, high)));
    return values;
}

/// Of the pull of a residual of the t-distribution with five degrees of freedom, as a share of its weight.
float slopeAt(float squared) {
    return (5 - squared) / (5 + squared);
}

/// Matched points, some of them behind the camera, with an edge point of an image each.
struct Scene {
    std::mt19937 random{7};
    Floats x = randomFloats(random, -2, 2), y = randomFloats(random, -2, 2), z = randomFloats(random, 0.4, 5);
    Floats u = randomFloats(random, 0, 640), v = randomFloats(random, 0, 480);
    Floats edge_x, edge_y, normal_x, normal_y;
    Floats keyframe_blur = randomFloats(random, 0, 3), prior = randomFloats(random, 0.1, 1);
    Floats then_x = randomFloats(random, -2, 2), then_y = randomFloats(random, -2, 2),
           then_z = randomFloats(random, 0.4, 5), row = randomFloats(random, 0, 480);
    Floats depth_weight = randomFloats(random, 0, 200), depth_residual = randomFloats(random, -0.1, 0.1);
    std::vector<std::int32_t> current;
    CameraMotion motion{{0.3F, -0.2F, 0.5F}, {0.7F, -0.4F, 0.9F}, 7.7F, 7.6F};
    ReadoutPoints readout{};

    Scene() {
        for (std::size_t i = 0; i < kEdgePoints; ++i) {
            const double angle = uniform(random, -4, 4);
            edge_x.push_back(static_cast<float>(uniform(random, 0, 640)));
            edge_y.push_back(static_cast<float>(uniform(random, 0, 480)));
            normal_x.push_back(static_cast<float>(std::cos(angle)));
            normal_y.push_back(static_cast<float>(std::sin(angle)));
        }
        for (std::size_t i = 0; i < kPadded; ++i) {
            current.push_back(static_cast<std::int32_t>(random() % kEdgePoints));
            const auto p = static_cast<std::size_t>(current.back());
            edge_x[p] = u[i] + static_cast<float>(uniform(random, -3, 3));  // of the last match with it
            edge_y[p] = v[i] + static_cast<float>(uniform(random, -3, 3));
        }
        for (std::size_t i = kCount; i < kPadded; ++i) prior[i] = 0;
        z[5] = 0;
        z[17] = -1;
        readout = {then_x.data(), then_y.data(), then_z.data(), row.data(), {0.2F, 0.1F, -0.4F}, {}, 239.5F};
        for (float& value : readout.turn) value = static_cast<float>(uniform(random, -1, 1));
    }
    MatchedPoints matches() const {
        return {x.data(), y.data(), z.data(), u.data(), v.data(), current.data()};
    }
    ImageEdges edges() const {
        return {edge_x.data(), edge_y.data(), normal_x.data(), normal_y.data(), nullptr, nullptr};
    }
    bool ahead(std::size_t i) const { return z[i] > 1e-3F; }
    Eigen::Vector2d normal(std::size_t i) const {
        const auto p = static_cast<std::size_t>(current[i]);
        return {static_cast<double>(normal_x[p]), static_cast<double>(normal_y[p])};
    }
    /// Derivative of the residual by the point.
    Eigen::Vector3d byPoint(std::size_t i) const {
        const double a = static_cast<double>(kFx / z[i]), b = static_cast<double>(kFy / z[i]);
        const Eigen::Vector2d n = normal(i);
        return {a * n.x(), b * n.y(),
                -(a * n.x() * static_cast<double>(x[i]) + b * n.y() * static_cast<double>(y[i])) /
                    static_cast<double>(z[i])};
    }
};

/// Room for what lifting writes.
struct Rows {
    Floats x = Floats(kPadded), y = x, z = x, matrix[6], vector[3];
    InformationArrays arrays{};
    Rows() {
        arrays = {x.data(), y.data(), z.data(), {}, {}};
        for (int k = 0; k < 6; ++k) arrays.matrix[k] = (matrix[k] = x).data();
        for (int k = 0; k < 3; ++k) arrays.vector[k] = (vector[k] = x).data();
    }
    void expect(std::size_t i, const Eigen::Matrix3d& M, const Eigen::Vector3d& v, double tolerance) const {
        int k = 0;
        for (int r = 0; r < 3; ++r) {
            EXPECT_NEAR(static_cast<double>(vector[r][i]), v[r], tolerance * (1 + v.norm())) << i;
            for (int c = r; c < 3; ++c, ++k)
                EXPECT_NEAR(static_cast<double>(matrix[k][i]), M(r, c), tolerance * (1 + M.norm())) << i;
        }
    }
    Floats all() const {
        Floats values = x;
        for (const Floats* array : {&y, &z, matrix, matrix + 1, matrix + 2, matrix + 3, matrix + 4,
                                    matrix + 5, vector, vector + 1, vector + 2})
            values.insert(values.end(), array->begin(), array->end());
        return values;
    }
};

/// All that the kernels make of a scene.
struct Results {
    Floats residual = Floats(kPadded), sharpness = residual, magnitude = residual, weight = residual;
    Fit fit{};
    int inliers = 0;
    Rows rows, of_readout;
    ReadoutSums sums{};

    Results(const Table& table, const Scene& s) {
        table.edgeResiduals(s.matches(), s.edges(), s.motion, s.keyframe_blur.data(), kPadded,
                            residual.data(), sharpness.data(), magnitude.data());
        inliers = table.weighEdges(residual.data(), sharpness.data(), s.prior.data(), kPadded, 0.9F, 9,
                                   weight.data(), fit);
        table.liftEdges(s.matches(), s.edges(), weight.data(), residual.data(), s.depth_weight.data(),
                        s.depth_residual.data(), kPadded, kFx, kFy, rows.arrays);
        table.liftReadout(s.matches(), s.edges(), s.motion, s.readout, weight.data(), residual.data(),
                          kPadded, kFx, kFy, of_readout.arrays, sums);
    }
};

class ResidualKernels : public ::testing::TestWithParam<const Table*> {
  protected:
    void SetUp() override {
        if (GetParam() == nullptr) GTEST_SKIP() << "this processor has no AVX2";
    }
    const Table& table() const { return *GetParam(); }
};

TEST_P(ResidualKernels, TangentResidualsAndWhatMotionTakesOfThem) {
    const Scene s;
    const Results found(table(), s);
    RowMotion rows;
    rows.velocity = {0.3F, -0.2F, 0.5F};
    rows.turn = {0.7F, -0.4F, 0.9F};
    PinholeCamera camera;
    camera.fx = static_cast<double>(s.motion.to_sigmas_x) / 3;  // with a second, in units of what is at rest
    camera.fy = static_cast<double>(s.motion.to_sigmas_y) / 3;
    const CameraMotion motion = cameraMotion(rows, camera, 1);
    Floats nx(kPadded), ny(kPadded), variance(kPadded);
    table().pick(s.normal_x.data(), s.current.data(), kPadded, nx.data());
    table().pick(s.normal_y.data(), s.current.data(), kPadded, ny.data());
    table().blur(motion, s.x.data(), s.y.data(), s.z.data(), nx.data(), ny.data(), kPadded, variance.data());
    for (std::size_t i = 0; i < kPadded; ++i) {
        const auto p = static_cast<std::size_t>(s.current[i]);
        const Eigen::Vector2d n = s.normal(i);
        ASSERT_EQ(nx[i], s.normal_x[p]);
        const double residual = n.x() * static_cast<double>(s.u[i] - s.edge_x[p]) +
                                n.y() * static_cast<double>(s.v[i] - s.edge_y[p]);
        EXPECT_NEAR(static_cast<double>(found.residual[i]), residual, 1e-3);
        ASSERT_TRUE(std::isfinite(found.sharpness[i])) << i;
        if (!s.ahead(i)) continue;
        const float now = blurVariance(motion, s.x[i], s.y[i], s.z[i], nx[i], ny[i]);
        EXPECT_NEAR(variance[i], now, 1e-4F * (1 + now)) << i;
        EXPECT_NEAR(found.sharpness[i], 1 / (1 + now + s.keyframe_blur[i]), 1e-4F) << i;
        EXPECT_NEAR(found.magnitude[i], std::abs(found.residual[i]) * std::sqrt(found.sharpness[i]), 1e-4F);
    }
}

TEST_P(ResidualKernels, WeightsAreStudentsAndOutliersHaveNone) {
    const Scene s;
    const Results found(table(), s);
    double weights = 0, slopes = 0;
    int inliers = 0;
    for (std::size_t i = 0; i < kPadded; ++i) {
        const float information = found.sharpness[i] * 0.9F;
        const float squared = found.residual[i] * found.residual[i] * information;
        const bool fits = squared <= 9 && s.prior[i] > 0;
        const float expected = fits ? studentWeight(s.prior[i] * information, squared) : 0;
        EXPECT_NEAR(found.weight[i], expected, 1e-5F * expected) << i;
        inliers += fits ? 1 : 0;
        weights += static_cast<double>(expected);
        if (fits) slopes += static_cast<double>(expected * slopeAt(squared));
    }
    EXPECT_EQ(found.inliers, inliers);
    EXPECT_GT(inliers, 50);
    EXPECT_LT(inliers, 200);
    EXPECT_NEAR(found.fit.weights, weights, 1e-5 * weights);
    EXPECT_NEAR(found.fit.slopes, slopes, 1e-5 * weights);
}

TEST_P(ResidualKernels, EdgesAndDepthsAreLifted) {
    const Scene s;
    const Results found(table(), s);
    for (std::size_t i = 0; i < kPadded; ++i) {
        const auto w = static_cast<double>(found.weight[i]), r = static_cast<double>(found.residual[i]);
        for (int k = 0; k < 6; ++k) ASSERT_TRUE(std::isfinite(found.rows.matrix[k][i])) << i;
        if (!s.ahead(i)) continue;
        const Eigen::Vector3d j = s.byPoint(i);
        Eigen::Matrix3d M = w * j * j.transpose();
        Eigen::Vector3d v = w * r * j;
        found.of_readout.expect(i, M, v, 1e-5);
        if (w > 0) {
            M(2, 2) += static_cast<double>(s.depth_weight[i]);
            v[2] += static_cast<double>(s.depth_weight[i] * s.depth_residual[i]);
        }
        found.rows.expect(i, M, v, 1e-5);
        ASSERT_EQ(found.rows.x[i], s.x[i]);
        ASSERT_EQ(found.rows.z[i], s.z[i]);
    }
}

TEST_P(ResidualKernels, ReadoutIsJoinedToThePose) {
    const Scene s;
    Results found(table(), s);
    Vector6d mixed = Vector6d::Zero(), sizes = Vector6d::Zero();
    double own = 0, gradient = 0, gradient_size = 0;
    RowMotion now;
    for (int k = 0; k < 3; ++k) {
        now.velocity[k] = static_cast<double>(s.motion.velocity[k]);
        now.turn[k] = static_cast<double>(s.motion.turn[k]);
    }
    for (std::size_t i = 0; i < kPadded; ++i) {
        const auto w = static_cast<double>(found.weight[i]);
        if (w == 0 || !s.ahead(i)) continue;
        const Eigen::Vector3d point(static_cast<double>(s.x[i]), static_cast<double>(s.y[i]),
                                    static_cast<double>(s.z[i]));
        const Eigen::Vector3f then(s.then_x[i], s.then_y[i], s.then_z[i]);
        const Eigen::Vector3f moves =
            Eigen::Map<const Eigen::Vector3f>(s.readout.velocity) +
            Eigen::Map<const Eigen::Matrix<float, 3, 3, Eigen::RowMajor>>(s.readout.turn) * then;
        const auto reference = static_cast<double>(s.readout.reference_row);
        const Eigen::Vector3d j = s.byPoint(i);
        const double by_readout =
            j.dot(now.pointVelocity(point)) * (static_cast<double>(s.v[i]) - reference) +
            j.dot(moves.cast<double>()) * (static_cast<double>(s.row[i]) - reference);
        Vector6d by_pose;
        by_pose << j, point.cross(j);
        const auto r = static_cast<double>(found.residual[i]);
        mixed += w * by_readout * by_pose;
        sizes += (w * by_readout * by_pose).cwiseAbs();
        own += w * by_readout * by_readout;
        gradient += w * by_readout * r;
        gradient_size += std::abs(w * by_readout * r);
    }
    for (int k = 0; k < 6; ++k) EXPECT_NEAR(found.sums.mixed[k], mixed[k], 1e-5 * sizes[k]) << k;
    EXPECT_NEAR(found.sums.own, own, 1e-5 * own);
    EXPECT_NEAR(found.sums.gradient, gradient, 1e-5 * gradient_size);
}

TEST_P(ResidualKernels, FollowedMatchesMoveAlongTheirEdgesToTheNearestPoint) {
    // A bent edge, a short one, and another edge nearer by than the one that was matched
    OrganizedEdges edges;
    for (int i = 0; i < 60; ++i)
        edges.addPoint(static_cast<float>(40 + i), static_cast<float>(60 + 0.01 * i * i), 0, 1, 20);
    edges.finishEdge();
    for (int i = 0; i < 4; ++i) edges.addPoint(static_cast<float>(120 + i), 100, 0, 1, 20);
    edges.finishEdge();
    for (int i = 0; i < 60; ++i) edges.addPoint(static_cast<float>(70 + i), 64.5F, 0, 1, 20);
    edges.finishEdge();
    const std::size_t padded = paddedSize(edges.size());
    std::vector<std::int32_t> current(padded, 0);
    for (std::size_t i = 0; i < edges.size(); ++i) current[i] = static_cast<std::int32_t>(i);
    const std::vector<std::int32_t> before = current;
    for (const auto& [du, dv] : {std::pair{2.6F, 0.3F}, {-2.6F, -0.8F}, {400.0F, 0.0F}, {0.0F, 0.0F}}) {
        Floats u = edges.x, v = edges.y;
        u.resize(padded, u.front());
        v.resize(padded, v.front());
        for (auto& value : u) value += du;
        for (auto& value : v) value += dv;
        table().follow(
            u.data(), v.data(),
            {edges.x.data(), edges.y.data(), nullptr, nullptr, edges.edge_of.data(), edges.begin.data()},
            padded, current.data());
        for (std::size_t i = 0; i < edges.size(); ++i) {
            const auto far = [&](std::size_t p) { return std::hypot(edges.x[p] - u[i], edges.y[p] - v[i]); };
            const auto found = static_cast<std::size_t>(current[i]);
            const IndexRange own = edges.pointsOf(edges.edge_of[i]);
            EXPECT_EQ(edges.edge_of[found], edges.edge_of[i]);
            for (std::size_t p = own.first; p < own.end; ++p) EXPECT_LE(far(found), far(p)) << i << ' ' << p;
        }
    }
    EXPECT_EQ(current, before) << "there and back";
}

/// Photometric points with what their patches came to, some of them outside the image.
struct ResidualScene {
    std::mt19937 random{9};
    std::vector<Patch> patches;
    std::vector<PatchResidual> residuals;
    Floats x = randomFloats(random, -2, 2), y = randomFloats(random, -2, 2), z = randomFloats(random, 0.4, 5);
    Floats axis_x, axis_y, prior = randomFloats(random, 0.2, 1), weight = Floats(kPadded);
    Fit fit{};
    PatchSums sums{};
    Rows rows;

    explicit ResidualScene(const Table& table) {
        for (std::size_t i = 0; i < kPadded; ++i) {
            const double angle = uniform(random, -4, 4);
            axis_x.push_back(static_cast<float>(std::cos(angle)));
            axis_y.push_back(static_cast<float>(std::sin(angle)));
            const bool visible = i < kCount && i % 7 != 3;
            const Floats of = randomFloats(random, -50, 50, 4);
            residuals.push_back({visible ? of[0] * of[0] : -1, of[1], of[2], 900 + of[3], 9e4F + of[0]});
            if (i >= kCount) continue;
            Patch patch{};
            patch.gram[0] = of[1] * of[1] + of[2] * of[2];
            patch.gram[1] = of[1] * of[3];
            patch.gram[2] = of[3] * of[3];
            patch.sum = 800 + of[0];
            patch.sum_squared = 8e4F + of[1];
            patches.push_back(patch);
        }
        table.weighPatches(residuals.data(), prior.data(), kPadded, 0.01F, weight.data(), fit);
        table.sumPatches(points(), kPadded, sums);
        table.liftPatches(points(), kPadded, kFx, kFy, 0.5F, 1.25F, rows.arrays);
    }
    PatchPoints points() const {
        return {patches.data(), residuals.data(), kCount,        x.data(),     y.data(),
                z.data(),       axis_x.data(),    axis_y.data(), weight.data()};
    }
};

TEST_P(ResidualKernels, PatchesAreWeighedSummedAndLifted) {
    const ResidualScene s(table());
    double weights = 0, slopes = 0, reference = 0, squares = 0, image = 0, cross = 0;
    for (std::size_t i = 0; i < kPadded; ++i) {
        const PatchResidual& residual = s.residuals[i];
        const float squared = residual.squared * 0.01F;
        const float expected = residual.squared < 0 ? 0 : studentWeight(s.prior[i], squared);
        ASSERT_NEAR(s.weight[i], expected, 1e-6F) << i;
        if (expected == 0) {
            for (int k = 0; k < 6; ++k) ASSERT_EQ(s.rows.matrix[k][i], 0) << i;
            continue;
        }
        const Patch& patch = s.patches[i];
        const auto w = static_cast<double>(expected);
        weights += w;
        slopes += w * static_cast<double>(slopeAt(squared));
        reference += w * static_cast<double>(patch.sum);
        squares += w * static_cast<double>(patch.sum_squared);
        image += w * static_cast<double>(residual.current);
        cross += w * static_cast<double>(residual.cross);
        // From the aligned frame to the image, then to three dimensions
        Eigen::Matrix2f A, G;
        A << s.axis_x[i], -s.axis_y[i], s.axis_y[i], s.axis_x[i];
        G << patch.gram[0], patch.gram[1], patch.gram[1], patch.gram[2];
        const Eigen::Matrix2f M = 1.25F * 1.25F * 0.5F * expected * A * G * A.transpose();
        const Eigen::Vector2f v =
            1.25F * 0.5F * expected * A * Eigen::Vector2f(residual.gradient_u, residual.gradient_v);
        Eigen::Matrix<float, 2, 3> P;
        P << kFx / s.z[i], 0, -kFx * s.x[i] / (s.z[i] * s.z[i]), 0, kFy / s.z[i],
            -kFy * s.y[i] / (s.z[i] * s.z[i]);
        s.rows.expect(i, (P.transpose() * M * P).cast<double>(), (P.transpose() * v).cast<double>(), 5e-6);
    }
    EXPECT_NEAR(s.fit.weights, weights, 1e-5 * weights);
    EXPECT_NEAR(s.fit.slopes, slopes, 1e-5 * weights);
    EXPECT_NEAR(s.sums.weight, weights, 1e-5 * weights);
    EXPECT_NEAR(s.sums.reference, reference, 1e-5 * reference);
    EXPECT_NEAR(s.sums.reference_squared, squares, 1e-5 * squares);
    EXPECT_NEAR(s.sums.image, image, 1e-5 * image);
    EXPECT_NEAR(s.sums.cross, cross, 1e-5 * cross);
}

TEST(ResidualKernelTables, Avx2GivesTheSameBytesAsTheBaseline) {
    if (avx2() == nullptr) GTEST_SKIP() << "this processor has no AVX2";
    const Scene scene;
    const Results a(baseline(), scene), b(*avx2(), scene);
    const ResidualScene c(baseline()), d(*avx2());
    const auto same = [](const Floats& one, const Floats& other) {
        return one.size() == other.size() &&
               std::memcmp(one.data(), other.data(), one.size() * sizeof(float)) == 0;
    };
    EXPECT_TRUE(same(a.residual, b.residual));
    EXPECT_TRUE(same(a.sharpness, b.sharpness));
    EXPECT_TRUE(same(a.magnitude, b.magnitude));
    EXPECT_TRUE(same(a.weight, b.weight));
    EXPECT_TRUE(same(a.rows.all(), b.rows.all()));
    EXPECT_TRUE(same(a.of_readout.all(), b.of_readout.all()));
    EXPECT_EQ(std::memcmp(&a.sums, &b.sums, sizeof a.sums), 0);
    EXPECT_EQ(a.fit.weights, b.fit.weights);
    EXPECT_EQ(a.fit.slopes, b.fit.slopes);
    EXPECT_TRUE(same(c.weight, d.weight));
    EXPECT_TRUE(same(c.rows.all(), d.rows.all()));
    EXPECT_EQ(std::memcmp(&c.sums, &d.sums, sizeof c.sums), 0);
}

INSTANTIATE_TEST_SUITE_P(Tables, ResidualKernels, ::testing::Values(&baseline(), avx2()),
                         [](const auto& info) {
                             return info.param == nullptr ? std::string("none")
                                                          : std::string(info.param->name);
                         });

}  // namespace
}  // namespace roevo::kernels
