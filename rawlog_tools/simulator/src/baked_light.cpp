#include "baked_light.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <stdexcept>
#include <thread>

#include "occlusion.h"

namespace roevo::simulator {
namespace {

constexpr int kMostPoints = 600;  // per row of a grid
constexpr double kLift = 0.03;    // metres: rays start above thin things such as carpets and picture frames
constexpr double kSurroundings = 0.9;  // metres: what is farther away does not darken
constexpr double kSlack = 1 + 1e-6;    // for rounding
constexpr int kSkySamples = 32, kLampSamples = 12;
constexpr double kGolden = 2.399963229728653;  // rad, golden angle: points of a spiral spread evenly

/// The same directions are used everywhere, so that neighbouring points differ smoothly.
std::vector<Eigen::Vector3d> skyDirections() {
    std::vector<Eigen::Vector3d> directions;
    for (int i = 0; i < kSkySamples; ++i) {
        const double r2 = (i + 0.5) / kSkySamples, angle = kGolden * i;  // cosine-weighted
        directions.emplace_back(std::sqrt(r2) * std::cos(angle), std::sqrt(r2) * std::sin(angle),
                                std::sqrt(1 - r2));
    }
    return directions;
}

std::vector<Eigen::Vector3d> ballPoints() {
    std::vector<Eigen::Vector3d> points;
    for (int i = 0; i < kLampSamples; ++i) {
        const double z = 1 - 2 * (i + 0.5) / kLampSamples, r = std::sqrt(1 - z * z), angle = kGolden * i;
        points.emplace_back(r * std::cos(angle), r * std::sin(angle), z);
    }
    return points;
}

Eigen::Matrix3d frameAround(const Eigen::Vector3d& normal) {
    Eigen::Matrix3d frame;
    const Eigen::Vector3d other =
        std::abs(normal.z()) < 0.9 ? Eigen::Vector3d::UnitZ() : Eigen::Vector3d::UnitX();
    frame.col(0) = other.cross(normal).normalized();
    frame.col(1) = normal.cross(frame.col(0));
    frame.col(2) = normal;
    return frame;
}

}  // namespace

BakedLight::BakedLight(const Scene& scene, int threads) {
    std::vector<const Light*> lamps;
    for (const Light& lamp : scene.lights)
        if (!lamp.sharp_shadows) lamps.push_back(&lamp);
    if (lamps.size() > kMaxLights)
        throw std::runtime_error("scene '" + scene.name + "' has more soft lamps than are supported");

    const auto pointsFor = [&](float half) {
        return std::clamp(static_cast<int>(std::lround(2 * half / scene.light_spacing)), 2, kMostPoints);
    };
    struct Task {
        int primitive, face;
    };
    std::vector<Task> tasks;
    grids_.resize(scene.primitives.size());
    size_t total = 0;
    for (size_t i = 0; i < scene.primitives.size(); ++i) {
        const Primitive& primitive = scene.primitives[i];
        if (!primitive.visible) continue;
        for (int face = 0; face < faceCount(primitive.shape); ++face) {
            const FacePoint extent = faceExtent(primitive, face);
            Grid& grid = grids_[i][static_cast<size_t>(face)];
            grid = {pointsFor(extent.half_u), pointsFor(extent.half_v), total};
            total += static_cast<size_t>(grid.columns * grid.rows);
            tasks.push_back({static_cast<int>(i), face});
        }
    }
    values_.resize(total);

    const Occlusion occlusion(scene);
    const std::vector<Eigen::Vector3d> sky = skyDirections(), ball = ballPoints();
    const auto bake = [&](const Task& task) {
        const Primitive& primitive = scene.primitives[static_cast<size_t>(task.primitive)];
        const Grid& grid = grids_[static_cast<size_t>(task.primitive)][static_cast<size_t>(task.face)];
        std::vector<Eigen::Vector3d> ways;
        for (int row = 0; row < grid.rows; ++row) {
            for (int col = 0; col < grid.columns; ++col) {
                Eigen::Vector3d unit, unit_normal;
                pointOnFace(primitive, task.face, 2 * (col + 0.5) / grid.columns - 1,
                            2 * (row + 0.5) / grid.rows - 1, unit, unit_normal);
                const Eigen::Vector3d normal = worldNormal(primitive, unit_normal);
                const Eigen::Vector3d point =
                    primitive.centre + primitive.R_world_object * unit.cwiseProduct(primitive.half_size) +
                    kLift * normal;
                Shares& shares = values_[grid.first + static_cast<size_t>(row * grid.columns + col)];
                shares.fill(0);
                const Eigen::Matrix3d frame = frameAround(normal);
                ways.clear();
                for (const Eigen::Vector3d& direction : sky)
                    ways.push_back(frame * direction * kSurroundings);
                const int open = occlusion.open(point, ways, Eigen::Vector3d::Zero(), kSlack * kSurroundings);
                shares[0] = 0.25f + 0.75f * static_cast<float>(open) / kSkySamples;
                for (size_t lamp = 0; lamp < lamps.size(); ++lamp) {
                    const Eigen::Vector3d& position = lamps[lamp]->position;
                    const double radius = lamps[lamp]->radius;
                    if (normal.dot(position - point) < -radius) continue;
                    ways.clear();
                    for (const Eigen::Vector3d& offset : ball)
                        ways.push_back(position + radius * offset - point);
                    const int seen = occlusion.open(point, ways, position - point, kSlack * radius);
                    shares[1 + lamp] = static_cast<float>(seen) / kLampSamples;
                }
            }
        }
    };
    std::atomic<size_t> next{0};
    const auto run = [&] {
        for (size_t i = next++; i < tasks.size(); i = next++) bake(tasks[i]);
    };
    std::vector<std::thread> helpers;
    for (int i = 1; i < threads; ++i) helpers.emplace_back(run);
    run();
    for (std::thread& helper : helpers) helper.join();
}

BakedLight::Shares BakedLight::at(int primitive, const FacePoint& point) const {
    const Grid& grid = grids_[static_cast<size_t>(primitive)][static_cast<size_t>(point.face)];
    const auto place = [](float at, float half, int count, int& low) {
        const float x = std::clamp((at / half + 1) * 0.5f * static_cast<float>(count) - 0.5f, 0.f,
                                   static_cast<float>(count - 1));
        low = std::min(static_cast<int>(x), count - 2);
        return x - static_cast<float>(low);
    };
    int col = 0, row = 0;
    const float x = place(point.u, point.half_u, grid.columns, col),
                y = place(point.v, point.half_v, grid.rows, row);
    const Shares* a = &values_[grid.first + static_cast<size_t>(row * grid.columns + col)];
    const Shares* b = a + grid.columns;
    Shares mixed;
    for (size_t i = 0; i < mixed.size(); ++i)
        mixed[i] = (a[0][i] * (1 - x) + a[1][i] * x) * (1 - y) + (b[0][i] * (1 - x) + b[1][i] * x) * y;
    return mixed;
}

}  // namespace roevo::simulator
