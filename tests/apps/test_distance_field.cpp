// Registration by the distance field: the field against brute force, its Jacobians against numeric
// differences, signs, and whole sequences.
#include <gtest/gtest.h>

#include <memory>
#include <opencv2/core.hpp>

#include "core/support/random_pose.h"
#include "core/support/simulated.h"
#include "edges/edge_extractor.h"
#include "methods/distance_field.h"
#include "methods/families.h"
#include "roevo/odometry.h"
#include "tracking/robust.h"
#include "tracking/tracker.h"

namespace roevo {
namespace {

using testing::uniform;

cv::Mat randomMask(std::mt19937& random, int width, int height, int edges) {
    cv::Mat mask = cv::Mat::zeros(height, width, CV_8UC1);
    for (int i = 0; i < edges; ++i) {
        mask.at<std::uint8_t>(static_cast<int>(uniform(random, 0, height)),
                              static_cast<int>(uniform(random, 0, width))) = 1;
    }
    return mask;
}

TEST(DistanceField, IsTheExactEuclideanDistance) {
    std::mt19937 random(7);
    const cv::Mat mask = randomMask(random, 61, 47, 25);
    std::vector<cv::Point> edges;
    cv::findNonZero(mask, edges);
    DistanceField field;
    field.build(mask);
    for (int y = 0; y < mask.rows; ++y) {
        for (int x = 0; x < mask.cols; ++x) {
            double nearest = 1e9;
            for (const cv::Point& edge : edges)
                nearest = std::min(nearest, std::hypot(edge.x - x, edge.y - y));
            ASSERT_NEAR(field.distances().at<float>(y, x), nearest, 1e-4) << x << ", " << y;
        }
    }
}

TEST(DistanceField, InterpolatesBetweenPixelsAndKnowsItsSlope) {
    std::mt19937 random(8);
    DistanceField field;
    field.build(randomMask(random, 80, 60, 40));
    constexpr float kStep = 1e-2F;
    for (int i = 0; i < 2000; ++i) {
        // Away from the cells' borders, where the slope jumps
        const auto u = static_cast<float>(std::floor(uniform(random, 0, 79)) + uniform(random, 0.05, 0.95));
        const auto v = static_cast<float>(std::floor(uniform(random, 0, 59)) + uniform(random, 0.05, 0.95));
        const DistanceField::Sample here = field.at(u, v);
        EXPECT_NEAR(here.du,
                    (field.at(u + kStep, v).distance - field.at(u - kStep, v).distance) / (2 * kStep), 2e-3);
        EXPECT_NEAR(here.dv,
                    (field.at(u, v + kStep).distance - field.at(u, v - kStep).distance) / (2 * kStep), 2e-3);
    }
    EXPECT_EQ(field.at(17, 23).distance, field.distances().at<float>(23, 17));
}

const PinholeCamera kCamera{320, 240, 260, 262, 158.7, 120.4, {}};

Keyframe onePoint(const Eigen::Vector3d& p, float weight) {
    Keyframe keyframe;
    keyframe.edges.image.addPoint(0, 0, 1, 0, 10);
    keyframe.edges.image.finishEdge();
    keyframe.edges.points.x.assign(kernels::kLanes, static_cast<float>(p.x()));
    keyframe.edges.points.y.assign(kernels::kLanes, static_cast<float>(p.y()));
    keyframe.edges.points.z.assign(kernels::kLanes, static_cast<float>(p.z()));
    keyframe.edges.weight.assign(1, weight);
    keyframe.median_depth = p.z();
    return keyframe;
}

TEST(DistanceFieldTracker, ResidualIsDifferentiatedRight) {
    std::mt19937 random(9);
    DistanceField field;
    field.build(randomMask(random, kCamera.width, kCamera.height, 300));
    DistanceFieldTracker tracker(kCamera, FineOptions(), 0);
    int compared = 0;
    for (int i = 0; i < 1000; ++i) {
        const Pose pose = testing::randomPose(random, 0.5, 0.4);
        const Eigen::Vector2d pixel(std::floor(uniform(random, 10, 310)) + uniform(random, 0.2, 0.8),
                                    std::floor(uniform(random, 10, 230)) + uniform(random, 0.2, 0.8));
        const Eigen::Vector3d in_camera = kCamera.backProject(pixel.x(), pixel.y(), uniform(random, 0.4, 8));
        const Keyframe keyframe = onePoint(pose.inverse() * in_camera, 0.7F);
        const Eigen::Vector3d stored = keyframe.edges.points.at(0);
        const auto residual = [&](const Pose& at) {
            const Eigen::Vector2d p = kCamera.project(at * stored);
            // In double precision, so that differences of nearly equal numbers are good for something
            const int x = static_cast<int>(p.x()), y = static_cast<int>(p.y());
            const double a = p.x() - x, b = p.y() - y;
            const cv::Mat& d = field.distances();
            return (1 - b) * ((1 - a) * d.at<float>(y, x) + a * d.at<float>(y, x + 1)) +
                   b * ((1 - a) * d.at<float>(y + 1, x) + a * d.at<float>(y + 1, x + 1));
        };
        const double r = residual(pose);
        if (r > 20) continue;
        Vector6d jacobian;
        for (int k = 0; k < 6; ++k) {
            Vector6d step = Vector6d::Zero();
            step[k] = 1e-5;
            jacobian[k] =
                (residual(poseIncrement(step) * pose) - residual(poseIncrement(-step) * pose)) / 2e-5;
        }
        const PoseSystem system = tracker.linearise(keyframe, field, kCamera, pose, RowMotion(), 30);
        std::vector<float> magnitude{static_cast<float>(r)};
        const double scale = robustScale(magnitude);
        if (r * r / (scale * scale) > FineOptions().chi2) continue;
        const double weight = static_cast<double>(studentWeight(static_cast<float>(0.7 / (scale * scale)),
                                                                static_cast<float>(r * r / (scale * scale))));
        EXPECT_LT((system.gradient - weight * r * jacobian).norm(),
                  2e-3 * std::abs(weight * r) * jacobian.norm() + 1e-4)
            << r;
        EXPECT_LT((system.hessian - weight * jacobian * jacobian.transpose()).norm(),
                  4e-3 * weight * jacobian.squaredNorm());
        ++compared;
    }
    EXPECT_GT(compared, 500);
}

TEST(DistanceFieldTracker, PointsFarFromAnyEdgeOrOutsideSayNothing) {
    DistanceField field;
    cv::Mat mask = cv::Mat::zeros(kCamera.height, kCamera.width, CV_8UC1);
    mask.at<std::uint8_t>(100, 100) = 1;
    field.build(mask);
    DistanceFieldTracker tracker(kCamera, FineOptions(), 0);
    const auto gradientAt = [&](double u, double v) {
        const Keyframe keyframe = onePoint(kCamera.backProject(u, v, 2), 1);
        return tracker.linearise(keyframe, field, kCamera, Pose::Identity(), RowMotion(), 6).gradient.norm();
    };
    EXPECT_GT(gradientAt(103.4, 101.2), 0);
    EXPECT_EQ(gradientAt(107, 100), 0) << "beyond the radius, though not yet an outlier";
    EXPECT_EQ(gradientAt(-40, 100), 0);
    EXPECT_EQ(gradientAt(318.5, 238.5), 0);
}

/// The first frames of a room without noise. Every case is a process of its own: no more than needed.
testing::Sequence room(int frames) {
    return testing::simulate(testing::smallRoom(), frames);
}

/// Two frames of the room: a keyframe at the first, the other to be registered.
struct TwoFrames {
    testing::Sequence sequence;
    OdometryOptions options;
    PinholeCamera camera = sequence.camera;
    EdgeExtractor extractor{options.edges};
    Frame frame;
    Keyframe keyframe;
    Pose T_truth;

    explicit TwoFrames(int other) : sequence(room(other + 1)) {
        take(sequence.frames.front());
        keyframe.edges =
            liftEdges(frame.edges, frame.images.depth, camera, RowMotion(), options.edges, options.sensor);
        keyframe.median_depth = static_cast<double>(keyframe.edges.medianDepth());
        keyframe.photometric =
            samplePhotometricPoints(keyframe.edges, frame.pyramid, options.coarse.max_points);
        take(sequence.frames.back());
        T_truth = sequence.truth.back().T_world_camera.inverse() * sequence.truth.front().T_world_camera;
    }
    void take(const RgbdFrame& images) {
        frame.images = images;
        frame.ideal_grey = images.grey;
        extractor.extract(images.grey, frame.edges, frame.mask);
        frame.grid.build(frame.edges, camera.width, camera.height);
        frame.pyramid.build(images.grey, 2);
    }
    FineResult track(const Pose& T_start, double photometric_weight) const {
        return DistanceFieldTracker(camera, options.fine, photometric_weight)
            .track(keyframe, frame, T_start, {T_start}, RollingShutter(), Brightness());
    }
};

TEST(DistanceFieldTracker, FindsThePoseFromAnyDirection) {
    const TwoFrames two(6);
    for (const double photometric : {0.0, 0.3}) {
        for (int k = 0; k < 6; ++k) {
            for (const double side : {-1.0, 1.0}) {
                Vector6d off = Vector6d::Zero();
                off[k] = side * (k < 3 ? 0.02 : 0.01);  // some 2.6 px
                const FineResult found = two.track(poseIncrement(off) * two.T_truth, photometric);
                ASSERT_TRUE(found.converged);
                const Pose error = found.T_current_keyframe * two.T_truth.inverse();
                EXPECT_LT(error.translation().norm(), 0.003) << k << ' ' << side;
                EXPECT_LT(rotationAngle(error), 0.0015) << k << ' ' << side;
                EXPECT_GT(found.matched_ratio, 0.8);
                EXPECT_TRUE(found.uncertainty.covariance().allFinite());
            }
        }
    }
}

TEST(DistanceFieldTracker, WithoutEdgesItSaysSoAndKeepsThePose) {
    TwoFrames two(1);
    RgbdFrame even = two.sequence.frames.back();
    even.grey = cv::Mat(even.grey.size(), CV_8UC1, cv::Scalar(90));
    two.take(even);
    const FineResult found = two.track(two.T_truth, 0);
    EXPECT_FALSE(found.converged);
    EXPECT_EQ(found.inliers, 0);
    EXPECT_EQ((found.T_current_keyframe.matrix() - two.T_truth.matrix()).norm(), 0);
}

TEST(DistanceFieldMethod, WithoutNoiseTheErrorIsAFewMillimetres) {
    const testing::Sequence sequence = room(90);  // long enough that the drift is no luck
    ASSERT_GT(pathLength(sequence.truth), 1.0);
    std::vector<double> errors;  // m
    for (const MethodInfo& info : distanceFieldMethods()) {
        const auto method = makeMethod(info.name, sequence.camera, OdometryOptions());
        const Pose T_world_first = sequence.start();
        double squared = 0;
        for (std::size_t i = 0; i < sequence.frames.size(); ++i) {
            const MethodFrame frame = method->processFrame(sequence.frames[i]);
            ASSERT_TRUE(frame.tracked) << info.name << ", frame " << i << ": " << frame.reason;
            ASSERT_EQ(frame.stage_ms.size(), method->stages().size());
            for (const double ms : frame.stage_ms) EXPECT_GE(ms, 0);
            if (i > 0) {
                EXPECT_GT(frame.stage_ms[2], 0) << "no field was built for frame " << i;
            }
            squared += ((T_world_first * *frame.T_world_camera).translation() -
                        sequence.truth[i].T_world_camera.translation())
                           .squaredNorm();
        }
        const double error = std::sqrt(squared / static_cast<double>(sequence.frames.size()));
        RecordProperty(info.name + "_mm", std::to_string(1000 * error));
        RecordProperty("path_m", std::to_string(pathLength(sequence.truth)));
        EXPECT_LT(error, info.name == "distance-field" ? 0.005 : 0.003) << info.name;
        errors.push_back(error);
    }
    EXPECT_LT(errors[1], 0.9 * errors[0]) << "intensities see below the pixels of the mask";
}

/// ROEVO's tracker with the field alone in the place of fine tracking.
class WithField : public Tracker {
  public:
    WithField(const PinholeCamera& camera, const OdometryOptions& options)
        : Tracker(camera, options), field_(camera, options.fine, 0) {}

  protected:
    FineResult refine(const Keyframe& reference, const Frame& frame, const Pose& T_start,
                      const PosePrior& prior, const RollingShutter& shutter,
                      const Brightness& brightness) override {
        return field_.track(reference, frame, T_start, prior, shutter, brightness);
    }

  private:
    DistanceFieldTracker field_;
};

TEST(DistanceFieldMethod, WhereTheWorldBeginsDoesNotMatter) {
    const testing::Sequence sequence = room(15);
    const OdometryOptions options = [] {
        OdometryOptions tracking;
        tracking.mode = Mode::kTracking;
        return tracking;
    }();
    const auto run = [&](const Pose& T_world_start) {
        Odometry odometry(sequence.camera, options, T_world_start,
                          std::make_unique<WithField>(sequence.camera, options));
        std::vector<Pose> poses;
        for (std::size_t i = 0; i < 15; ++i) {
            poses.push_back(T_world_start.inverse() *
                            odometry.processFrame(sequence.frames[i]).T_world_camera);
        }
        return poses;
    };
    Vector6d elsewhere;
    elsewhere << 3, -2, 5, 0.7, -1.1, 0.4;
    const std::vector<Pose> here = run(Pose::Identity()), there = run(poseIncrement(elsewhere));
    for (std::size_t i = 0; i < here.size(); ++i) {
        EXPECT_LT((here[i].matrix() - there[i].matrix()).norm(), 1e-4) << i;
    }
}

TEST(DistanceFieldMethod, BadFramesComeBackWithAReason) {
    const testing::Sequence sequence = room(6);
    const auto method = makeMethod("distance-field", sequence.camera, OdometryOptions());
    for (std::size_t i = 0; i < 3; ++i) ASSERT_TRUE(method->processFrame(sequence.frames[i]).tracked);
    RgbdFrame grey = sequence.frames[3];
    grey.grey = cv::Mat(grey.grey.size(), CV_8UC1, cv::Scalar(90));
    const MethodFrame blind = method->processFrame(grey);
    EXPECT_FALSE(blind.tracked);
    EXPECT_NE(blind.reason, "");
    ASSERT_TRUE(blind.T_world_camera.has_value());
    EXPECT_TRUE(blind.T_world_camera->matrix().allFinite());
    RgbdFrame empty = sequence.frames[4];
    empty.grey = cv::Mat();
    const MethodFrame rejected = method->processFrame(empty);
    EXPECT_FALSE(rejected.tracked);
    EXPECT_FALSE(rejected.T_world_camera.has_value());
    EXPECT_TRUE(method->processFrame(sequence.frames[5]).tracked) << "tracking goes on after bad frames";
}

TEST(DistanceFieldMethod, NamesAndCamerasAreChecked) {
    const testing::Sequence sequence = room(1);
    EXPECT_THROW(makeMethod("distance", sequence.camera, OdometryOptions()), std::invalid_argument);
    EXPECT_THROW(makeMethod("distance-field", PinholeCamera(), OdometryOptions()), std::invalid_argument);
    for (const MethodInfo& info : distanceFieldMethods()) {
        EXPECT_NE(makeMethod(info.name, sequence.camera, OdometryOptions()), nullptr);
        EXPECT_FALSE(info.mode.has_value());
        EXPECT_NE(info.label, "");
        EXPECT_NE(info.note, "");
    }
}

}  // namespace
}  // namespace roevo
