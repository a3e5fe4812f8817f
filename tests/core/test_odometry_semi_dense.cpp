// The surface next to the keyframes' edges, on a simulated room whose surfaces are known.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <limits>
#include <opencv2/core.hpp>

#include "core/support/simulated.h"

namespace roevo {
namespace {

using simulator::Primitive;
using testing::Sequence;
using testing::smallRoom;

/// Distance of a point to a primitive's surface, m; exact for quads, boxes and spheres.
double distanceTo(const Primitive& primitive, const Eigen::Vector3d& point) {
    const Eigen::Vector3d unit = primitive.toUnit(point), half = primitive.half_size;
    const double along = std::hypot(unit.x(), unit.y());
    switch (primitive.shape) {
        case simulator::Shape::kSphere:
            return std::abs(unit.norm() - 1) * half.minCoeff();
        case simulator::Shape::kCylinder: {
            const double radius = 1 + (primitive.taper - 1) * (unit.z() + 1) / 2;
            const double side = std::abs(along - radius) * half.x(),
                         cap = std::abs(std::abs(unit.z()) - 1) * half.z();
            if (std::abs(unit.z()) > 1) return along > radius ? std::hypot(side, cap) : cap;
            return along > radius ? side : std::min(side, cap);
        }
        default: {
            Eigen::Vector3d size = half;
            if (primitive.shape == simulator::Shape::kQuad) size.z() = 0;
            const Eigen::Vector3d beyond = unit.cwiseProduct(half).cwiseAbs() - size;
            return beyond.maxCoeff() < 0 ? -beyond.maxCoeff() : beyond.cwiseMax(0).norm();
        }
    }
}

double distanceToScene(const simulator::Scene& scene, const Eigen::Vector3d& point) {
    double nearest = std::numeric_limits<double>::infinity();
    for (const Primitive& primitive : scene.primitives)
        if (primitive.visible) nearest = std::min(nearest, distanceTo(primitive, point));
    return nearest;
}

simulator::SimulationOptions noisyOptions() {
    simulator::SimulationOptions options = smallRoom();
    options.useKinectNoise();
    return options;
}

/// A sequence in colour.
Sequence inColour(const simulator::SimulationOptions& options, int count) {
    const simulator::Simulator simulator(options);
    Sequence sequence;
    sequence.camera = simulator.camera();
    for (int i = 0; i < count; ++i) {
        const simulator::SimulatedFrame frame = simulator.frame(i);
        sequence.frames.push_back({frame.timestamp, frame.grey, frame.depth_noisy, frame.colour});
        sequence.truth.push_back({frame.timestamp, frame.T_world_camera});
    }
    return sequence;
}

const Sequence& colouredRoom() {
    static const Sequence sequence = inColour(smallRoom(), 40);
    return sequence;
}
const Sequence& noisy() {
    static const Sequence sequence = inColour(noisyOptions(), 40);
    return sequence;
}

constexpr int kPoints = 400;

/// Many keyframes, so that there is something to see in a short sequence.
OdometryOptions manyKeyframes(Mode mode = Mode::kBundleAdjustment) {
    OdometryOptions options;
    options.mode = mode;
    options.keyframe.max_translation = 0.02;
    options.mapping.semi_dense_points = kPoints;
    return options;
}

std::unique_ptr<Odometry> run(const Sequence& sequence, const OdometryOptions& options) {
    auto odometry = std::make_unique<Odometry>(sequence.camera, options, sequence.start());
    for (const RgbdFrame& frame : sequence.frames) (void)odometry->processFrame(frame);
    return odometry;
}

/// The distance that `share` of the points keep to the room's surfaces, m. @param unit  of each distance
template <class Unit>
double quantile(const std::vector<ColouredPoint>& points, const simulator::Scene& scene, double share,
                const Unit& unit) {
    std::vector<double> distances;
    for (const ColouredPoint& point : points)
        distances.push_back(distanceToScene(scene, point.position.cast<double>()) / unit(point));
    const auto nth =
        distances.begin() + static_cast<std::ptrdiff_t>(share * static_cast<double>(distances.size() - 1));
    std::nth_element(distances.begin(), nth, distances.end());
    return *nth;
}

std::vector<std::array<float, 6>> flat(const std::vector<ColouredPoint>& points) {
    std::vector<std::array<float, 6>> all;
    for (const ColouredPoint& p : points)
        all.push_back({p.position.x(), p.position.y(), p.position.z(), static_cast<float>(p.colour[0]),
                       static_cast<float>(p.colour[1]), static_cast<float>(p.colour[2])});
    return all;
}

TEST(OdometrySemiDense, LiesOnTheRoomsSurfacesInEveryMode) {
    const simulator::Simulator simulator(smallRoom());
    for (const Mode mode : {Mode::kBundleAdjustment, Mode::kTracking, Mode::kCoarse}) {
        const auto odometry = run(colouredRoom(), manyKeyframes(mode));
        const auto points = odometry->semiDense();
        EXPECT_GE(odometry->keyframes().size(), 4u);
        ASSERT_EQ(points.size(), kPoints * odometry->keyframes().size()) << toString(mode);
        const auto metres = [](const ColouredPoint&) { return 1.; };
        const double most = quantile(points, simulator.scene(), 0.99, metres);
        RecordProperty(std::string(toString(mode)) + "_mm", std::to_string(1000 * most));
        EXPECT_LT(most, 0.005) << toString(mode);
    }
}

TEST(OdometrySemiDense, WithAKinectsNoiseLiesWithinIt) {
    const simulator::Simulator simulator(noisyOptions());
    const auto odometry = run(noisy(), manyKeyframes());
    const auto points = odometry->semiDense();
    ASSERT_GE(points.size(), 4u * kPoints);
    // Each keyframe has kPoints of them, in order, and depth noise grows with the square of the depth
    const auto keyframes = odometry->keyframes();
    const ColouredPoint* const first = points.data();
    const auto sigma = [&](const ColouredPoint& point) {
        const auto k = static_cast<std::size_t>(&point - first) / kPoints;
        const double z = (keyframes[k].T_world_camera.inverse() * point.position.cast<double>()).z();
        return 1.425e-3 * z * z + 0.002;  // the poses are not exact, either
    };
    EXPECT_LT(quantile(points, simulator.scene(), 0.68, sigma), 1.2);
    EXPECT_LT(quantile(points, simulator.scene(), 0.99, sigma), 4);
    for (std::size_t i = 0; i < points.size(); i++) {
        const double z =
            (keyframes[i / kPoints].T_world_camera.inverse() * points[i].position.cast<double>()).z();
        EXPECT_LE(z, odometry->options().sensor.max_depth + 0.05);
    }
}

TEST(OdometrySemiDense, FollowsTheMapAndHasTheColoursOfItsKeyframe) {
    OdometryOptions options = manyKeyframes();
    options.sensor.estimate_readout = false;  // else points are where they were at the middle row's time
    const auto odometry = run(noisy(), options);
    const auto keyframes = odometry->keyframes();
    const auto live = odometry->liveTrajectory();
    const auto points = odometry->semiDense();
    ASSERT_EQ(points.size(), kPoints * keyframes.size());
    double most_moved = 0;
    for (std::size_t k = 0; k < keyframes.size(); ++k) {
        const Pose T_camera_world = keyframes[k].T_world_camera.inverse();
        const auto frame =
            std::find_if(noisy().frames.begin(), noisy().frames.end(),
                         [&](const RgbdFrame& f) { return f.timestamp == keyframes[k].timestamp; });
        ASSERT_NE(frame, noisy().frames.end());
        const Pose& as_tracked =
            live[static_cast<std::size_t>(frame - noisy().frames.begin())].T_world_camera;
        most_moved = std::max(most_moved, (T_camera_world * as_tracked).translation().norm());
        for (std::size_t i = k * kPoints; i < (k + 1) * kPoints; ++i) {
            const Eigen::Vector3d seen = T_camera_world * points[i].position.cast<double>();
            const Eigen::Vector2d pixel = noisy().camera.project(seen);
            const cv::Point at(static_cast<int>(std::lround(pixel.x())),
                               static_cast<int>(std::lround(pixel.y())));
            // Points are pixels of the keyframe: seen from its final pose they lie in their middle
            ASSERT_NEAR(pixel.x(), at.x, 0.03) << k;
            ASSERT_NEAR(pixel.y(), at.y, 0.03) << k;
            EXPECT_NEAR(seen.z(), static_cast<double>(frame->depth.at<float>(at)), 5e-4);
            const auto& bgr = frame->colour.at<cv::Vec3b>(at);
            EXPECT_EQ(points[i].colour, (Rgb{bgr[2], bgr[1], bgr[0]}));
        }
    }
    EXPECT_GT(most_moved, 5e-4) << "the map moved nothing: this test would see no error";
}

TEST(OdometrySemiDense, LeavesOutMixedPixelsAndUnsureDepths) {
    // A chessboard in three parts: at 1 m, at 2 m (pixels between them hold the mean), and too far away
    RgbdFrame frame = {1, cv::Mat(240, 320, CV_8UC1), cv::Mat(240, 320, CV_32FC1), cv::Mat()};
    for (int v = 0; v < 240; ++v)
        for (int u = 0; u < 320; ++u) {
            frame.grey.at<std::uint8_t>(v, u) = (u / 20 + v / 20) % 2 == 0 ? 40 : 200;
            frame.depth.at<float>(v, u) = u < 119 ? 1.f : u < 121 ? 1.5f : u < 220 ? 2.f : 5.5f;
        }
    Odometry odometry(colouredRoom().camera, OdometryOptions());
    ASSERT_EQ(odometry.processFrame(frame).status, FrameStatus::kInitialised);
    const auto points = odometry.semiDense();
    const auto at = [&](float depth) {
        return std::count_if(points.begin(), points.end(), [&](const ColouredPoint& point) {
            return std::abs(point.position.z() - depth) < 1e-3f;
        });
    };
    EXPECT_GT(at(1), 200);
    EXPECT_GT(at(2), 200);
    EXPECT_EQ(at(1) + at(2), static_cast<std::ptrdiff_t>(points.size()));
}

TEST(OdometrySemiDense, NoneWhenSwitchedOffAndNothingElseChanges) {
    for (const Mode mode : {Mode::kBundleAdjustment, Mode::kTracking}) {
        OdometryOptions off = manyKeyframes(mode);
        off.mapping.semi_dense_points = 0;
        const auto without = run(noisy(), off), with = run(noisy(), manyKeyframes(mode));
        EXPECT_TRUE(without->semiDense().empty());
        EXPECT_FALSE(with->semiDense().empty());
        const auto a = without->trajectory(), b = with->trajectory();
        ASSERT_EQ(a.size(), b.size());
        for (std::size_t i = 0; i < a.size(); ++i)
            EXPECT_EQ(a[i].T_world_camera.matrix(), b[i].T_world_camera.matrix());
    }
    Odometry fresh(colouredRoom().camera, OdometryOptions());
    EXPECT_TRUE(fresh.semiDense().empty());
}

TEST(OdometrySemiDense, EveryRunGivesTheSamePointsHoweverOftenOneAsks) {
    OdometryOptions options = manyKeyframes(Mode::kTracking);
    options.keyframe.max_rotation_deg = 0.1;  // nearly every frame: sampling falls behind
    options.mapping.semi_dense_points = 50000;
    const auto once = run(colouredRoom(), options);
    EXPECT_GT(once->keyframes().size(), 30u);
    Odometry asked(colouredRoom().camera, options, colouredRoom().start());
    std::size_t before = 0;
    for (const RgbdFrame& frame : colouredRoom().frames) {
        (void)asked.processFrame(frame);
        const std::size_t now = asked.semiDense().size();
        EXPECT_GE(now, before);
        before = now;
    }
    EXPECT_TRUE(flat(once->semiDense()) == flat(asked.semiDense()));
}

TEST(OdometrySemiDense, PointsOfARollingShutterAreMovedToOneMoment) {
    simulator::SimulationOptions simulation = smallRoom();
    simulation.fps = 15;
    simulation.rolling_shutter = 0.066;
    simulation.speed = 1;
    const Sequence sequence = testing::simulate(simulation, 40);
    const simulator::Simulator simulator(simulation);
    OdometryOptions options = manyKeyframes(Mode::kTracking);
    options.sensor.estimate_readout = false;
    options.sensor.readout_time = 0.066;
    const auto points = run(sequence, options)->semiDense();
    ASSERT_GE(points.size(), 4u * kPoints);
    const double most = quantile(points, simulator.scene(), 0.9, [](const ColouredPoint&) { return 1.; });
    RecordProperty("mm", std::to_string(1000 * most));
    EXPECT_LT(most, 0.0065);
}

}  // namespace
}  // namespace roevo
