#pragma once
/// Place points without images: random positions and descriptors, and the same seen again with errors.

#include <cmath>
#include <random>

#include "core/support/random_pose.h"
#include "place/place_points.h"

namespace roevo::testing {

inline std::mt19937 seeded(int seed) {
    return std::mt19937(static_cast<std::mt19937::result_type>(seed));
}

inline Descriptor randomDescriptor(std::mt19937& random) {
    Descriptor out;
    for (auto& word : out.words) word = (std::uint64_t{random()} << 32) | std::uint64_t{random()};
    return out;
}

/// With each bit flipped at this probability.
inline Descriptor noisy(Descriptor descriptor, double probability, std::mt19937& random) {
    for (std::size_t bit = 0; bit < Descriptor::kBits; ++bit)
        if (uniform(random, 0, 1) < probability) descriptor.words[bit / 64] ^= std::uint64_t{1} << (bit % 64);
    return descriptor;
}

/// Points anywhere 1 to 4 m before the camera, all looking different.
inline PlacePoints randomPlace(std::size_t count, std::mt19937& random) {
    PlacePoints points(count);
    for (PlacePoint& point : points) {
        const double z = uniform(random, 1, 4);
        point.x = static_cast<float>(z * uniform(random, -0.5, 0.5));
        point.y = static_cast<float>(z * uniform(random, -0.4, 0.4));
        point.z = static_cast<float>(z);
        point.normal_angle = static_cast<float>(uniform(random, -3.14, 3.14));
        point.descriptor = randomDescriptor(random);
    }
    return points;
}

/// The place from T_now_before * the same camera: positions off by `sigma` m, bits flipped.
inline PlacePoints seenAgain(const PlacePoints& before, const Pose& T_now_before, double sigma, double flips,
                             std::mt19937& random) {
    const Eigen::Matrix3d& R = T_now_before.linear();
    const double roll = std::atan2(R(1, 0) - R(0, 1), R(0, 0) + R(1, 1));
    std::normal_distribution<double> error(0, sigma);
    PlacePoints now = before;
    for (PlacePoint& point : now) {
        const Eigen::Vector3d p = T_now_before * Eigen::Vector3d(point.x, point.y, point.z);
        point.x = static_cast<float>(p.x() + error(random));
        point.y = static_cast<float>(p.y() + error(random));
        point.z = static_cast<float>(p.z() + error(random));
        point.normal_angle = static_cast<float>(std::remainder(
            static_cast<double>(point.normal_angle) + roll + uniform(random, -0.2, 0.2), 2 * kPi));
        point.descriptor = noisy(point.descriptor, flips, random);
    }
    return now;
}

}  // namespace roevo::testing
