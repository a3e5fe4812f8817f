#include "evaluation/ate.h"

#include "evaluation/alignment.h"

namespace roevo {

AbsoluteError absoluteTrajectoryError(const std::vector<StampedPose>& reference,
                                      const std::vector<StampedPose>& estimate,
                                      const std::vector<PosePair>& pairs) {
    std::vector<Eigen::Vector3d> source, target;
    for (const PosePair& pair : pairs) {
        source.push_back(estimate[pair.estimate].T_world_camera.translation());
        target.push_back(reference[pair.reference].T_world_camera.translation());
    }
    AbsoluteError result;
    result.T_reference_estimate = alignRigidly(source, target);
    std::vector<double> errors(pairs.size());
    for (std::size_t i = 0; i < errors.size(); ++i)
        errors[i] = (target[i] - result.T_reference_estimate * source[i]).norm();
    result.translation = errorStatistics(std::move(errors));
    return result;
}

}  // namespace roevo
