#pragma once
#include "intersect.h"
#include "roevo_simulator/scene.h"

namespace roevo::simulator {

/// A flat parametrisation of a primitive's surface: face index and metric coordinates from the middle of the
/// face.
struct FacePoint {
    int face = 0;
    float u = 0, v = 0, half_u = 1, half_v = 1;  ///< metres
};

/// Faces: quad 1; box 6 (axis * 2 + side); cylinder 3 (side, bottom, top); sphere 1 (longitude, latitude).
int faceCount(Shape shape);

/// @param unit, normal  in the primitive's unit coordinates
FacePoint facePointOf(const Primitive& primitive, const Eigen::Vector3d& unit, const Eigen::Vector3d& normal);

/// Half sizes of a face, metres.
FacePoint faceExtent(const Primitive& primitive, int face);

/// Inverse of facePointOf() for a, b in -1..1 over the face: unit coordinates and unit-frame normal.
void pointOnFace(const Primitive& primitive, int face, double a, double b, Eigen::Vector3d& unit,
                 Eigen::Vector3d& normal);

/// World direction of a normal given in unit coordinates.
inline Eigen::Vector3d worldNormal(const Primitive& primitive, const Eigen::Vector3d& unit_normal) {
    return (primitive.R_world_object * unit_normal.cwiseQuotient(primitive.half_size)).normalized();
}

}  // namespace roevo::simulator
