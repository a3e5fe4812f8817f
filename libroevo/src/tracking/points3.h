#pragma once
#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include "kernels/kernels.h"

namespace roevo {

/// Points in three dimensions, m: one array per coordinate, as the kernels read them.
struct Points3 {
    std::vector<float> x, y, z;

    std::size_t size() const { return x.size(); }  ///< with the padding, if there is one
    Eigen::Vector3d at(std::size_t i) const { return {x[i], y[i], z[i]}; }
    void add(float px, float py, float pz) {
        x.push_back(px);
        y.push_back(py);
        z.push_back(pz);
    }
    void add(const Eigen::Vector3d& point) {
        add(static_cast<float>(point.x()), static_cast<float>(point.y()), static_cast<float>(point.z()));
    }
    /// Appends points at (0, 0, 1), which any camera can project, up to a multiple of the kernels' lanes.
    void pad() {
        const std::size_t padded = kernels::paddedSize(size());
        x.resize(padded, 0);
        y.resize(padded, 0);
        z.resize(padded, 1);
    }
};

/// Points moved into a camera (m) and where it sees them (px); far outside the image where behind it.
struct ProjectedPoints3 : Points3 {
    std::vector<float> u, v;
};

}  // namespace roevo
