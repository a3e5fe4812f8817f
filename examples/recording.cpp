// Odometry on any recording: a dataset folder, a rawlog or a bag. Prints the trajectory in TUM's format.
//   recording INPUT
#include <recordings/frame_source.h>
#include <roevo/odometry.h>

#include <cstdio>

int main(int count, char** arguments) try {
    if (count != 2) return std::fprintf(stderr, "usage: recording INPUT\n"), 2;
    const auto source = roevo::openSource(arguments[1]);
    roevo::Odometry odometry(source->camera(), roevo::OdometryOptions());

    for (roevo::SourceFrame input; source->next(input);) {
        if (!input.fault.empty()) continue;  // such an image cannot be read; the others can
        const roevo::FrameResult result = odometry.processFrame(input.frame);
        if (!result.reason.empty())
            std::fprintf(stderr, "%.6f %s: %s\n", result.timestamp, toString(result.status),
                         result.reason.c_str());
    }
    odometry.refineAll();

    std::printf("# timestamp tx ty tz qx qy qz qw\n");
    for (const roevo::StampedPose& pose : odometry.trajectory()) {
        const Eigen::Vector3d& t = pose.T_world_camera.translation();
        Eigen::Quaterniond q(pose.T_world_camera.linear());
        if (q.w() < 0) q.coeffs() *= -1;  // q and -q are one rotation
        std::printf("%.6f %.9f %.9f %.9f %.9f %.9f %.9f %.9f\n", pose.timestamp, t.x(), t.y(), t.z(), q.x(),
                    q.y(), q.z(), q.w());
    }
    return 0;
} catch (const std::exception& error) {
    std::fprintf(stderr, "recording: error: %s\n", error.what());
    return 1;
}
