// The mapper as a whole: keyframes go in with drift, and come out at their places.
#include <gtest/gtest.h>
#include <sys/resource.h>

#include "core/support/mapping_world.h"
#include "mapping/local_mapper.h"

namespace roevo {
namespace {

using namespace testing;

class Mapper : public ::testing::Test {
  protected:
    /// Keyframe at its true place, or off it by `drift`.
    static MapKeyframe keyframeAt(int id, int place, const Pose& drift = Pose::Identity()) {
        const auto curves = room();
        TestKeyframe made =
            makeKeyframe(id, placeOnPath(place), curves, seeAll(curves, std::fmod(0.37 * id, 1.0)));
        made.keyframe.T_world_camera = made.keyframe.T_world_camera * drift;
        return made.keyframe;
    }
    /// Tracked from the one before: the pose is that of the parent, as the mapper has it, times the motion.
    static MapKeyframe tracked(int id, int place, int from, const Pose& error) {
        MapKeyframe keyframe = keyframeAt(id, place);
        keyframe.parent = id - 1;
        keyframe.T_parent_camera = placeOnPath(from).inverse() * placeOnPath(place) * error;
        return keyframe;
    }
    static double errorOf(const LocalMapper& mapper, int id, int place) {
        const Pose& found = mapper.keyframes().at(id).T_world_camera;
        return (found.translation() - placeOnPath(place).translation()).norm();
    }

    /// Why keyframes were left where they were, in words.
    static std::string reasonOf(const MapUpdate& update) {
        std::string text;
        for (const MapRefusal& refusal : update.refusals)
            text += (text.empty() ? "" : "; ") + describe(refusal);
        return text;
    }

    OdometryOptions options_;
};

TEST_F(Mapper, DriftedKeyframesArePulledBack) {
    LocalMapper mapper(mappingCamera(), options_);
    std::mt19937 random(1);
    double chained = 0;
    Pose dead_reckoned = placeOnPath(0);
    for (int k = 0; k < 10; ++k) {
        const Pose error = randomPose(random, 0.003, 0.2 * kDegree);
        const MapKeyframe keyframe = k == 0 ? keyframeAt(0, 0) : tracked(k, k, k - 1, error);
        if (k > 0) dead_reckoned = dead_reckoned * keyframe.T_parent_camera;
        const MapUpdate update = mapper.insert(keyframe);
        EXPECT_EQ(update.keyframe, k);
        EXPECT_EQ(reasonOf(update), "");
        EXPECT_EQ(update.poses.size(), static_cast<std::size_t>(k)) << "all but the first";
        for (const auto& [id, pose] : update.poses)
            EXPECT_EQ(pose.matrix(), mapper.keyframes().at(id).T_world_camera.matrix());
        chained = std::max(chained, (dead_reckoned.translation() - placeOnPath(k).translation()).norm());
    }
    double worst = 0;
    for (int k = 0; k < 10; ++k) worst = std::max(worst, errorOf(mapper, k, k));
    RecordProperty("chained_mm", std::to_string(1000 * chained));
    RecordProperty("mapped_mm", std::to_string(1000 * worst));
    EXPECT_GT(chained, 0.004);
    EXPECT_LT(worst, 4e-4);
}

TEST_F(Mapper, TheSameKeyframesGiveTheSameBits) {
    const auto run = [&] {
        LocalMapper mapper(mappingCamera(), options_);
        std::mt19937 random(2);
        std::vector<double> numbers;
        for (int k = 0; k < 5; ++k) {
            const MapUpdate update = mapper.insert(
                k == 0 ? keyframeAt(0, 0) : tracked(k, k, k - 1, randomPose(random, 0.003, 0.004)));
            for (const auto& [id, pose] : update.poses) {
                const Eigen::Matrix4d matrix = pose.matrix();
                numbers.insert(numbers.end(), matrix.data(), matrix.data() + 16);
            }
            for (const EdgeVerdict verdict : update.verdicts) numbers.push_back(static_cast<int>(verdict));
        }
        for (const MapEdge& edge : mapper.fusedMap()) {
            numbers.push_back(edge.cluster);
            for (const auto& p : edge.points) numbers.insert(numbers.end(), p.data(), p.data() + 3);
        }
        return numbers;
    };
    const auto first = run();
    EXPECT_GT(first.size(), 1000U);
    EXPECT_EQ(first, run());
}

TEST_F(Mapper, AKeyframeThatSeesNothingOfTheMapIsLeftWithAReason) {
    LocalMapper mapper(mappingCamera(), options_);
    for (int k = 0; k < 3; ++k) mapper.insert(keyframeAt(k, k));
    const std::vector<Curve> elsewhere{segment({-0.3, 0.32, 2.0}, {0.05, 0.45, 2.0})};
    MapKeyframe stranger = makeKeyframe(3, placeOnPath(3), elsewhere, seeAll(elsewhere)).keyframe;
    const MapUpdate update = mapper.insert(stranger);
    ASSERT_EQ(update.refusals.size(), 1U) << reasonOf(update);
    EXPECT_EQ(update.refusals[0].kind, MapRefusal::Kind::kFewObservations);
    EXPECT_EQ(update.refusals[0].keyframe, 3);
    EXPECT_LT(update.refusals[0].observations, options_.fine.min_inliers);
    EXPECT_EQ(mapper.keyframes().at(3).T_world_camera.matrix(), stranger.T_world_camera.matrix());
    for (const auto& [id, pose] : update.poses) EXPECT_NE(id, 3);
    for (int k = 0; k < 3; ++k) EXPECT_LT(errorOf(mapper, k, k), 2e-4);
}

TEST_F(Mapper, AKeyframeThatJumpsTooFarIsLeftWithAReason) {
    // What is too far goes by the depth: 14 mm are a correction at 2 m and astray at 10 cm
    Pose off = Pose::Identity();
    off.translation().z() = 0.014;
    for (const double depth : {2.0, 0.1}) {
        LocalMapper mapper(mappingCamera(), options_);
        for (int k = 0; k < 4; ++k) mapper.insert(keyframeAt(k, k));
        MapKeyframe drifted = keyframeAt(4, 4, off);
        drifted.median_depth = depth;
        const MapUpdate update = mapper.insert(drifted);
        if (depth > 1) {
            EXPECT_EQ(reasonOf(update), "");
            EXPECT_EQ(update.poses.back().first, 4);
            EXPECT_LT(errorOf(mapper, 4, 4), 4e-4);
            continue;
        }
        EXPECT_NE(reasonOf(update).find(
                      "left as it was, bundle adjustment moved it too far: keyframe 4 (14 mm, 0.0 deg)"),
                  std::string::npos)
            << reasonOf(update);
        EXPECT_EQ(mapper.keyframes().at(4).T_world_camera.matrix(), drifted.T_world_camera.matrix());
        for (const auto& [id, pose] : update.poses) EXPECT_NE(id, 4);
    }
}

TEST_F(Mapper, AKeyframeGoesWhereTheEdgesSayHoweverSureTrackingWas) {
    // 14 mm off what tracking said. Its sigmas know nothing of errors that all points share, so they weigh in
    // the window and forbid nothing: a rule that did so kept the map of whole recordings from mending their
    // drift.
    Pose error = Pose::Identity();
    error.translation().z() = 0.014;
    for (const double sigma : {0.01, 0.001}) {
        LocalMapper mapper(mappingCamera(), options_);
        for (int k = 0; k < 4; ++k) mapper.insert(keyframeAt(k, k));
        MapKeyframe keyframe = tracked(4, 4, 3, error);
        keyframe.parent_information = Matrix6d::Identity() / (sigma * sigma);
        EXPECT_EQ(reasonOf(mapper.insert(keyframe)), "");
        EXPECT_LT(errorOf(mapper, 4, 4), 1e-3) << sigma;
    }
}

TEST_F(Mapper, ThoseThatMoveWithARefusedKeyframeAreNotRefusedWithIt) {
    // Keyframe 3 was tracked 14 mm off, which is too far for its depth; keyframe 4 well, relative to 3, so
    // that it is as far off
    Pose error = Pose::Identity();
    error.translation().z() = 0.014;
    LocalMapper mapper(mappingCamera(), options_);
    for (int k = 0; k < 3; ++k) mapper.insert(keyframeAt(k, k));
    MapKeyframe wrong = tracked(3, 3, 2, error), child = tracked(4, 4, 3, Pose::Identity());
    wrong.median_depth = 0.1;
    EXPECT_NE(reasonOf(mapper.insert(wrong)), "");
    const MapUpdate update = mapper.insert(child);
    EXPECT_NE(reasonOf(update).find("keyframe 3 ("), std::string::npos) << reasonOf(update);
    EXPECT_EQ(reasonOf(update).find("keyframe 4 ("), std::string::npos) << reasonOf(update);
    EXPECT_LT(errorOf(mapper, 4, 4), 2e-3);
    EXPECT_NEAR(errorOf(mapper, 3, 3), 0.014, 1e-3);
}

TEST_F(Mapper, WhatIsRefusedKeepsWhatWasRefinedBefore) {
    options_.mapping.min_looks = 100;  // what others do not see is no illusion here
    options_.mapping.window = 4;
    options_.mapping.reuse_keyframes = false;
    const auto curves = room();
    const auto seen = [&](int id, int first, int step) {
        std::vector<Sighting> sightings;
        for (int c = first; c < static_cast<int>(curves.size()); c += step)
            sightings.push_back({c, 0, -1, 0, false, {0, 0}});
        MapKeyframe keyframe = makeKeyframe(id, placeOnPath(id), curves, sightings).keyframe;
        keyframe.parent = id - 1;
        keyframe.parent_information = 1e3 * Matrix6d::Identity();
        if (id > 0) keyframe.T_parent_camera = placeOnPath(id - 1).inverse() * placeOnPath(id);
        return keyframe;
    };
    LocalMapper mapper(mappingCamera(), options_);
    EXPECT_EQ(reasonOf(mapper.insert(seen(0, 0, 1))), "");
    EXPECT_EQ(reasonOf(mapper.insert(seen(1, 0, 2))), "");
    EXPECT_EQ(reasonOf(mapper.insert(seen(2, 1, 2))), "");
    MapKeyframe third = seen(3, 0, 2);  // sees what the first two see alone
    third.T_parent_camera = Pose(Eigen::Translation3d(0.003, 0, 0)) * third.T_parent_camera;
    EXPECT_EQ(reasonOf(mapper.insert(third)), "");
    EXPECT_EQ(reasonOf(mapper.insert(seen(4, 1, 2))), "");
    ASSERT_LT(errorOf(mapper, 3, 3), 0.001) << "else it is no test";
    const MapUpdate update = mapper.insert(seen(5, 1, 2));  // those two have left the window
    ASSERT_EQ(update.refusals.size(), 1U);
    EXPECT_EQ(update.refusals[0].keyframe, 3);
    EXPECT_LT(errorOf(mapper, 3, 3), 0.001);
}

TEST_F(Mapper, ComingBackFindsTheOldKeyframes) {
    options_.mapping.window = 4;
    double with = 0, without = 0;
    for (const bool reuse : {true, false}) {
        options_.mapping.reuse_keyframes = reuse;
        LocalMapper mapper(mappingCamera(), options_);
        // Away to where other curves are, and back; the drift of 12 mm comes in where the views change
        const std::vector<Sighting> here{{0}, {1}, {2}, {3}}, there{{4}, {5}, {6}, {7}};
        const auto curves = room();
        Pose drift = Pose::Identity();
        drift.translation() << 0.009, -0.006, 0.005;
        MapUpdate update;
        for (int id = 0; id < 12; ++id) {
            const bool away = id >= 4 && id < 11;
            const int place = away ? 4 : id % 4;
            TestKeyframe made =
                makeKeyframe(id, placeOnPath(id == 11 ? 1 : place), curves, away ? there : here);
            if (id >= 4) made.keyframe.T_world_camera = drift * made.keyframe.T_world_camera;
            update = mapper.insert(made.keyframe);
        }
        EXPECT_EQ(update.reused > 0, reuse);
        EXPECT_LE(update.reused, options_.mapping.max_reused);
        (reuse ? with : without) = errorOf(mapper, 11, 1);
    }
    EXPECT_LT(with, 5e-4);
    EXPECT_GT(without, 0.011);
}

TEST_F(Mapper, ReusedKeyframesHoldStill) {
    options_.mapping.window = 3;
    LocalMapper mapper(mappingCamera(), options_);
    for (int k = 0; k < 7; ++k) mapper.insert(keyframeAt(k, k % 3));
    Pose off = Pose::Identity();
    off.translation().x() = 0.005;
    const auto before = mapper.keyframes();
    const MapUpdate update = mapper.insert(keyframeAt(7, 1, off));
    ASSERT_GT(update.reused, 0);
    for (const auto& [id, pose] : update.poses) EXPECT_GE(id, 5) << "only those of the window move";
    for (int k = 0; k < 5; ++k)
        EXPECT_EQ(mapper.keyframes().at(k).T_world_camera.matrix(), before.at(k).T_world_camera.matrix());
    EXPECT_LT(errorOf(mapper, 7, 1), 5e-4);
}

TEST_F(Mapper, ATrackThatBeganAnewIsNotRelatedToTheOldOne) {
    // Re-anchored 40 mm off at a place that looks the same: nothing pulls one track to the other
    LocalMapper mapper(mappingCamera(), options_);
    for (int k = 0; k < 4; ++k) mapper.insert(keyframeAt(k, k));
    const auto before = mapper.keyframes();
    Pose off = Pose::Identity();
    off.translation().x() = 0.04;
    for (int k = 4; k < 9; ++k) {
        MapKeyframe keyframe = keyframeAt(k, k % 4);
        keyframe.T_world_camera = off * keyframe.T_world_camera;
        keyframe.track = 4;
        const MapUpdate update = mapper.insert(keyframe);
        EXPECT_EQ(reasonOf(update), "");
        for (const auto& [id, pose] : update.poses)
            EXPECT_GT(id, 4) << "the first of the track fixes the gauge";
    }
    for (int k = 0; k < 4; ++k)
        EXPECT_EQ(mapper.keyframes().at(k).T_world_camera.matrix(), before.at(k).T_world_camera.matrix());
    for (int k = 4; k < 9; ++k) {
        const Pose& found = mapper.keyframes().at(k).T_world_camera;
        EXPECT_LT((found.translation() - (off * placeOnPath(k % 4)).translation()).norm(), 4e-4) << k;
    }
    for (const MapEdge& edge : mapper.fusedMap()) EXPECT_LE(edge.views, 5);
}

TEST_F(Mapper, TheMapHasEveryCurveOnce) {
    LocalMapper mapper(mappingCamera(), options_);
    for (int k = 0; k < 6; ++k) mapper.insert(keyframeAt(k, k));
    const auto curves = room();
    const EdgeMap map = mapper.fusedMap();
    ASSERT_EQ(map.size(), curves.size());
    for (const MapEdge& edge : map) {
        EXPECT_EQ(edge.views, 6);
        EXPECT_EQ(edge.verdict, EdgeVerdict::kTrue);
        ASSERT_EQ(edge.colours.size(), edge.points.size());
        const auto& curve = curves[edge.colours[0][0]];
        // Curve 4 runs away from the camera: the depths of samples half a step apart differ most there
        const double bound = edge.colours[0][0] == 4 ? 1e-3 : 4e-4;
        for (const auto& p : edge.points) ASSERT_LT(distanceTo(curve, p.cast<double>()), bound);
    }
    EXPECT_EQ(mapper.keyframeEdges().size(), 6 * curves.size());
}

TEST_F(Mapper, TellsWhichEdgesTheTrackerShouldTrustLess) {
    // The border of a shadow that wanders 3 px across itself from keyframe to keyframe
    constexpr int kShadow = 2;
    const auto curves = room();
    LocalMapper mapper(mappingCamera(), options_);
    for (int k = 0; k < 5; ++k) {
        auto sightings = seeAll(curves, std::fmod(0.37 * k, 1.0));
        for (Sighting& sighting : sightings)
            if (sighting.curve == kShadow) sighting.shift = 3.0 * k * Eigen::Vector2d(0.857, -0.514);
        const TestKeyframe made = makeKeyframe(k, placeOnPath(k), curves, sightings);
        const MapUpdate update = mapper.insert(made.keyframe);
        if (k == 0) {
            EXPECT_TRUE(update.verdicts.empty()) << "one keyframe alone can judge nothing";
        }
        if (k < 4) continue;
        ASSERT_EQ(update.verdicts.size(), made.curve_of_edge.size());
        std::size_t of_shadow = 0;
        for (std::size_t i = 0; i < made.keyframe.size(); ++i) {
            const auto edge = static_cast<std::size_t>(made.keyframe.image.edge_of[i]);
            const bool is_shadow = made.curve_of_edge[edge] == kShadow;
            of_shadow += is_shadow ? 1 : 0;
            ASSERT_EQ(isPseudo(update.verdicts[edge]), is_shadow) << "point " << i;
        }
        EXPECT_GT(of_shadow, 100U);
    }
}

TEST_F(Mapper, TheMapTakesRoomForItsEdgesNotForPairsOfKeyframes) {
    const auto peakMegabytes = [] {
        rusage usage{};
        getrusage(RUSAGE_SELF, &usage);
        return static_cast<double>(usage.ru_maxrss) / 1024;
    };
    constexpr int kMany = 2000;  // 288 bytes for each pair of them were 1.1 GB
    LocalMapper mapper(mappingCamera(), options_);
    const TestKeyframe made = makeKeyframe(0, Pose(), {segment({-0.1, 0, 1.5}, {0.1, 0, 1.5})}, {{0}});
    const KeptKeyframe kept{PackedKeyframe(made.keyframe), 1.5, RowMotion(), {-1}, {}, {}};
    for (int id = 0; id < kMany; ++id) {
        const Pose place(Eigen::Translation3d(id, 0, 0));
        mapper.load({id, static_cast<double>(id), place}, KeptKeyframe(kept));
    }
    const double before = peakMegabytes();
    EXPECT_EQ(mapper.fusedMap().size(), static_cast<std::size_t>(kMany));
    EXPECT_LT(peakMegabytes() - before, 300);
}

}  // namespace
}  // namespace roevo
