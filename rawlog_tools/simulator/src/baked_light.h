#pragma once
#include <array>
#include <vector>

#include "surface.h"

namespace roevo::simulator {

/// Soft shadows and the darkening of corners, computed once per scene on a grid over every face: how much of
/// each lamp (those without sharp shadows) and of the surroundings a point sees.
class BakedLight {
  public:
    static constexpr int kMaxLights = 3;
    /// Shares 0..1: [0] of the surroundings, [1 + i] of lamp i.
    using Shares = std::array<float, 1 + kMaxLights>;

    BakedLight(const Scene& scene, int threads);

    Shares at(int primitive, const FacePoint& point) const;

  private:
    struct Grid {
        int columns = 0, rows = 0;
        size_t first = 0;
    };
    std::vector<std::array<Grid, 6>> grids_;
    std::vector<Shares> values_;
};

}  // namespace roevo::simulator
