// The core alone: images as they come from a camera, here from two folders of files that are read in order of
// their names. Prints the trajectory: x y z of the camera, metres, and how sure it is.
//   images RGB_FOLDER DEPTH_FOLDER FX FY CX CY DEPTH_UNITS_PER_METRE
#include <roevo/odometry.h>

#include <cstdio>
#include <cstdlib>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

namespace {

constexpr double kFrameInterval = 1 / 30.0;  // s

roevo::RgbdFrame readFrame(const std::string& colour, const std::string& depth, double units_per_metre) {
    roevo::RgbdFrame frame;
    frame.colour = cv::imread(colour);  // BGR
    cv::cvtColor(frame.colour, frame.grey, cv::COLOR_BGR2GRAY);
    cv::imread(depth, cv::IMREAD_UNCHANGED).convertTo(frame.depth, CV_32F, 1 / units_per_metre);
    return frame;
}

int run(const char* const* arguments) {
    std::vector<cv::String> colour, depth;
    cv::glob(arguments[1], colour);
    cv::glob(arguments[2], depth);
    if (colour.empty() || colour.size() != depth.size())
        throw std::runtime_error("the folders must have as many images, one at least");
    const cv::Mat first = cv::imread(colour[0]);
    const roevo::PinholeCamera camera{first.cols,
                                      first.rows,
                                      std::atof(arguments[3]),
                                      std::atof(arguments[4]),
                                      std::atof(arguments[5]),
                                      std::atof(arguments[6]),
                                      {}};
    roevo::Odometry odometry(camera, roevo::OdometryOptions());
    for (std::size_t i = 0; i < colour.size(); ++i) {
        roevo::RgbdFrame frame = readFrame(colour[i], depth[i], std::atof(arguments[7]));
        frame.timestamp = static_cast<double>(i) * kFrameInterval;
        const roevo::FrameResult result = odometry.processFrame(frame);
        if (!result.hasPose()) {
            std::printf("%s %s\n", toString(result.status), result.reason.c_str());
            continue;
        }
        const Eigen::Vector3d& t = result.T_world_camera.translation();
        std::printf("%s %.4f %.4f %.4f +- %.4f %s\n", toString(result.status), t.x(), t.y(), t.z(),
                    result.sigmaTranslation(), result.reason.c_str());
    }
    return 0;
}

}  // namespace

int main(int count, char** arguments) try {
    if (count == 8) return run(arguments);
    std::fprintf(stderr, "usage: images RGB_FOLDER DEPTH_FOLDER FX FY CX CY DEPTH_UNITS_PER_METRE\n");
    return 2;
} catch (const std::exception& error) {
    std::fprintf(stderr, "images: error: %s\n", error.what());
    return 1;
}
