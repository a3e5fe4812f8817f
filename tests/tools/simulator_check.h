#pragma once
#include <cmath>

#include "roevo_simulator/simulator.h"

namespace roevo::simulator {

/// Small pictures keep the tests quick; the geometry is the same.
inline SimulationOptions smallOptions(const std::string& scene, int frames = 300) {
    SimulationOptions options;
    options.scene = scene;
    options.frames = frames;
    options.width = 160;
    options.height = 120;
    options.threads = 2;
    return options;
}

/// How far a world point is from the surface of a primitive at rest, metres, to first order; written from the
/// shapes' equations, independently of the ray caster.
inline double distanceToSurface(const Primitive& primitive, const Eigen::Vector3d& world) {
    const Eigen::Vector3d unit = primitive.toUnit(world), half = primitive.half_size;
    switch (primitive.shape) {
        case Shape::kQuad:
            return std::abs(unit.z());
        case Shape::kBox:
            return ((unit.cwiseAbs() - Eigen::Vector3d::Ones()).cwiseProduct(half)).cwiseAbs().minCoeff();
        case Shape::kSphere: {
            const double slope = (unit.cwiseQuotient(half)).norm() / unit.norm();
            return std::abs(unit.norm() - 1) / slope;
        }
        case Shape::kCylinder: {
            const double radius = 1 + (primitive.taper - 1) * (unit.z() + 1) / 2;
            const double side = std::abs(std::hypot(unit.x(), unit.y()) - radius) * half.head<2>().maxCoeff();
            return std::min(side, (std::abs(std::abs(unit.z()) - 1)) * half.z());
        }
    }
    return 1e9;
}

}  // namespace roevo::simulator
