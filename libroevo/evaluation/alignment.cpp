#include "evaluation/alignment.h"

#include <stdexcept>

namespace roevo {

Pose alignRigidly(const std::vector<Eigen::Vector3d>& source, const std::vector<Eigen::Vector3d>& target) {
    if (source.size() != target.size() || source.size() < 3)
        throw std::invalid_argument("alignment needs two equally long lists of at least 3 points");
    using Points = Eigen::Map<const Eigen::Matrix3Xd>;
    const auto count = static_cast<Eigen::Index>(source.size());
    // A vector of Vector3d is one block of 3 x N doubles.
    const Points from(source.front().data(), 3, count), to(target.front().data(), 3, count);
    return Pose(Eigen::umeyama(from, to, false));
}

}  // namespace roevo
