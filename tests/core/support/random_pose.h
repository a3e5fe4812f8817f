#pragma once
#include <random>

#include "tracking/se3.h"

namespace roevo::testing {

inline double difference(const Pose& a, const Pose& b) {
    return (a.matrix() - b.matrix()).norm();
}

inline double uniform(std::mt19937& random, double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random);
}

/// Pose with each component of its increment uniform within the given bounds, m and rad.
inline Pose randomPose(std::mt19937& random, double translation, double rotation) {
    Vector6d xi;
    for (int k = 0; k < 3; ++k) {
        xi[k] = uniform(random, -translation, translation);
        xi[k + 3] = uniform(random, -rotation, rotation);
    }
    return poseIncrement(xi);
}

}  // namespace roevo::testing
