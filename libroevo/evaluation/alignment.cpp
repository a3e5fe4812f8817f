#include "evaluation/alignment.h"

#include <cmath>
#include <stdexcept>
#include <string>

namespace roevo {
namespace {

using Points = Eigen::Map<const Eigen::Matrix3Xd>;

void requireEnough(const std::vector<Eigen::Vector3d>& source, const std::vector<Eigen::Vector3d>& target) {
    if (source.size() != target.size() || source.size() < 3)
        throw std::invalid_argument("alignment needs two equally long lists of at least 3 points");
}

// A vector of Vector3d is one block of 3 x N doubles.
Points matrixOf(const std::vector<Eigen::Vector3d>& points) {
    return {points.front().data(), 3, static_cast<Eigen::Index>(points.size())};
}

}  // namespace

Pose alignRigidly(const std::vector<Eigen::Vector3d>& source, const std::vector<Eigen::Vector3d>& target) {
    requireEnough(source, target);
    return Pose(Eigen::umeyama(matrixOf(source), matrixOf(target), false));
}

Pose alignYaw(const std::vector<Eigen::Vector3d>& source, const std::vector<Eigen::Vector3d>& target) {
    requireEnough(source, target);
    const Points from = matrixOf(source), to = matrixOf(target);
    const Eigen::Vector3d from_mean = from.rowwise().mean(), to_mean = to.rowwise().mean();
    const Eigen::Matrix3d products = (to.colwise() - to_mean) * (from.colwise() - from_mean).transpose();
    // The sum to be minimised is, but for a constant, -2 (a cos + b sin) of the angle
    const double a = products(0, 0) + products(1, 1), b = products(1, 0) - products(0, 1);
    const Eigen::Quaterniond R(Eigen::AngleAxisd(std::atan2(b, a), Eigen::Vector3d::UnitZ()));
    return {R, to_mean - R * from_mean};
}

double bestScale(const std::vector<Eigen::Vector3d>& source, const std::vector<Eigen::Vector3d>& target) {
    requireEnough(source, target);
    const auto moves = [](const Points& points) { return !(points.colwise() - points.col(0)).isZero(0); };
    if (!moves(matrixOf(source)) || !moves(matrixOf(target)))
        throw std::runtime_error(std::string("the ") + (moves(matrixOf(source)) ? "reference" : "estimate") +
                                 " never moves: no scale can be told");
    return Eigen::umeyama(matrixOf(source), matrixOf(target), true).topLeftCorner<3, 3>().col(0).norm();
}

}  // namespace roevo
