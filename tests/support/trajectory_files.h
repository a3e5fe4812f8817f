#pragma once
#include <cmath>
#include <cstdio>
#include <string>
#include <vector>

#include "roevo/types.h"

namespace roevo::test {

/// Poses as EuRoC's ground truth has them, with a head and further columns.
inline std::string eurocText(const std::vector<StampedPose>& poses) {
    std::string text =
        "#timestamp, p_RS_R_x [m], p_RS_R_y [m], p_RS_R_z [m], q_RS_w [], q_RS_x [], q_RS_y []\r\n";
    for (const StampedPose& pose : poses) {
        const Eigen::Vector3d p = pose.T_world_camera.translation();
        const Eigen::Quaterniond q = pose.T_world_camera.rotation();
        char row[300];
        std::snprintf(row, sizeof row, "%lld,%.12f,%.12f,%.12f,%.12f,%.12f,%.12f,%.12f,0.1,-0.2\r\n",
                      static_cast<long long>(std::llround(pose.timestamp * 1e9)), p.x(), p.y(), p.z(), q.w(),
                      q.x(), q.y(), q.z());
        text += row;
    }
    return text;
}

}  // namespace roevo::test
