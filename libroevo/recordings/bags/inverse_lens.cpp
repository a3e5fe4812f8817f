#include "recordings/bags/inverse_lens.h"

#include <Eigen/Dense>
#include <cstdio>
#include <stdexcept>

namespace roevo {
namespace {

constexpr int kSteps = 24;             // of a grid over the image
constexpr double kLargestError = 0.1;  // pixels

/// What the five terms move a point of the image plane by, as columns: the model is linear in them.
Eigen::Matrix<double, 2, 5> shifts(const Eigen::Vector2d& p) {
    const double x = p.x(), y = p.y(), r2 = p.squaredNorm();
    Eigen::Matrix<double, 2, 5> out;
    out << x * r2, x * r2 * r2, 2 * x * y, r2 + 2 * x * x, x * r2 * r2 * r2,  //
        y * r2, y * r2 * r2, r2 + 2 * y * y, 2 * x * y, y * r2 * r2 * r2;
    return out;
}

}  // namespace

std::array<double, 5> distortionOfInverse(const PinholeCamera& ideal, const std::vector<double>& terms) {
    if (terms.size() != 5) throw std::runtime_error("an inverse lens model without its five terms");
    const Eigen::Map<const Eigen::Matrix<double, 5, 1>> inverse(terms.data());
    constexpr int kPoints = (kSteps + 1) * (kSteps + 1);
    Eigen::Matrix<double, Eigen::Dynamic, 5> shift(2 * kPoints, 5);
    Eigen::VectorXd wanted(2 * kPoints);
    for (int i = 0; i < kPoints; i++) {
        const double u = (ideal.width - 1.) * (i % (kSteps + 1)) / kSteps;
        const double v = (ideal.height - 1.) * (i / (kSteps + 1)) / kSteps;
        const Eigen::Vector2d pixel((u - ideal.cx) / ideal.fx, (v - ideal.cy) / ideal.fy);
        const Eigen::Vector2d ray = pixel + shifts(pixel) * inverse;
        shift.middleRows<2>(2 * i) = shifts(ray);
        wanted.segment<2>(2 * i) = pixel - ray;
    }
    const Eigen::Matrix<double, 5, 1> fitted = shift.colPivHouseholderQr().solve(wanted);
    const double off = ideal.fx * (shift * fitted - wanted).cwiseAbs().maxCoeff();
    if (!(off <= kLargestError)) {
        char text[100];
        std::snprintf(text, sizeof text, "its inverse lens model is %.3g pixels off when turned round", off);
        throw std::runtime_error(text);
    }
    std::array<double, 5> out{};
    Eigen::Map<Eigen::Matrix<double, 5, 1>>(out.data()) = fitted;
    return out;
}

}  // namespace roevo
