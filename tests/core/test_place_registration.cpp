// Registration of a frame to a keyframe by their edges alone, and what is not accepted.
#include <gtest/gtest.h>

#include <cmath>
#include <opencv2/imgproc.hpp>

#include "core/support/place_views.h"
#include "core/support/random_pose.h"
#include "core/support/simulated.h"
#include "mapping/map_keyframe.h"
#include "place/place_evidence.h"
#include "tracking/camera_scale.h"
#include "tracking/rolling_shutter.h"

namespace roevo {
namespace {

using namespace testing;

class PlaceRegistration : public ::testing::Test {
  protected:
    static void SetUpTestSuite() {
        const Sequence sequence = simulate(smallRoom(), 20);
        camera_ = sequence.camera;
        keyframe_ = makePlaceView(camera_, sequence.frames[0], sequence.truth[0].T_world_camera, 0);
        frame_ = makePlaceView(camera_, sequence.frames[19], sequence.truth[19].T_world_camera, 19);
    }
    static void TearDownTestSuite() {
        keyframe_.reset();
        frame_.reset();
    }
    static Pose truth() { return frame_->T_world_camera.inverse() * keyframe_->T_world_camera; }
    static EdgeRegistration from(const Pose& start) {
        return EdgeRegistrar(camera_, OdometryOptions(), false)
            .registerEdges(keyframe_->keyframe, frame_->frame, frame_->keyframe.edges, start);
    }

    static PinholeCamera camera_;
    static std::unique_ptr<PlaceView> keyframe_, frame_;
};
PinholeCamera PlaceRegistration::camera_;
std::unique_ptr<PlaceView> PlaceRegistration::keyframe_, PlaceRegistration::frame_;

TEST_F(PlaceRegistration, ConvergesFromWhatSimilarPointsTell) {
    ASSERT_GT(poseError(truth(), Pose::Identity()), 0.05) << "else the case tests little";
    for (int seed = 0; seed < 5; ++seed) {
        std::mt19937 random(static_cast<std::mt19937::result_type>(seed));
        const EdgeRegistration found = from(randomPose(random, 0.02, 0.012) * truth());
        EXPECT_TRUE(confirms(found, {})) << seed;
        EXPECT_LT(poseError(found.T_frame_keyframe, truth()), 0.004) << seed;
        EXPECT_GT(found.keyframe_matched, 0.7);
        EXPECT_GT(found.frame_matched, 0.7);
        EXPECT_GT(found.depth_agreement, 0.8);
        EXPECT_LT(std::sqrt(found.covariance.topLeftCorner<3, 3>().trace()), 0.01);
    }
}

/// How the rows of a frame moved, as the frames beside it tell.
RowMotion rowsOf(const Sequence& sequence, std::size_t i, double readout) {
    const StampedPose &before = sequence.truth[i - 1], &after = sequence.truth[i + 1];
    const Velocity velocity = velocityOf(before.T_world_camera.inverse() * after.T_world_camera,
                                         after.timestamp - before.timestamp);
    return {velocity.linear, velocity.turn, readout / sequence.camera.height,
            (sequence.camera.height - 1) / 2.};
}

TEST(PlaceRegistrationOfRows, ThatMovedInBothImagesBringsBothToOneMoment) {
    constexpr double kReadout = 0.1;  // s
    simulator::SimulationOptions options = smallRoom();
    options.rolling_shutter = kReadout;
    options.fps = 10;
    options.speed = 2;
    const Sequence sequence = simulate(options, 31);
    constexpr std::size_t kKeyframe = 20, kFrame = 21;
    const auto viewOf = [&](std::size_t i) {
        return makePlaceView(sequence.camera, sequence.frames[i], sequence.truth[i].T_world_camera,
                             static_cast<int>(i));
    };
    const auto keyframe = viewOf(kKeyframe), frame = viewOf(kFrame);
    keyframe->keyframe.setRowMotion(rowsOf(sequence, kKeyframe, kReadout));
    const Pose truth = frame->T_world_camera.inverse() * keyframe->T_world_camera;
    EdgeRegistrar registrar(sequence.camera, OdometryOptions(), false);
    const auto registered = [&](const RowMotion& rows) {
        Keyframe own = frame->keyframe;
        own.setRowMotion(rows);
        return registrar.registerEdges(keyframe->keyframe, frame->frame, own.edges, truth, rows);
    };
    const EdgeRegistration moved = registered(rowsOf(sequence, kFrame, kReadout)), still = registered({});
    EXPECT_LT(poseError(moved.T_frame_keyframe, truth), 0.004);
    EXPECT_LT(poseError(moved.T_frame_keyframe, truth), poseError(still.T_frame_keyframe, truth) / 2);
    EXPECT_GT(moved.keyframe_matched, 0.9);
    // Rows that are still move alike in both images, and are a fair way to look back, too
    EXPECT_GT(moved.frame_matched, still.frame_matched - 0.002);
}

/// One of so many points of its edges.
Keyframe thinnedBy(std::size_t every, const Keyframe& keyframe, const PinholeCamera& camera) {
    const std::size_t whole = keyframe.edges.size();
    const MapKeyframe kept =
        toMapKeyframe(keyframe, std::vector<Rgb>(whole), camera, static_cast<int>(whole / every));
    EXPECT_LT((every - 1) * kept.size(), whole);
    Keyframe thinned;
    thinned.median_depth = kept.median_depth;
    thinned.edges.image = kept.image;
    thinned.edges.points = kept.points;
    thinned.edges.weight = kept.weight;
    thinned.edges.correction.assign(kept.size(), 0);
    for (int e = 0; e < kept.image.numEdges(); ++e) thinned.clusters.push_back(e);
    return thinned;
}

TEST_F(PlaceRegistration, BentEdgesOfAThinnedKeyframeAreFoundInLargeImages) {
    const PinholeCamera camera{1920, 1440, 1575, 1575, 959.5, 719.5, {}};
    constexpr double kLength = 192, kBend = 40 * kDegree;  // px
    std::mt19937 random(1);
    const auto uniform = [&](double low, double high) {
        return std::uniform_real_distribution<double>(low, high)(random);
    };
    Keyframe keyframe;
    EdgePoints3D& edges = keyframe.edges;
    for (int edge = 0; edge < 200; ++edge) {
        double direction = uniform(0, 2 * kPi), u = uniform(220, 1700), v = uniform(220, 1220);
        for (int i = 0; i < kLength; ++i) {
            edges.image.addPoint(static_cast<float>(u), static_cast<float>(v),
                                 static_cast<float>(-std::sin(direction)),
                                 static_cast<float>(std::cos(direction)), 10);
            edges.points.add(camera.backProject(u, v, uniform(1.5, 2.5)));
            edges.weight.push_back(1);
            edges.correction.push_back(0);
            edges.source.push_back(static_cast<std::int32_t>(edges.source.size()));
            direction += kBend / kLength;
            u += std::cos(direction);
            v += std::sin(direction);
        }
        edges.image.finishEdge();
    }
    computeNormals(edges.image, scaledTo(camera, {}).edges.tangent_span);
    edges.points.pad();
    keyframe.median_depth = 2;
    Frame frame;
    frame.edges = edges.image;
    frame.grid.build(frame.edges, camera.width, camera.height);
    const Keyframe thinned = thinnedBy(15, keyframe, camera);
    const EdgeRegistration found =
        EdgeRegistrar(camera, OdometryOptions(), true).registerEdges(thinned, frame, edges, Pose());
    EXPECT_GT(found.inliers, 0.8 * static_cast<double>(thinned.edges.size()));
    EXPECT_GT(found.keyframe_matched, 0.9);
    EXPECT_LT(poseError(found.T_frame_keyframe, Pose()), 1e-3);
}

TEST_F(PlaceRegistration, EdgesOfAThinnedKeyframeAreFoundAsThoseOfAWholeOne) {
    const Keyframe thinned = thinnedBy(5, keyframe_->keyframe, camera_);
    const auto matched = [&](bool says_so) {
        return EdgeRegistrar(camera_, OdometryOptions(), says_so)
            .registerEdges(thinned, frame_->frame, frame_->keyframe.edges, truth())
            .keyframe_matched;
    };
    const double of_whole = from(truth()).keyframe_matched;
    EXPECT_GT(matched(true), 0.9 * of_whole);
    EXPECT_LT(matched(false), 0.9 * of_whole) << "or the votes make no difference, and the case tests little";
}

TEST_F(PlaceRegistration, IsNotConfirmedSomewhereElse) {
    for (int seed = 0; seed < 10; ++seed) {
        std::mt19937 random(static_cast<std::mt19937::result_type>(seed));
        Vector6d xi = Vector6d::Zero();
        xi[0] = uniform(random, 0.4, 0.8);
        xi[4] = uniform(random, 0.2, 0.5);
        const EdgeRegistration found = from(poseIncrement(xi) * truth());
        EXPECT_FALSE(confirms(found, {}) && poseError(found.T_frame_keyframe, truth()) > 0.05) << seed;
    }
}

TEST_F(PlaceRegistration, SameBytesWhateverCameBefore) {
    EdgeRegistrar registrar(camera_, OdometryOptions(), false);
    const auto run = [&](const Pose& start) {
        return registrar.registerEdges(keyframe_->keyframe, frame_->frame, frame_->keyframe.edges, start);
    };
    const EdgeRegistration first = run(truth());
    (void)run(Pose::Identity());
    EXPECT_EQ(run(truth()).T_frame_keyframe.matrix(), first.T_frame_keyframe.matrix());
    EXPECT_EQ(run(truth()).covariance, first.covariance);
}

TEST_F(PlaceRegistration, ParallelEdgesAloneConfirmNothing) {
    // A wall of upright stripes: nothing tells how high the camera is
    RgbdFrame stripes;
    stripes.timestamp = 1;
    stripes.grey = cv::Mat(camera_.height, camera_.width, CV_8UC1, cv::Scalar(60));
    stripes.depth = cv::Mat(camera_.height, camera_.width, CV_32FC1, cv::Scalar(2));
    for (int u = 13; u < camera_.width - 20; u += 37)
        cv::rectangle(stripes.grey, cv::Rect(u, 0, 11, camera_.height), cv::Scalar(200), cv::FILLED);
    const auto view = makePlaceView(camera_, stripes, Pose::Identity(), 0);
    ASSERT_GT(view->keyframe.edges.size(), 500U);
    const EdgeRegistration found =
        EdgeRegistrar(camera_, OdometryOptions(), false)
            .registerEdges(view->keyframe, view->frame, view->keyframe.edges, Pose::Identity());
    EXPECT_FALSE(confirms(found, {}));
}

TEST_F(PlaceRegistration, EvidenceIsWhatSurroundsThePointsAndThatEdgesHoldThePose) {
    Verification points;
    points.matches = 40;
    points.inliers = 20;
    EdgeRegistration edges;
    edges.held = true;
    edges.depth_agreement = 0.7;
    edges.keyframe_matched = 0.9;
    edges.frame_matched = 0.79;
    edges.visible = 0.49;
    const Likeness same{100, 99}, similar{100, 98}, twin{100, 97}, other{100, 79}, little{29, 29};
    EXPECT_EQ(evidenceOf(points, edges, same), Evidence::kConclusive);
    EXPECT_EQ(evidenceOf(points, edges, similar), Evidence::kStrong);
    EXPECT_EQ(evidenceOf(points, edges, twin), Evidence::kPlausible) << "another door of the same kind";
    EXPECT_EQ(evidenceOf(points, edges, other), Evidence::kNone);
    EXPECT_EQ(evidenceOf(points, edges, little), Evidence::kNone);
    edges.frame_matched = 0.8;
    EXPECT_EQ(evidenceOf(points, edges, other), Evidence::kFitting) << "seen from elsewhere";
    edges.visible = 0.5;
    EXPECT_EQ(evidenceOf(points, edges, other), Evidence::kNone);
    points.inliers = 19;
    EXPECT_EQ(evidenceOf(points, edges, twin), Evidence::kWeak);
    EXPECT_EQ(evidenceOf(points, edges, same), Evidence::kConclusive);
    points.inliers = 15;
    EXPECT_EQ(evidenceOf(points, edges, same), Evidence::kWeak) << "furniture seen from its other side";
    edges.held = false;
    EXPECT_EQ(evidenceOf(points, edges, same), Evidence::kNone);
    edges.held = true;
    edges.depth_agreement = 0.69;
    EXPECT_EQ(evidenceOf(points, edges, same), Evidence::kNone);
}

TEST_F(PlaceRegistration, WhatTrackingSaysIsConfirmedByEdgesDepthsAndSurroundings) {
    EdgeRegistration edges;
    edges.held = true;
    edges.keyframe_matched = 0.61;
    edges.frame_matched = 0.69;
    edges.depth_agreement = 0.64;
    const Likeness same{100, 97}, other{100, 62}, unknown{29, 0};
    EXPECT_TRUE(confirms(edges, same)) << "around the cabinet";
    EXPECT_TRUE(confirms(edges, unknown));
    EXPECT_FALSE(confirms(edges, other)) << "0.8 m off along a row of shadows";
    edges.depth_agreement = 0.57;
    EXPECT_FALSE(confirms(edges, same)) << "another door";
    edges.depth_agreement = 0.64;
    edges.frame_matched = 0.34;
    EXPECT_FALSE(confirms(edges, same));
    edges.frame_matched = 0.69;
    edges.held = false;
    EXPECT_FALSE(confirms(edges, same));
}

}  // namespace
}  // namespace roevo
