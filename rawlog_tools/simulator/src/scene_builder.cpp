#include "scene_builder.h"

#include <cmath>
#include <stdexcept>

namespace roevo::simulator {

int SceneBuilder::material(Texture texture, const Colour& a, const Colour& b, const Colour& c, float scale,
                           float emission) {
    Material m;
    m.texture = texture;
    m.a = a, m.b = b, m.c = c;
    m.scale = scale;
    m.emission = emission;
    m.seed = static_cast<uint32_t>(scene.materials.size());
    scene.materials.push_back(m);
    return static_cast<int>(scene.materials.size()) - 1;
}

Primitive& SceneBuilder::add(Shape shape, const Eigen::Vector3d& centre, const Eigen::Vector3d& half_size,
                             int material) {
    Primitive primitive;
    primitive.shape = shape;
    primitive.centre = centre;
    primitive.half_size = half_size;
    primitive.material = material;
    scene.primitives.push_back(primitive);
    return scene.primitives.back();
}

Primitive& SceneBuilder::box(const Eigen::Vector3d& low, const Eigen::Vector3d& high, int material) {
    return add(Shape::kBox, 0.5 * (low + high), 0.5 * (high - low), material);
}

Primitive& SceneBuilder::turnedBox(const Eigen::Vector3d& centre, const Eigen::Vector3d& size, double yaw,
                                   int material) {
    Primitive& primitive = add(Shape::kBox, centre, 0.5 * size, material);
    primitive.R_world_object = Eigen::AngleAxisd(yaw, Eigen::Vector3d::UnitZ()).toRotationMatrix();
    return primitive;
}

Primitive& SceneBuilder::cylinder(const Eigen::Vector3d& foot, double radius, double height, int material,
                                  double taper) {
    Primitive& primitive = add(Shape::kCylinder, foot + Eigen::Vector3d(0, 0, 0.5 * height),
                               {radius, radius, 0.5 * height}, material);
    primitive.taper = taper;
    return primitive;
}

Primitive& SceneBuilder::rod(const Eigen::Vector3d& from, const Eigen::Vector3d& to, double radius,
                             int material) {
    Primitive& primitive =
        add(Shape::kCylinder, 0.5 * (from + to), {radius, radius, 0.5 * (to - from).norm()}, material);
    primitive.R_world_object =
        Eigen::Quaterniond::FromTwoVectors(Eigen::Vector3d::UnitZ(), to - from).toRotationMatrix();
    return primitive;
}

Primitive& SceneBuilder::ellipsoid(const Eigen::Vector3d& centre, const Eigen::Vector3d& half_size,
                                   int material) {
    return add(Shape::kSphere, centre, half_size, material);
}

Primitive& SceneBuilder::sheet(const Eigen::Vector3d& centre, double width, double height,
                               const Eigen::Vector3d& normal, int material) {
    Primitive& primitive = add(Shape::kQuad, centre, {0.5 * width, 0.5 * height, 1}, material);
    const Eigen::Vector3d up =
        std::abs(normal.z()) > 0.5 ? Eigen::Vector3d::UnitY() : Eigen::Vector3d::UnitZ();
    primitive.R_world_object.col(0) = up.cross(normal).normalized();
    primitive.R_world_object.col(1) = normal.cross(primitive.R_world_object.col(0)).normalized();
    primitive.R_world_object.col(2) = normal.normalized();
    return primitive;
}

void SceneBuilder::room(const Eigen::Vector3d& size, int floor, int ceiling, int south, int north, int west,
                        int east) {
    const Eigen::Vector3d middle = 0.5 * size;
    sheet({middle.x(), middle.y(), 0}, size.x(), size.y(), Eigen::Vector3d::UnitZ(), floor);
    sheet({middle.x(), middle.y(), size.z()}, size.x(), size.y(), -Eigen::Vector3d::UnitZ(), ceiling);
    sheet({middle.x(), 0, middle.z()}, size.x(), size.z(), Eigen::Vector3d::UnitY(), south);
    sheet({middle.x(), size.y(), middle.z()}, size.x(), size.z(), -Eigen::Vector3d::UnitY(), north);
    sheet({0, middle.y(), middle.z()}, size.y(), size.z(), Eigen::Vector3d::UnitX(), west);
    sheet({size.x(), middle.y(), middle.z()}, size.y(), size.z(), -Eigen::Vector3d::UnitX(), east);
}

void SceneBuilder::framedPicture(const Eigen::Vector3d& centre, double width, double height,
                                 const Eigen::Vector3d& normal, int frame, int picture) {
    const double bar = 0.03, depth = 0.025;
    const Eigen::Vector3d side = Eigen::Vector3d::UnitZ().cross(normal), up = Eigen::Vector3d::UnitZ();
    const auto extent = [&](double along, double high) {
        return Eigen::Vector3d((side * along + normal * depth).cwiseAbs() + up * high);
    };
    for (const double end : {-1., 1.}) {
        Eigen::Vector3d middle = centre + 0.5 * depth * normal + end * 0.5 * (height + bar) * up;
        turnedBox(middle, extent(width + 2 * bar, bar), 0, frame);
        middle = centre + 0.5 * depth * normal + end * 0.5 * (width + bar) * side;
        turnedBox(middle, extent(bar, height), 0, frame);
    }
    sheet(centre + 0.008 * normal, width, height, normal, picture);
}

const std::vector<std::string>& sceneNames() {
    static const std::vector<std::string> names = {"livingroom", "corridor", "shadows", "block"};
    return names;
}

Scene makeScene(const std::string& name) {
    if (name == "livingroom") return makeLivingroom();
    if (name == "corridor") return makeCorridor();
    if (name == "shadows") return makeShadows();
    if (name == "block") return makeBlock();
    std::string known;
    for (const std::string& other : sceneNames()) known += (known.empty() ? "" : ", ") + other;
    throw std::runtime_error("unknown scene '" + name + "'; there are: " + known);
}

}  // namespace roevo::simulator
