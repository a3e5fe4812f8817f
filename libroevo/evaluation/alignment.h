#pragma once
#include <vector>

#include "roevo/types.h"

namespace roevo {

/// By which motion an estimate may be brought onto its reference.
enum class Alignment {
    kSe3,   ///< rotation and translation
    kSim3,  ///< and scale: for methods that cannot know it
    kYaw,   ///< rotation about z, and translation: for estimates that know where down is, as with an IMU
    kNone   ///< nothing: for estimates in the reference's own world
};

/// Rigid motion T (no scale) that minimises sum |target_i - T source_i|^2 (Umeyama, PAMI 1991).
/// @param source, target  points in metres, equally many, at least 3
/// @throws std::invalid_argument when they are fewer or not equally many
Pose alignRigidly(const std::vector<Eigen::Vector3d>& source, const std::vector<Eigen::Vector3d>& target);

/// The same with a rotation about z only.
Pose alignYaw(const std::vector<Eigen::Vector3d>& source, const std::vector<Eigen::Vector3d>& target);

/// Scale s of the similarity that minimises sum |target_i - s R source_i - t|^2 (Umeyama, PAMI 1991).
/// @throws std::runtime_error when one of them never moves
double bestScale(const std::vector<Eigen::Vector3d>& source, const std::vector<Eigen::Vector3d>& target);

}  // namespace roevo
