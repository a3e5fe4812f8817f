#pragma once
/// Types used everywhere in the core. Poses are named `T_a_b`: they map a point given in frame b into frame
/// a.

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <type_traits>

namespace roevo {

inline constexpr double kPi = 3.14159265358979323846;
inline constexpr double kDegree = kPi / 180;  ///< rad

/// Eigen lays out matrices otherwise under -mavx or -march=native. The library has this for what it was built
/// with alone: where a program differs, it does not link, in place of reading garbage. Build both alike, or
/// the program with -DEIGEN_MAX_ALIGN_BYTES=16.
template <int bytes>
bool builtWithEigenAlignment();
inline const bool is_laid_out_alike = builtWithEigenAlignment<EIGEN_MAX_STATIC_ALIGN_BYTES>();

static_assert(!Eigen::Matrix3d::IsRowMajor,
              "ROEVO's matrices are column by column: no EIGEN_DEFAULT_TO_ROW_MAJOR");

using Matrix6d = Eigen::Matrix<double, 6, 6>;
using Vector6d = Eigen::Matrix<double, 6, 1>;

/// A rigid motion, which no chain of products or inverses can turn into anything else: the rotation is a unit
/// quaternion, normalised in every composition, and the matrix follows from it.
class Pose {
  public:
    Pose() = default;
    /// @param rotation  of unit length or not
    Pose(const Eigen::Quaterniond& rotation, const Eigen::Vector3d& translation)
        : rotation_(rotation.normalized()),
          matrix_(rotation_.toRotationMatrix()),
          translation_(translation) {}
    /// Takes the rotation next to a matrix that is one but for rounding.
    Pose(const Eigen::Isometry3d& pose)  // NOLINT: Eigen's own type is welcome wherever a pose is
        : Pose(Eigen::Quaterniond(pose.linear()), pose.translation()) {}
    /// Of whatever Eigen makes a rigid motion of: a translation, an angle and its axis, a 4x4 matrix.
    template <class Motion,
              class = std::enable_if_t<std::is_constructible_v<Eigen::Isometry3d, const Motion&>>>
    explicit Pose(const Motion& motion) : Pose(Eigen::Isometry3d(motion)) {}

    static Pose Identity() { return {}; }

    const Eigen::Matrix3d& linear() const { return matrix_; }
    const Eigen::Quaterniond& rotation() const { return rotation_; }
    const Eigen::Vector3d& translation() const { return translation_; }  ///< m
    Eigen::Vector3d& translation() { return translation_; }
    /// @param rotation  anything that Eigen makes a quaternion of
    template <class Rotation>
    void setRotation(const Rotation& rotation) {
        *this = Pose(Eigen::Quaterniond(rotation), translation_);
    }

    /// Exact: the transposed rotation, not a solved system.
    Pose inverse() const {
        Pose result;
        result.rotation_ = rotation_.conjugate();
        result.matrix_ = matrix_.transpose();
        result.translation_ = -(result.matrix_ * translation_);
        return result;
    }
    Pose operator*(const Pose& other) const {
        return {rotation_ * other.rotation_, matrix_ * other.translation_ + translation_};
    }
    Eigen::Vector3d operator*(const Eigen::Vector3d& point) const { return matrix_ * point + translation_; }

    Eigen::Isometry3d isometry() const {
        Eigen::Isometry3d result = Eigen::Isometry3d::Identity();
        result.linear() = matrix_;
        result.translation() = translation_;
        return result;
    }
    Eigen::Matrix4d matrix() const { return isometry().matrix(); }  ///< homogeneous
    template <class Scalar>
    Eigen::Transform<Scalar, 3, Eigen::Isometry> cast() const {
        return isometry().cast<Scalar>();
    }
    bool isFinite() const { return matrix_.allFinite() && translation_.allFinite(); }
    bool isApprox(const Pose& other, double precision = 1e-12) const {
        return isometry().isApprox(other.isometry(), precision);
    }

  private:
    Eigen::Quaterniond rotation_ = Eigen::Quaterniond::Identity();
    Eigen::Matrix3d matrix_ = Eigen::Matrix3d::Identity();
    Eigen::Vector3d translation_ = Eigen::Vector3d::Zero();
};

/// A pose with its time (seconds). T_world_camera maps optical camera coordinates into the world.
struct StampedPose {
    double timestamp = 0;
    Pose T_world_camera = Pose::Identity();
};

}  // namespace roevo
