#include "evaluation/ate.h"

#include <stdexcept>

namespace roevo {

AbsoluteError absoluteTrajectoryError(const std::vector<StampedPose>& reference,
                                      const std::vector<StampedPose>& estimate,
                                      const std::vector<PosePair>& pairs, Alignment alignment) {
    if (alignment == Alignment::kSim3) throw std::invalid_argument("the estimate has to be scaled before");
    std::vector<Eigen::Vector3d> source, target;
    for (const PosePair& pair : pairs) {
        source.push_back(estimate[pair.estimate].T_world_camera.translation());
        target.push_back(reference[pair.reference].T_world_camera.translation());
    }
    AbsoluteError result;
    if (alignment == Alignment::kSe3) result.T_reference_estimate = alignRigidly(source, target);
    if (alignment == Alignment::kYaw) result.T_reference_estimate = alignYaw(source, target);
    std::vector<double> errors(pairs.size());
    for (std::size_t i = 0; i < errors.size(); ++i)
        errors[i] = (target[i] - result.T_reference_estimate * source[i]).norm();
    result.translation = errorStatistics(std::move(errors));
    return result;
}

}  // namespace roevo
