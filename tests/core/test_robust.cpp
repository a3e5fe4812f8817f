#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

#include "tracking/robust.h"

namespace roevo {
namespace {

TEST(Robust, MedianOfMagnitudesIsTheOneThatSortingFinds) {
    std::mt19937 random(3);
    std::normal_distribution<float> normal;
    for (int trial = 0; trial < 300; ++trial) {
        std::vector<float> values(1 + random() % 500);
        const float scale = std::pow(10.0F, static_cast<float>(random() % 60) - 30);
        for (float& value : values) {
            value = std::abs(normal(random)) * scale;
            if (random() % 8 == 0) value = 0;
            if (trial % 3 == 0) value = std::round(value / scale) * scale;  // many that are equal
        }
        std::vector<float> sorted = values;
        std::sort(sorted.begin(), sorted.end());
        EXPECT_EQ(medianOfMagnitudes(values), sorted[sorted.size() / 2]) << trial;
    }
}

TEST(Robust, MedianOfMagnitudesAtTheEndsOfFloats) {
    const float small = std::numeric_limits<float>::denorm_min(), large = std::numeric_limits<float>::max(),
                infinite = std::numeric_limits<float>::infinity();
    std::vector<float> values{infinite, 0, large, -0.0F, small};
    EXPECT_EQ(medianOfMagnitudes(values), small);
    values = {infinite, infinite, large};
    EXPECT_EQ(medianOfMagnitudes(values), infinite);
    values = {7};
    EXPECT_EQ(medianOfMagnitudes(values), 7);
}

}  // namespace
}  // namespace roevo
