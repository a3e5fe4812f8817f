#pragma once
/// A small world of 3-D curves with exact truth, and map keyframes that see it, for tests of local mapping.

#include <cmath>
#include <functional>
#include <random>
#include <vector>

#include "core/support/random_pose.h"
#include "kernels/kernels.h"
#include "mapping/edge_fusion.h"

namespace roevo::testing {

/// A curve with a parameter that is about the length along it, m.
struct Curve {
    std::function<Eigen::Vector3d(double)> at;
    double length = 0;
    double spacing = 0;  ///< m between samples: about 1.5 px

    int samples() const { return static_cast<int>(length / spacing) + 1; }
};

inline PinholeCamera mappingCamera() {
    PinholeCamera camera;
    camera.width = 640;
    camera.height = 480;
    camera.fx = 525;
    camera.fy = 520;
    camera.cx = 319.5;
    camera.cy = 239.5;
    return camera;
}

constexpr double kSpacingPixels = 1.5;
constexpr int kNormalSpan = 3;  ///< as the mapper's

inline Curve segment(const Eigen::Vector3d& from, const Eigen::Vector3d& to) {
    const Eigen::Vector3d direction = (to - from).normalized();
    const double spacing = kSpacingPixels * (from.z() + to.z()) / 2 / mappingCamera().fx;
    return {[=](double s) { return Eigen::Vector3d(from + s * direction); }, (to - from).norm(), spacing};
}

/// Edges of walls in several directions and depths, one that runs away from the camera, an arc and a wave.
/// The first camera is at the origin and looks along +z; all is within 1 to 4 m.
inline std::vector<Curve> room() {
    std::vector<Curve> curves;
    curves.push_back(segment({-0.7, -0.5, 2}, {0.7, -0.5, 2}));
    curves.push_back(segment({-0.75, -0.4, 2.2}, {-0.72, 0.6, 2.2}));
    curves.push_back(segment({0.15, -0.35, 1.8}, {0.6, 0.4, 1.8}));
    const Eigen::Vector3d centre(-0.2, 0.15, 1.6);
    constexpr double kRadius = 0.22;
    curves.push_back({[=](double s) {
                          const double angle = s / kRadius;
                          return Eigen::Vector3d(
                              centre + kRadius * Eigen::Vector3d(std::cos(angle), std::sin(angle), 0.3));
                      },
                      kRadius * 300 * kDegree, kSpacingPixels * 1.67 / 525});
    curves.push_back(segment({-0.7, 0.66, 1.9}, {0.3, 0.7, 3.3}));
    curves.push_back(segment({0.9, -0.6, 3.5}, {1.3, 0.9, 3.5}));
    curves.push_back(segment({-0.3, -0.3, 1.15}, {-0.1, -0.2, 1.2}));
    curves.push_back({[](double s) { return Eigen::Vector3d(s - 0.1, -0.75 + 0.04 * std::sin(9 * s), 2.6); },
                      0.9, kSpacingPixels * 2.6 / 525});
    return curves;
}

/// Places that a hand-held camera goes through, in small steps.
inline Pose placeOnPath(int k) {
    Vector6d xi;
    xi << 0.03 * k, 0.04 * std::sin(0.7 * k), 0.03 * std::sin(0.4 * k), 0.012 * std::sin(1.1 * k), -0.008 * k,
        0.01 * std::sin(0.5 * k);
    return poseIncrement(xi);
}

/// What a keyframe sees of a curve.
struct Sighting {
    int curve = 0;
    int first = 0, end = -1;                          ///< samples; -1: to the end
    double phase = 0;                                 ///< samples are taken that share of a step further on
    bool reversed = false;                            ///< points in the other order
    Eigen::Vector2d shift = Eigen::Vector2d::Zero();  ///< of the image, px; depth follows
};

struct TestKeyframe {
    MapKeyframe keyframe;
    std::vector<int> curve_of_edge;
    std::vector<double> parameter;  ///< of each point: place on its curve
};

/// A keyframe at its true pose. Points outside the image are left out.
inline TestKeyframe makeKeyframe(int id, const Pose& pose, const std::vector<Curve>& curves,
                                 const std::vector<Sighting>& sightings) {
    const PinholeCamera camera = mappingCamera();
    constexpr double kMargin = 6;  // px
    TestKeyframe made;
    MapKeyframe& out = made.keyframe;
    out.id = id;
    out.T_world_camera = pose;
    out.median_depth = 2;
    const Pose T_camera_world = pose.inverse();
    for (const Sighting& sighting : sightings) {
        const Curve& curve = curves[static_cast<std::size_t>(sighting.curve)];
        const int end = sighting.end < 0 ? curve.samples() : sighting.end;
        const std::size_t before = out.size();
        for (int i = sighting.first; i < end; ++i) {
            const int sample = sighting.reversed ? end - 1 - (i - sighting.first) : i;
            const double s = (sample + sighting.phase) * curve.spacing;
            const Eigen::Vector3d p = T_camera_world * curve.at(s);
            const Eigen::Vector2d pixel = camera.project(p) + sighting.shift;
            if (pixel.x() < kMargin || pixel.y() < kMargin || pixel.x() > camera.width - kMargin ||
                pixel.y() > camera.height - kMargin) {
                continue;
            }
            // The bright side is on the same hand of the curve from wherever it is seen
            const Eigen::Vector2d tangent = (camera.project(T_camera_world * curve.at(s + 1e-4)) -
                                             camera.project(T_camera_world * curve.at(s - 1e-4)))
                                                .normalized();
            out.image.addPoint(static_cast<float>(pixel.x()), static_cast<float>(pixel.y()),
                               static_cast<float>(-tangent.y()), static_cast<float>(tangent.x()), 20);
            const Eigen::Vector3d seen = camera.backProject(pixel.x(), pixel.y(), p.z());
            out.points.add(seen);
            out.weight.push_back(1);
            out.colours.push_back(
                {static_cast<std::uint8_t>(sighting.curve), static_cast<std::uint8_t>(id), 0});
            made.parameter.push_back(s);
        }
        if (out.size() == before) continue;
        out.image.finishEdge();
        made.curve_of_edge.push_back(sighting.curve);
    }
    computeNormals(out.image, kNormalSpan);
    computeSlopes(out);
    out.clusters.assign(made.curve_of_edge.begin(), made.curve_of_edge.end());
    out.found.assign(made.curve_of_edge.size(), -1);
    out.points.pad();
    return made;
}

/// Every curve, whole.
inline std::vector<Sighting> seeAll(const std::vector<Curve>& curves, double phase = 0) {
    std::vector<Sighting> all;
    for (int c = 0; c < static_cast<int>(curves.size()); ++c) all.push_back({c, 0, -1, phase, false, {0, 0}});
    return all;
}

/// `count` keyframes on the path, each with all curves; sampled at the same places unless `own_phases`.
inline std::vector<TestKeyframe> walkThrough(const std::vector<Curve>& curves, int count,
                                             bool own_phases = false) {
    std::vector<TestKeyframe> keyframes;
    for (int k = 0; k < count; ++k) {
        const double phase = own_phases ? std::fmod(0.37 * k, 1.0) : 0;
        keyframes.push_back(makeKeyframe(k, placeOnPath(k), curves, seeAll(curves, phase)));
    }
    return keyframes;
}

/// At the keyframes' own poses, the first one fixed.
inline std::vector<WindowKeyframe> windowOf(const std::vector<TestKeyframe>& keyframes) {
    std::vector<WindowKeyframe> window;
    for (const TestKeyframe& made : keyframes) {
        window.push_back({&made.keyframe, made.keyframe.T_world_camera, window.empty()});
    }
    return window;
}

/// The true clusters: edges of one curve.
inline std::vector<std::vector<int>> clustersByCurve(const std::vector<TestKeyframe>& keyframes) {
    std::vector<std::vector<int>> clusters;
    for (const TestKeyframe& made : keyframes) clusters.push_back(made.curve_of_edge);
    return clusters;
}

inline FusedEdges fuse(const std::vector<WindowKeyframe>& window,
                       const std::vector<std::vector<int>>& clusters) {
    return EdgeFuser(SensorOptions()).fuse(window, clusters);
}

/// Moves the poses that are not fixed by up to these bounds in each axis, in the camera's frame.
inline void disturb(std::vector<WindowKeyframe>& window, std::mt19937& random, double metres,
                    double radians) {
    for (WindowKeyframe& view : window) {
        if (!view.fixed) view.T_world_camera = view.T_world_camera * randomPose(random, metres, radians);
    }
}

/// Largest distance of camera centres from the keyframes' own (true) poses, m.
inline double positionError(const std::vector<WindowKeyframe>& window) {
    double worst = 0;
    for (const WindowKeyframe& view : window) {
        const Pose& truth = view.keyframe->T_world_camera;
        worst = std::max(worst, (view.T_world_camera.translation() - truth.translation()).norm());
    }
    return worst;
}

/// Largest rotation from the keyframes' own (true) poses, rad.
inline double rotationError(const std::vector<WindowKeyframe>& window) {
    double worst = 0;
    for (const WindowKeyframe& view : window) {
        // Small angles by the sine: an angle from the trace has no digits left below 1e-8
        const Eigen::Matrix3d turn =
            view.keyframe->T_world_camera.linear().transpose() * view.T_world_camera.linear();
        const Eigen::Vector3d twice(turn(2, 1) - turn(1, 2), turn(0, 2) - turn(2, 0),
                                    turn(1, 0) - turn(0, 1));
        worst = std::max(worst, std::asin(std::min(1.0, twice.norm() / 2)));
    }
    return worst;
}

/// Distance of a point to a curve, m, by searching about it ever finer.
inline double distanceTo(const Curve& curve, const Eigen::Vector3d& p) {
    double best = 0, step = curve.length / 200;
    for (double s = 0; s <= curve.length + step; s += step) {
        if ((curve.at(s) - p).squaredNorm() < (curve.at(best) - p).squaredNorm()) best = s;
    }
    for (; step > 1e-8; step /= 2) {
        for (const double s : {best - step, best + step}) {
            if ((curve.at(s) - p).squaredNorm() < (curve.at(best) - p).squaredNorm()) best = s;
        }
    }
    return (curve.at(best) - p).norm();
}

}  // namespace roevo::testing
