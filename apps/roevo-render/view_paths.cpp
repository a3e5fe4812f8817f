#include "view_paths.h"

#include <limits>
#include <stdexcept>

#include "evaluation/evaluate.h"

namespace roevo {
namespace {

Evaluation evaluateNamed(const std::vector<StampedPose>& reference, const NamedPath& path) {
    try {
        return evaluate(reference, path.poses);
    } catch (const std::runtime_error& e) {
        throw std::runtime_error(path.name + ": " + e.what());
    }
}

std::vector<StampedPose> moved(const Pose& T, std::vector<StampedPose> poses) {
    for (StampedPose& pose : poses) pose.T_world_camera = T * pose.T_world_camera;
    return poses;
}

// Distance of each pose to that of the truth, both in one world.
std::vector<float> errorsOf(const std::vector<StampedPose>& poses, const std::vector<StampedPose>& truth,
                            const std::vector<PosePair>& pairs) {
    std::vector<float> errors(poses.size(), std::numeric_limits<float>::quiet_NaN());
    for (const PosePair& pair : pairs) {
        const Eigen::Vector3d difference = poses[pair.estimate].T_world_camera.translation() -
                                           truth[pair.reference].T_world_camera.translation();
        errors[pair.estimate] = static_cast<float>(difference.norm());
    }
    return errors;
}

}  // namespace

std::vector<ViewPath> alignPaths(const std::vector<NamedPath>& paths, std::size_t foreign,
                                 const NamedPath& truth) {
    std::vector<ViewPath> views;
    if (truth.poses.empty()) {
        for (std::size_t i = 0; i < paths.size(); ++i) {
            const Pose T = i < foreign
                               ? Pose::Identity()
                               : evaluateNamed(paths.front().poses, paths[i]).ate.T_reference_estimate;
            views.push_back({paths[i].name, moved(T, paths[i].poses), {}, {}});
        }
        return views;
    }
    std::vector<StampedPose> truth_in_world;
    for (const NamedPath& path : paths) {
        const Evaluation e = evaluateNamed(truth.poses, path);
        if (views.empty()) truth_in_world = moved(e.ate.T_reference_estimate.inverse(), truth.poses);
        // Where the truth is in the first one's world, the alignment with the truth leads there
        const Pose T_world_truth =
            truth_in_world.front().T_world_camera * truth.poses.front().T_world_camera.inverse();
        ViewPath view{path.name,
                      moved(T_world_truth * e.ate.T_reference_estimate, path.poses),
                      {},
                      e.ate.translation.rmse};
        view.errors = errorsOf(view.poses, truth_in_world, e.pairs);
        views.push_back(std::move(view));
    }
    views.push_back({truth.name, coveredPart(truth_in_world, paths.front().poses), {}, {}});
    return views;
}

}  // namespace roevo
