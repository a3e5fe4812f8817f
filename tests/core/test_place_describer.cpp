// Points that a keyframe is recognised by: where they are, and what their descriptors do not depend on.
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <opencv2/imgproc.hpp>

#include "core/support/place_views.h"
#include "core/support/random_pose.h"
#include "core/support/simulated.h"
#include "place/place_matches.h"
#include "place/sampling_pattern.h"

namespace roevo {
namespace {

using namespace testing;

/// A square image: dark and bright boxes at random places, wall at a given depth.
RgbdFrame boxes(int size, double depth) {
    RgbdFrame out;
    out.timestamp = 1;
    out.grey = cv::Mat(size, size, CV_8UC1, cv::Scalar(128));
    out.depth = cv::Mat(size, size, CV_32FC1, cv::Scalar(depth));
    std::mt19937 random(3);
    for (int k = 0; k < 60; ++k) {
        const cv::Rect box(
            static_cast<int>(uniform(random, 0, size - 60)), static_cast<int>(uniform(random, 0, size - 60)),
            static_cast<int>(uniform(random, 15, 60)), static_cast<int>(uniform(random, 15, 60)));
        cv::rectangle(out.grey, box, cv::Scalar(uniform(random, 20, 235)), cv::FILLED);
    }
    cv::GaussianBlur(out.grey, out.grey, cv::Size(5, 5), 0.8);
    return out;
}

PinholeCamera squareCamera(int size) {
    PinholeCamera camera;
    camera.width = camera.height = size;
    camera.fx = camera.fy = 525;
    camera.cx = camera.cy = (size - 1) / 2.;
    return camera;
}

std::unique_ptr<PlaceView> viewOf(const RgbdFrame& images) {
    return makePlaceView(squareCamera(images.grey.cols), images, Pose::Identity(), 0);
}

/// Of the points with a counterpart next to where `moved` puts them: how many bits differ, sorted.
template <class Moved>
std::vector<int> distancesAtSamePlace(const PlacePoints& from, const PlacePoints& to, const Moved& moved,
                                      double turn) {
    std::vector<int> out;
    for (const PlacePoint& point : from) {
        const Eigen::Vector2d place = moved(Eigen::Vector2d(point.u, point.v));
        for (const PlacePoint& other : to) {
            if ((place - Eigen::Vector2d(other.u, other.v)).norm() > 1.5) continue;
            const auto difference =
                static_cast<double>(other.normal_angle) - static_cast<double>(point.normal_angle) - turn;
            if (std::abs(std::remainder(difference, 2 * kPi)) > 0.2) continue;
            out.push_back(hammingDistance(point.descriptor, other.descriptor));
            break;
        }
    }
    std::sort(out.begin(), out.end());
    return out;
}

constexpr int kSize = 400;

TEST(PlaceDescriber, PatternComparesDifferentPairsOfSitesWithinTheRadius) {
    const SamplingPattern& pattern = samplingPattern();
    for (const auto& site : pattern.sites) EXPECT_LE(std::hypot(site.along_normal, site.along_edge), 1.0001F);
    std::vector<int> pairs;
    for (const auto& pair : pattern.comparisons) {
        ASSERT_LT(pair.first, pair.second);
        ASSERT_LT(pair.second, SamplingPattern::kSites);
        pairs.push_back(pair.first * SamplingPattern::kSites + pair.second);
    }
    std::sort(pairs.begin(), pairs.end());
    EXPECT_EQ(std::adjacent_find(pairs.begin(), pairs.end()), pairs.end());
}

TEST(PlaceDescriber, PointsAreEdgePointsSpreadOverTheImageAndNotTooMany) {
    const auto view = viewOf(boxes(kSize, 2));
    ASSERT_GT(view->points.size(), 100U);
    EXPECT_LE(view->points.size(), kMaxPlacePoints);
    int quadrant[4] = {};
    for (const PlacePoint& point : view->points) {
        ++quadrant[(point.u > kSize / 2. ? 1 : 0) + (point.v > kSize / 2. ? 2 : 0)];
        EXPECT_NEAR(point.z, 2, 0.01);
        EXPECT_NEAR(point.x, (static_cast<double>(point.u) - (kSize - 1) / 2.) / 525 * 2, 0.01);
    }
    for (const int count : quadrant) EXPECT_GT(count, 15);
}

TEST(PlaceDescriber, AStraightEdgeHasPointsAtItsCornersOnly) {
    RgbdFrame images = boxes(kSize, 2);
    images.grey.setTo(60);
    cv::rectangle(images.grey, cv::Rect(100, 120, 180, 140), cv::Scalar(200), cv::FILLED);
    const auto view = viewOf(images);
    ASSERT_GE(view->points.size(), 4U);
    // The strongest ones; along a side nothing tells one place from the next
    for (std::size_t k = 0; k < 4; ++k) {
        const PlacePoint& point = view->points[k];
        const double du = std::min(std::abs(point.u - 100.F), std::abs(point.u - 279.F)),
                     dv = std::min(std::abs(point.v - 120.F), std::abs(point.v - 259.F));
        EXPECT_LT(std::max(du, dv), 6) << point.u << " " << point.v;
    }
}

TEST(PlaceDescriber, NothingIsFoundOnAWhiteWall) {
    RgbdFrame images = boxes(kSize, 2);
    images.grey.setTo(230);
    EXPECT_TRUE(viewOf(images)->points.empty());
}

TEST(PlaceDescriber, SameBytesWhateverCameBefore) {
    const auto one = viewOf(boxes(kSize, 2)), other = viewOf(boxes(300, 1.5));
    PlaceDescriber describer(squareCamera(kSize));
    for (int k = 0; k < 2; ++k) {
        (void)describer.describe(other->keyframe.edges, other->frame.pyramid.level(0));
        const PlacePoints points = describer.describe(one->keyframe.edges, one->frame.pyramid.level(0));
        ASSERT_EQ(points.size(), one->points.size());
        EXPECT_EQ(std::memcmp(points.data(), one->points.data(), points.size() * sizeof(PlacePoint)), 0);
    }
}

TEST(PlaceDescriber, DescriptorsTurnWithTheImage) {
    RgbdFrame turned = boxes(kSize, 2);
    cv::rotate(turned.grey, turned.grey, cv::ROTATE_90_CLOCKWISE);  // (u, v) -> (size - 1 - v, u)
    const auto before = viewOf(boxes(kSize, 2)), after = viewOf(turned);
    const auto distances = distancesAtSamePlace(
        before->points, after->points,
        [](const Eigen::Vector2d& p) { return Eigen::Vector2d(kSize - 1 - p.y(), p.x()); }, kPi / 2);
    ASSERT_GT(distances.size(), before->points.size() / 2);
    EXPECT_LE(distances[distances.size() / 2], 16);
}

TEST(PlaceDescriber, PatchesHaveOneSizeInMetres) {
    // Half as far away, everything is twice as large
    const RgbdFrame far = boxes(kSize, 4);
    RgbdFrame near = far;
    cv::resize(far.grey, near.grey, cv::Size(), 2, 2, cv::INTER_CUBIC);
    near.depth = cv::Mat(2 * kSize, 2 * kSize, CV_32FC1, cv::Scalar(2));
    const auto small = viewOf(far), large = viewOf(near);
    const auto distances = distancesAtSamePlace(
        large->points, small->points,
        [](const Eigen::Vector2d& p) { return Eigen::Vector2d((p.array() + 0.5) / 2 - 0.5); }, 0);
    ASSERT_GT(distances.size(), 50U);
    EXPECT_LE(distances[distances.size() / 2], 32);
    // Told that it is as far away, the patches show half as much
    near.depth.setTo(4);
    const auto wrong = distancesAtSamePlace(
        viewOf(near)->points, small->points,
        [](const Eigen::Vector2d& p) { return Eigen::Vector2d((p.array() + 0.5) / 2 - 0.5); }, 0);
    EXPECT_GT(wrong[wrong.size() / 2], distances[distances.size() / 2] + 15);
}

TEST(PlaceDescriber, BrightnessAndContrastDoNotMatter) {
    RgbdFrame dim = boxes(kSize, 2);
    dim.grey.convertTo(dim.grey, -1, 0.7, 20);
    const auto before = viewOf(boxes(kSize, 2)), after = viewOf(dim);
    const auto distances = distancesAtSamePlace(
        before->points, after->points, [](const Eigen::Vector2d& p) { return p; }, 0);
    ASSERT_GT(distances.size(), before->points.size() * 2 / 3);
    EXPECT_LE(distances[distances.size() / 2], 12);
}

TEST(PlaceDescriber, SimulatedFramesMatchWhereTheyShould) {
    const Sequence sequence = simulate(smallRoom(), 25);
    const auto first = makePlaceView(sequence.camera, sequence.frames.front(),
                                     sequence.truth.front().T_world_camera, 0),
               last = makePlaceView(sequence.camera, sequence.frames.back(),
                                    sequence.truth.back().T_world_camera, 24);
    const Pose T = first->T_world_camera.inverse() * last->T_world_camera;
    const std::vector<PlaceMatch> matches = matchPlaces(last->points, first->points);
    int right = 0;
    for (const PlaceMatch& match : matches) {
        const Eigen::Vector3d there = T * position(last->points[static_cast<std::size_t>(match.query)]);
        if ((there - position(first->points[static_cast<std::size_t>(match.candidate)])).norm() < 0.03)
            ++right;
    }
    RecordProperty("matches", static_cast<int>(matches.size()));
    RecordProperty("right", right);
    EXPECT_GE(right, 40);
    EXPECT_GE(right, static_cast<int>(matches.size() * 2 / 5));
}

// What a frame shows of a place: boxes on a wall 1.5 m away.
class PlaceLikeness : public ::testing::Test {
  protected:
    PlaceLikeness() : place_(viewOf(images_)->points) {}
    Likeness compare(const RgbdFrame& frame, const Pose& T_frame_place = Pose()) {
        return PlaceDescriber(squareCamera(400)).compare(place_, T_frame_place, frame.grey, frame);
    }
    RgbdFrame images_ = boxes(400, 1.5);
    PlacePoints place_;
};

TEST_F(PlaceLikeness, AllOfAPlaceLooksLikeItselfAndLittleWithEveryPointElsewhere) {
    const Likeness own = compare(images_);
    EXPECT_GT(own.visible, 50);
    EXPECT_EQ(own.alike, own.visible);
    Pose aside;
    aside.translation() = {0.15, 0.1, 0};
    EXPECT_GT(compare(images_, aside).visible, 50);
    EXPECT_LT(compare(images_, aside).share(), 0.3);
}

TEST_F(PlaceLikeness, BlurCostsLittleAndWhatIsGoneCountsAgainstThePlace) {
    RgbdFrame blurred = images_;
    cv::GaussianBlur(images_.grey, blurred.grey, cv::Size(0, 0), 4);
    EXPECT_GT(compare(blurred).share(), 0.9);
    RgbdFrame half_bare = images_;
    half_bare.grey = images_.grey.clone();
    half_bare.grey(cv::Rect(0, 0, 200, 400)).setTo(128);
    EXPECT_EQ(compare(half_bare).visible, compare(images_).visible);
    EXPECT_LT(compare(half_bare).share(), 0.7);
    EXPECT_GT(compare(half_bare).share(), 0.3);
}

TEST_F(PlaceLikeness, WhatIsHiddenSaysNothing) {
    RgbdFrame hidden = images_;
    hidden.grey = images_.grey.clone();
    hidden.depth = images_.depth.clone();
    hidden.grey(cv::Rect(0, 0, 120, 400)).setTo(128);
    hidden.depth(cv::Rect(0, 0, 160, 400)).setTo(0.7);
    EXPECT_LT(compare(hidden).visible, 0.8 * compare(images_).visible);
    EXPECT_GT(compare(hidden).share(), 0.9);
    RgbdFrame masked = images_;
    masked.grey = hidden.grey.clone();
    masked.grey(cv::Rect(0, 0, 200, 400)).setTo(128);
    EXPECT_LT(compare(masked).share(), 0.7);
    masked.mask = cv::Mat(400, 400, CV_8UC1, cv::Scalar(255));
    masked.mask(cv::Rect(0, 0, 240, 400)).setTo(0);
    EXPECT_LT(compare(masked).visible, 0.8 * compare(images_).visible);
    EXPECT_GT(compare(masked).visible, 20);
    EXPECT_GT(compare(masked).share(), 0.9);
    Pose turned;
    turned.setRotation(Eigen::Quaterniond(Eigen::AngleAxisd(kPi, Eigen::Vector3d::UnitY())));
    EXPECT_EQ(compare(images_, turned).visible, 0) << "behind the camera";
}

}  // namespace
}  // namespace roevo
