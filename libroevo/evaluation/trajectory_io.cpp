#include "evaluation/trajectory_io.h"

#include <cstdio>
#include <filesystem>

#include "programs/atomic_file.h"
#include "programs/program.h"

namespace roevo {

std::string toTumLine(const StampedPose& pose) {
    const Eigen::Vector3d t = pose.T_world_camera.translation();
    Eigen::Quaterniond q(pose.T_world_camera.linear());
    if (q.w() < 0) q.coeffs() *= -1;  // q and -q are one rotation: write one of them always
    char line[320];
    std::snprintf(line, sizeof line, "%.6f %.9f %.9f %.9f %.9f %.9f %.9f %.9f", pose.timestamp, t.x(), t.y(),
                  t.z(), q.x(), q.y(), q.z(), q.w());
    return line;
}

NamedFile splitNamedFile(const std::string& argument) {
    const std::size_t equals = argument.find('=');
    std::error_code unseen;
    if (equals == std::string::npos || std::filesystem::exists(argument, unseen)) return {"", argument};
    if (equals == 0 || equals + 1 == argument.size()) throw UsageError("'" + argument + "' is not NAME=FILE");
    return {argument.substr(0, equals), argument.substr(equals + 1)};
}

void writeTumTrajectory(const std::string& path, const std::vector<StampedPose>& poses) {
    AtomicFile file(path);
    std::ostream& out = file.stream();
    out << "# timestamp tx ty tz qx qy qz qw\n";
    for (const StampedPose& pose : poses) out << toTumLine(pose) << '\n';
    file.commit();
}

}  // namespace roevo
