#pragma once
/// Scenes of the simulator: textured primitives, lights, and the loops along which the camera is carried.
/// World frame: z up, metres.

#include <Eigen/Core>
#include <cstdint>
#include <string>
#include <vector>

#include "roevo/types.h"

namespace roevo::simulator {

using Colour = Eigen::Vector3f;  ///< red, green, blue in 0..1

enum class Texture {
    kPlain,
    kPlaster,
    kPlanks,
    kWood,
    kFabric,
    kStripes,
    kTiles,
    kCarpet,
    kPoster,
    kBook,
    kWindowView,
    kClock,
    kFoliage,
    kDoor
};

/// Procedural surface: every texture is a function of metric surface coordinates, the colours and the seed.
struct Material {
    Texture texture = Texture::kPlain;
    Colour a{0.7f, 0.7f, 0.7f}, b{0.3f, 0.3f, 0.3f}, c{0.9f, 0.9f, 0.9f};
    float scale = 1.f;     ///< size of the pattern, metres per unit (what the unit is depends on the texture)
    float emission = 0.f;  ///< 0: lit by the lamps only; 1: shines by itself (window, lamp shade, screen)
    uint32_t seed = 0;
};

/// Unit shapes, scaled by half sizes: quad |x|,|y| <= 1 at z = 0; box; sphere; cylinder about z with caps,
/// whose radius grows linearly to `taper` times the bottom one at the top.
enum class Shape { kQuad, kBox, kSphere, kCylinder };

/// A circular or to-and-fro movement: centre + amplitude_a sin(wt + phase) + amplitude_b cos(wt + phase).
struct Motion {
    Eigen::Vector3d amplitude_a = Eigen::Vector3d::Zero(), amplitude_b = Eigen::Vector3d::Zero();
    double angular_speed = 0, phase = 0;  ///< rad/s, rad
};

struct Primitive {
    Shape shape = Shape::kBox;
    Eigen::Matrix3d R_world_object = Eigen::Matrix3d::Identity();
    Eigen::Vector3d centre = Eigen::Vector3d::Zero();     ///< metres, at rest
    Eigen::Vector3d half_size = Eigen::Vector3d::Ones();  ///< metres
    double taper = 1;                                     ///< cylinders only
    int material = 0;
    int motion = -1;      ///< index into Scene::motions, or -1
    bool visible = true;  ///< false: only its shadow is seen
    bool casts_shadow = true;

    /// Object coordinates of the unit shape for a world point, with the primitive at its place at rest.
    Eigen::Vector3d toUnit(const Eigen::Vector3d& world) const {
        return (R_world_object.transpose() * (world - centre)).cwiseQuotient(half_size);
    }
};

/// Point lamp. Irradiance falls as power / (1 + d^2 / reach^2).
struct Light {
    Eigen::Vector3d position = Eigen::Vector3d::Zero();
    float power = 1;
    float reach = 3;             ///< metres
    float radius = 0.15f;        ///< metres, of the luminous ball: softness of baked shadows
    bool sharp_shadows = false;  ///< cast by every primitive at the time of the picture, not baked
    Colour tint{1, 1, 1};
};

/// Where the camera is and what it looks at; the loop is a closed cubic B-spline over these control points.
struct Waypoint {
    Eigen::Vector3d position, target;
};

struct Scene {
    std::string name;
    std::vector<Material> materials;
    std::vector<Primitive> primitives;
    std::vector<Motion> motions;
    std::vector<Light> lights;
    float ambient = 0.35f;
    double light_spacing = 0.09;          ///< metres between the points for which soft light is computed
    std::vector<Waypoint> handheld_loop;  ///< also of the path back-and-forth
    std::vector<Waypoint> walk_loop;
    std::vector<Waypoint> round_loop;  ///< of the path loop; empty: there is no way round in this scene
};

/// Names that makeScene() knows, in order.
const std::vector<std::string>& sceneNames();

/// @throws std::runtime_error naming the unknown scene and those there are.
Scene makeScene(const std::string& name);

}  // namespace roevo::simulator
