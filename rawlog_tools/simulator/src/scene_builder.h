#pragma once
#include "roevo_simulator/scene.h"

namespace roevo::simulator {

/// For colours that a texture does not use.
inline const Colour kNone{0, 0, 0};

/// Helpers that keep the scene descriptions short. All lengths in metres, z up.
class SceneBuilder {
  public:
    explicit SceneBuilder(std::string name) { scene.name = std::move(name); }

    int material(Texture texture, const Colour& a, const Colour& b = {0.3f, 0.3f, 0.3f},
                 const Colour& c = {0.9f, 0.9f, 0.9f}, float scale = 1, float emission = 0);

    /// Box from its two extreme corners.
    Primitive& box(const Eigen::Vector3d& low, const Eigen::Vector3d& high, int material);
    /// Box turned about the vertical by `yaw` rad.
    Primitive& turnedBox(const Eigen::Vector3d& centre, const Eigen::Vector3d& size, double yaw,
                         int material);
    /// Upright cylinder standing on `foot`.
    Primitive& cylinder(const Eigen::Vector3d& foot, double radius, double height, int material,
                        double taper = 1);
    /// Rod between two points.
    Primitive& rod(const Eigen::Vector3d& from, const Eigen::Vector3d& to, double radius, int material);
    Primitive& ellipsoid(const Eigen::Vector3d& centre, const Eigen::Vector3d& half_size, int material);
    /// Rectangle whose face looks along `normal` (horizontal, or up or down).
    Primitive& sheet(const Eigen::Vector3d& centre, double width, double height,
                     const Eigen::Vector3d& normal, int material);

    /// The six inner faces of a room from (0, 0, 0) to `size`.
    void room(const Eigen::Vector3d& size, int floor, int ceiling, int south, int north, int west, int east);
    /// A picture in a frame hung with its centre at `centre` on a wall with the given normal.
    void framedPicture(const Eigen::Vector3d& centre, double width, double height,
                       const Eigen::Vector3d& normal, int frame, int picture);

    Scene scene;

  private:
    Primitive& add(Shape shape, const Eigen::Vector3d& centre, const Eigen::Vector3d& half_size,
                   int material);
};

Scene makeLivingroom();
Scene makeCorridor();
Scene makeShadows();
Scene makeBlock();

}  // namespace roevo::simulator
