// What a user of the installed libraries writes first.
#include <roevo/odometry.h>
#include <roevo_mrpt/config_file.h>

#include <iostream>

int main() {
    roevo::OdometryOptions options;
    roevo::loadConfigText("[edges]\nmin_length = 12\n", "text", options);
    roevo::Odometry odometry({640, 480, 525, 525, 319.5, 239.5, {}}, options);
    roevo::RgbdFrame frame;
    frame.grey = cv::Mat::zeros(480, 640, CV_8UC1);
    frame.depth = cv::Mat::ones(480, 640, CV_32FC1);
    std::cout << roevo::toString(odometry.processFrame(frame).status) << '\n';
    return odometry.options().edges.min_length == 12 ? 0 : 1;
}
