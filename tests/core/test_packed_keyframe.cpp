// Keyframes out of the window are kept in fewer bits: how much of them comes back.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <set>

#include "core/support/mapping_world.h"
#include "kernels/kernels.h"
#include "mapping/local_mapper.h"
#include "mapping/packed_keyframe.h"
#include "tracking/edge_points.h"

namespace roevo {
namespace {

using namespace testing;

MapKeyframe someKeyframe() {
    const auto curves = room();
    MapKeyframe keyframe = makeKeyframe(3, placeOnPath(2), curves, seeAll(curves, 0.3)).keyframe;
    for (std::size_t i = 0; i < keyframe.size(); ++i) {
        keyframe.colours[i] = {static_cast<std::uint8_t>(i), static_cast<std::uint8_t>(i / 7), 9};
        keyframe.weight[i] =
            static_cast<float>(depthWeight(static_cast<double>(keyframe.points.z[i]), SensorOptions()));
    }
    return keyframe;
}

TEST(QuantizedArray, ValuesComeBackWithinHalfAStep) {
    std::vector<float> values;
    for (int i = 0; i < 1000; ++i) values.push_back(std::sin(0.1F * static_cast<float>(i * i)) * 320 - 5);
    const QuantizedArray packed(values);
    for (std::size_t i = 0; i < values.size(); ++i)
        EXPECT_NEAR(packed.at(i), values[i], 0.5F * 640 / 65535 + 1e-4F) << i;
}

TEST(QuantizedArray, EqualValuesAndOnlyOneComeBackAsTheyAre) {
    const std::vector<float> values(5, 3.25F);
    EXPECT_EQ(QuantizedArray(values).at(4), 3.25F);
    EXPECT_EQ(QuantizedArray({3.25F}).at(0), 3.25F);
    EXPECT_NO_THROW((void)QuantizedArray(std::vector<float>()));
}

TEST(MapKeyframe, PointsGoWhereAnotherMotionOfTheRowsPutsThemAndBack) {
    const MapKeyframe original = someKeyframe();
    const PinholeCamera camera = mappingCamera();
    MapKeyframe keyframe = original;
    RowMotion rows = keyframe.row_motion;
    rows.velocity = {0.4, -0.1, 0.2};
    rows.turn = {0.1, 0.5, -0.2};
    rows.seconds_per_row = 0.02 / camera.height;
    rows.reference_row = camera.height / 2.0;
    setRowMotion(keyframe, rows, camera);
    EXPECT_EQ(keyframe.row_motion, rows);
    double furthest = 0;
    for (std::size_t i = 0; i < keyframe.size(); ++i) {
        const Eigen::Vector3d expected =
            rows.toReference(original.points.at(i), static_cast<double>(original.image.y[i]));
        EXPECT_LT((keyframe.points.at(i) - expected).norm(), 1e-5);
        const Eigen::Vector2d pixel = camera.project(expected);
        EXPECT_NEAR(keyframe.image.x[i], pixel.x(), 0.01);
        EXPECT_NEAR(keyframe.image.y[i], pixel.y(), 0.01);
        furthest = std::max(furthest, (expected - original.points.at(i)).norm());
    }
    EXPECT_GT(furthest, 0.003);
    setRowMotion(keyframe, original.row_motion, camera);
    for (std::size_t i = 0; i < keyframe.size(); ++i)
        EXPECT_LT((keyframe.points.at(i) - original.points.at(i)).norm(), 0.03 * furthest)
            << "to first order";
}

TEST(PackedKeyframe, PointsComeBackFarBelowTheNoise) {
    const MapKeyframe original = someKeyframe();
    ASSERT_GT(original.size(), 200U);
    const KeyframeEdges keyframe = PackedKeyframe(original).unpacked(mappingCamera(), SensorOptions());
    ASSERT_EQ(keyframe.size(), original.size());
    EXPECT_EQ(keyframe.image.begin, original.image.begin);
    EXPECT_EQ(keyframe.image.edge_of, original.image.edge_of);
    for (std::size_t i = 0; i < original.size(); ++i) {
        EXPECT_NEAR(keyframe.image.x[i], original.image.x[i], 0.01);
        EXPECT_NEAR(keyframe.image.y[i], original.image.y[i], 0.01);
        EXPECT_NEAR(keyframe.image.normal_x[i], original.image.normal_x[i], 1e-4);
        EXPECT_NEAR(keyframe.image.normal_y[i], original.image.normal_y[i], 1e-4);
        const double z = static_cast<double>(original.points.z[i]);
        EXPECT_NEAR(static_cast<double>(keyframe.points.z[i]), z, 2e-5 * z * z)
            << "depth noise is 1e-3 z^2 and more";
        EXPECT_LT((keyframe.points.at(i) - original.points.at(i)).norm(), 3e-5 * z * z + 2e-5 * z);
        EXPECT_NEAR(keyframe.weight[i], original.weight[i], 1e-3);
        EXPECT_NEAR(keyframe.slope[i], original.slope[i], 1e-4);
        EXPECT_EQ(keyframe.colours[i], original.colours[i]);
    }
}

TEST(PackedKeyframe, WhatTheKernelsReadBeyondTheEndIsPaddedAsInANewKeyframe) {
    const MapKeyframe original = someKeyframe();
    const KeyframeEdges keyframe = PackedKeyframe(original).unpacked(mappingCamera(), SensorOptions());
    ASSERT_EQ(keyframe.points.z.size(), kernels::paddedSize(original.size()));
    for (std::size_t i = keyframe.size(); i < keyframe.points.z.size(); ++i) {
        EXPECT_EQ(keyframe.points.x[i], 0);
        EXPECT_EQ(keyframe.points.z[i], 1) << "never divided by zero";
    }
}

TEST(PackedKeyframe, WithoutPointsIsNotAFault) {
    const KeyframeEdges back = PackedKeyframe(MapKeyframe()).unpacked(mappingCamera(), SensorOptions());
    EXPECT_EQ(back.size(), 0U);
    EXPECT_EQ(back.image.numEdges(), 0);
}

TEST(PackedKeyframe, OnlyTheNewestKeepTheirPointsAndTheMapHasThemAll) {
    OdometryOptions options;
    options.mapping.window = 4;
    LocalMapper mapper(mappingCamera(), options);
    const auto curves = room();
    for (int k = 0; k < 9; ++k)
        mapper.insert(
            makeKeyframe(k, placeOnPath(k), curves, seeAll(curves, std::fmod(0.37 * k, 1.0))).keyframe);
    std::size_t held = 0;
    for (const auto& [id, keyframe] : mapper.keyframes()) {
        EXPECT_EQ(keyframe.size() > 0, id >= 6) << id << ": the next window has the three newest";
        held += keyframe.size();
    }
    EXPECT_GT(held, 0U);
    std::set<int> seen;
    for (const MapEdge& edge : mapper.keyframeEdges()) {
        seen.insert(edge.keyframe_id);
        for (const Eigen::Vector3f& point : edge.points) EXPECT_TRUE(point.allFinite());
    }
    EXPECT_EQ(seen.size(), 9U);
    EXPECT_GE(mapper.fusedMap().size(), curves.size());
}

}  // namespace
}  // namespace roevo
