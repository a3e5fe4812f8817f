#include "block_way.h"

#include <cmath>

#include "roevo/types.h"

namespace roevo::simulator::block {
namespace {

constexpr double kStep = 2;     // metres between way-points
constexpr double kAhead = 3;    // metres from a way-point to what it looks at, along the way
constexpr double kAside = 1.5;  // metres: the sight swings from one wall to the other

struct Place {
    Eigen::Vector3d point, left;  ///< on the floor; to the left of the way on
};

/// The centre line `s` metres counter-clockwise from its south-west corner.
Place centreLine(double s) {
    const double half = kRingLength + kRingWidth;
    const double rest = s - half * std::floor(s / half);
    const bool back = std::fmod(std::floor(s / half), 2) != 0;
    Place place{{rest, 0, 0}, Eigen::Vector3d::UnitY()};
    if (rest > kRingLength) place = {{kRingLength, rest - kRingLength, 0}, -Eigen::Vector3d::UnitX()};
    if (back) place = {Eigen::Vector3d(kRingLength, kRingWidth, 0) - place.point, -place.left};
    return place;
}

}  // namespace

std::vector<Waypoint> roundTheBlock(bool counter_clockwise) {
    const double round = 2 * (kRingLength + kRingWidth), way = counter_clockwise ? 1 : -1;
    const int count = static_cast<int>(std::lround(round / kStep));
    std::vector<Waypoint> loop;
    for (int i = 1; i <= count; ++i) {
        const double s = round + way * kStep * i;
        const Place here = centreLine(s), there = centreLine(s + way * kAhead);
        const double height = 1.4 + 0.05 * std::sin(2 * kPi * 3 * i / (0.5 * count));
        const double aside = kAside * std::sin(0.5 * kPi * i);
        loop.push_back({here.point + Eigen::Vector3d(0, 0, height),
                        there.point + aside * there.left + Eigen::Vector3d(0, 0, 1.2)});
    }
    return loop;
}

}  // namespace roevo::simulator::block
