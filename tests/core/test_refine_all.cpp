// All keyframes refined together, when a recording ends or there is time.
#include <gtest/gtest.h>

#include <map>
#include <optional>

#include "core/support/mapping_world.h"
#include "mapping/local_mapper.h"

namespace roevo {
namespace {

using namespace testing;

class RefineAll : public ::testing::Test {
  protected:
    /// Along the path and back, again and again.
    static int placeOf(int id) {
        constexpr int kPlaces = 12;
        const int at = id % (2 * kPlaces);
        return at < kPlaces ? at : 2 * kPlaces - 1 - at;
    }
    static MapKeyframe keyframeAt(int id, const Pose& error) {
        const auto curves = room();
        MapKeyframe keyframe =
            makeKeyframe(id, placeOnPath(placeOf(id)), curves, seeAll(curves, std::fmod(0.37 * id, 1.0)))
                .keyframe;
        if (id == 0) return keyframe;
        keyframe.parent = id - 1;
        keyframe.T_parent_camera = placeOnPath(placeOf(id - 1)).inverse() * placeOnPath(placeOf(id)) * error;
        return keyframe;
    }
    /// With windows so small that each is refined with the next one only.
    void map(int keyframes) {
        options_.mapping.window = 2;
        options_.mapping.reuse_keyframes = false;
        mapper_.emplace(mappingCamera(), options_);
        std::mt19937 random(4);
        for (int id = 0; id < keyframes; ++id)
            mapper_->insert(keyframeAt(id, randomPose(random, 0.003, 0.2 * kDegree)));
    }
    /// A second track of five keyframes, moved by `off` to where its last one was recognised.
    /// @return T_4_9, which was recognised, or that of another place
    Pose joinTracks(const Pose& off, double sigma, int place = 4, const Pose& error = Pose()) {
        for (int id = 5; id < 10; ++id) {
            MapKeyframe keyframe = keyframeAt(id, Pose::Identity());
            if (id == 5) keyframe.parent = -1, keyframe.track = 5;
            mapper_->insert(std::move(keyframe));
        }
        Correction join;
        for (int id = 5; id < 10; ++id) join.motions.emplace(id, off);
        const auto poseOf = [&](int id) { return mapper_->keyframes().at(id).T_world_camera; };
        const Pose recognised = poseOf(place).inverse() * off * poseOf(9) * error;
        join.places.push_back({place, 9, recognised, sigma * sigma * Matrix6d::Identity()});
        mapper_->correct(join);
        return recognised;
    }
    double worstError() const {
        double worst = 0;
        for (const auto& [id, keyframe] : mapper_->keyframes())
            worst = std::max(
                worst,
                (keyframe.T_world_camera.translation() - placeOnPath(placeOf(id)).translation()).norm());
        return worst;
    }

    OdometryOptions options_;
    std::optional<LocalMapper> mapper_;
};

TEST_F(RefineAll, BringsPerfectObservationsToTheTruth) {
    map(12);
    const double before = worstError();
    const MapUpdate update = mapper_->refineAll();
    RecordProperty("before_mm", std::to_string(1000 * before));
    RecordProperty("after_mm", std::to_string(1000 * worstError()));
    EXPECT_TRUE(update.refusals.empty());
    EXPECT_GT(before, 2e-4);
    EXPECT_LT(worstError(), before / 2);
    EXPECT_LT(worstError(), 1.5e-4);
    EXPECT_EQ(update.poses.size(), 11U) << "all but the first";
    for (const auto& [id, pose] : update.poses)
        EXPECT_EQ(pose.matrix(), mapper_->keyframes().at(id).T_world_camera.matrix());
    EXPECT_EQ(mapper_->keyframes().at(0).T_world_camera.matrix(), placeOnPath(0).matrix());
}

TEST_F(RefineAll, TracksThatTookTurnsAreRefinedEachByItself) {
    options_.mapping.window = 2;
    mapper_.emplace(mappingCamera(), options_);
    for (int id = 0; id < 14; ++id) {
        MapKeyframe keyframe = keyframeAt(id, Pose::Identity());
        keyframe.track = id >= 5 && id < 9 ? 5 : 0;  // lost, begun anew, and found in the old one
        if (id == 5) keyframe.parent = -1;
        if (id == 9) {
            keyframe.parent = 4;
            keyframe.T_parent_camera = placeOnPath(placeOf(4)).inverse() * placeOnPath(placeOf(9));
        }
        mapper_->insert(std::move(keyframe));
    }
    Correction loop;  // within the younger track
    const auto poseOf = [&](int id) { return mapper_->keyframes().at(id).T_world_camera; };
    loop.places.push_back({5, 8, poseOf(5).inverse() * poseOf(8), 1e-4 * Matrix6d::Identity()});
    for (const int id : {5, 6, 7, 8}) loop.motions.emplace(id, Pose::Identity());
    mapper_->correct(loop);
    const MapUpdate update = mapper_->refineAll();
    EXPECT_TRUE(update.refusals.empty());
    std::map<int, int> times;
    for (const auto& [id, pose] : update.poses) ++times[id];
    EXPECT_EQ(times.size(), 12U);
    for (const auto& [id, count] : times) EXPECT_EQ(count, 1) << id;
}

TEST_F(RefineAll, KeyframesMayFollow) {
    map(8);
    mapper_->refineAll();
    for (int id = 8; id < 12; ++id) {
        const MapUpdate update = mapper_->insert(keyframeAt(id, Pose::Identity()));
        EXPECT_TRUE(update.refusals.empty());
    }
    EXPECT_LT(worstError(), 4e-4);
}

TEST_F(RefineAll, EachTrackKeepsItsFirstKeyframe) {
    map(5);
    for (int id = 5; id < 10; ++id) {
        MapKeyframe keyframe = keyframeAt(id, Pose::Identity());
        if (id == 5) keyframe.parent = -1, keyframe.track = 5;  // as after a loss
        mapper_->insert(std::move(keyframe));
    }
    const Pose begin = mapper_->keyframes().at(5).T_world_camera;
    const MapUpdate update = mapper_->refineAll();
    for (const auto& [id, pose] : update.poses) EXPECT_TRUE(id != 0 && id != 5) << id;
    EXPECT_EQ(update.poses.size(), 8U);
    EXPECT_EQ(mapper_->keyframes().at(5).T_world_camera.matrix(), begin.matrix());
}

TEST_F(RefineAll, WhatWasRecognisedHoldsAJoinedTrack) {
    map(5);
    const Pose so_far(Eigen::Quaterniond::Identity(), {0.3, 0, 0});  // that no edges are related
    const Pose T_4_9 = joinTracks(so_far, 1e-4);
    mapper_->refineAll();
    const Pose now =
        mapper_->keyframes().at(4).T_world_camera.inverse() * mapper_->keyframes().at(9).T_world_camera;
    EXPECT_LT((now.translation() - T_4_9.translation()).norm(), 0.001);
}

TEST_F(RefineAll, WhatWasRecognisedHoldsAcrossTheParts) {
    map(5);
    const Pose so_far(Eigen::Quaterniond::Identity(), {0.3, 0, 0});
    const Pose T_2_9 = joinTracks(so_far, 1e-4, 2, Pose(Eigen::Quaterniond::Identity(), {0.01, 0, 0}));
    mapper_->refineAll(5);  // the last part is of 5 to 9
    const Pose now =
        mapper_->keyframes().at(2).T_world_camera.inverse() * mapper_->keyframes().at(9).T_world_camera;
    EXPECT_LT((now.translation() - T_2_9.translation()).norm(), 0.001);
}

TEST_F(RefineAll, EdgesOfAJoinedTrackAreRelatedToTheOldOnes) {
    mapper_.emplace(mappingCamera(), options_);
    for (int id = 0; id < 5; ++id) mapper_->insert(keyframeAt(id, Pose::Identity()));
    joinTracks(Pose(Eigen::Quaterniond::Identity(), {0.008, 0, 0}), 0.01);
    EXPECT_GT(worstError(), 0.007);
    EXPECT_TRUE(mapper_->refineAll().refusals.empty());
    EXPECT_LT(worstError(), 5e-4) << "edges know better than what was recognised";
}

TEST_F(RefineAll, ReportsWhereAllKeyframesAreEvenThoseThatWereLeft) {
    map(4);
    const std::vector<Curve> elsewhere{segment({-0.3, 0.32, 2.0}, {0.05, 0.45, 2.0})};
    MapKeyframe stranger = makeKeyframe(4, placeOnPath(placeOf(4)), elsewhere, seeAll(elsewhere)).keyframe;
    stranger.parent = 0;
    stranger.T_parent_camera = placeOnPath(0).inverse() * placeOnPath(placeOf(4));
    mapper_->insert(std::move(stranger));
    const MapUpdate update = mapper_->refineAll();
    ASSERT_EQ(update.refusals.size(), 1U);
    EXPECT_EQ(update.refusals[0].keyframe, 4);
    ASSERT_EQ(update.poses.size(), 4U);
    for (const auto& [id, pose] : update.poses)
        EXPECT_EQ(pose.matrix(), mapper_->keyframes().at(id).T_world_camera.matrix()) << id;
}

TEST_F(RefineAll, LongTracksAreRefinedInPartsThatOverlap) {
    options_.mapping.final_rounds = 1;
    map(230);
    const double before = worstError();
    const MapUpdate update = mapper_->refineAll(100);
    RecordProperty("before_mm", std::to_string(1000 * before));
    RecordProperty("after_mm", std::to_string(1000 * worstError()));
    std::map<int, int> times;
    for (const auto& [id, pose] : update.poses) {
        ASSERT_TRUE(pose.isFinite());
        ++times[id];
    }
    EXPECT_EQ(times.size(), 229U);
    for (const auto& [id, count] : times) EXPECT_EQ(count, id > 50 && id <= 200 ? 2 : 1) << id;
    EXPECT_LE(worstError(), before);
}

// Else the first part goes back to where it was before a loop was closed, and the last one takes all of the
// gap.
TEST_F(RefineAll, APartIsHeldByWhatFollowsIt) {
    options_.mapping.final_rounds = 1;
    map(12);
    const auto offset = [](int id, const Pose& pose) {
        return (pose.translation() - placeOnPath(placeOf(id)).translation()).x();
    };
    Correction loop;
    for (int id = 1; id < 12; ++id)
        loop.motions.emplace(id, Pose(Eigen::Quaterniond::Identity(), {0.0005 * id, 0, 0}));
    const auto poseOf = [&](int id) { return mapper_->keyframes().at(id).T_world_camera; };
    loop.places.push_back(
        {0, 11, poseOf(0).inverse() * loop.motions.at(11) * poseOf(11), 1e-4 * Matrix6d::Identity()});
    mapper_->correct(loop);
    ASSERT_GT(offset(6, mapper_->keyframes().at(6).T_world_camera), 0.0025);
    const MapUpdate update = mapper_->refineAll(6);
    const auto of_sixth = std::find_if(update.poses.begin(), update.poses.end(),
                                       [](const auto& pose) { return pose.first == 6; });
    ASSERT_NE(of_sixth, update.poses.end());
    EXPECT_GT(offset(6, of_sixth->second), 0.0015) << "in the first part, which it is the last one of";
}

TEST_F(RefineAll, NothingMovesWithoutRounds) {
    options_.mapping.final_rounds = 0;
    map(6);
    EXPECT_TRUE(mapper_->refineAll().poses.empty());
}

}  // namespace
}  // namespace roevo
