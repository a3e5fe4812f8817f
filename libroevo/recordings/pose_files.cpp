#include "recordings/pose_files.h"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <stdexcept>
#include <vector>

#include "recordings/text_list.h"
#include "roevo_mrpt/time_conversions.h"

namespace roevo {

Pose readPoseFile(const std::string& file) {
    constexpr double kRotationTolerance = 0.01;
    const auto values = readNumbers(file, 16, "a 4x4 matrix");
    const Eigen::Matrix4d matrix =
        Eigen::Map<const Eigen::Matrix<double, 4, 4, Eigen::RowMajor>>(values.data());
    const Eigen::Matrix3d rotation = matrix.topLeftCorner<3, 3>();
    if (!(rotation * rotation.transpose()).isApprox(Eigen::Matrix3d::Identity(), kRotationTolerance) ||
        rotation.determinant() < 0)
        throw std::runtime_error(file + ": the matrix is not a rotation and a translation");
    Pose pose = Pose::Identity();
    pose.setRotation(Eigen::Quaterniond(rotation).normalized().toRotationMatrix());
    pose.translation() = matrix.topRightCorner<3, 1>();
    return pose;
}

GroundTruth readPoseFiles(const std::map<double, std::string>& files, const std::string& place,
                          const Pose& T_posed_colour) {
    GroundTruth truth;
    std::size_t unusable = 0;
    std::string first_fault;
    for (const auto& [time, file] : files) {
        truth.file = place;
        try {
            truth.poses.push_back({roundToMicroseconds(time), readPoseFile(file) * T_posed_colour});
        } catch (const std::runtime_error& error) {
            if (unusable++ == 0) first_fault = error.what();
        }
    }
    if (unusable > 0) truth.note = std::to_string(unusable) + " left out, first: " + first_fault;
    return truth;
}

}  // namespace roevo
