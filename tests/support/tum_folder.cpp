#include "support/tum_folder.h"

#include <cstdio>
#include <fstream>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <stdexcept>

namespace roevo::test {
namespace {

constexpr int kWidth = 320, kHeight = 240;
constexpr double kFocal = 300, kWallDepth = 2.5, kBoxDepth = 1.5, kStep = 0.01, kPeriod = 1.0 / 30,
                 kStart = 100;

// Metres on the wall or on the front of the box -> pixels, for a camera at x = camera_x.
cv::Point2d project(double x, double y, double z, double camera_x) {
    return {kFocal * (x - camera_x) / z + kWidth / 2.0, kFocal * y / z + kHeight / 2.0};
}

void drawRectangle(cv::Mat& image, cv::Rect2d metres, double z, double camera_x, const cv::Scalar& colour) {
    constexpr int kShift = 6;  // cv::rectangle's fractional bits: edges must move by fractions of a pixel
    const auto fixed = [&](cv::Point2d p) {
        return cv::Point(cvRound(p.x * (1 << kShift)), cvRound(p.y * (1 << kShift)));
    };
    const cv::Point2d a = project(metres.x, metres.y, z, camera_x);
    const cv::Point2d b = project(metres.x + metres.width, metres.y + metres.height, z, camera_x);
    const cv::Point corners[] = {fixed(a), fixed({b.x, a.y}), fixed(b), fixed({a.x, b.y})};
    cv::fillConvexPoly(image, corners, 4, colour, cv::LINE_AA, kShift);
}

}  // namespace

std::vector<TumFrame> slidingRecording(int num_frames) {
    std::vector<TumFrame> frames;
    for (int i = 0; i < num_frames; ++i) {
        const double camera_x = i * kStep;
        TumFrame frame;
        frame.timestamp = kStart + i * kPeriod;
        frame.colour = cv::Mat(kHeight, kWidth, CV_8UC3, cv::Scalar(150, 160, 170));
        frame.depth = cv::Mat(kHeight, kWidth, CV_16UC1, cv::Scalar(kWallDepth * 5000));
        cv::RNG random(7);  // the same wall in every frame
        for (int k = 0; k < 40; ++k) {
            const cv::Rect2d where(random.uniform(-1.6, 1.9), random.uniform(-1.0, 0.8),
                                   random.uniform(0.1, 0.5), random.uniform(0.1, 0.4));
            drawRectangle(frame.colour, where, kWallDepth, camera_x,
                          cv::Scalar(random.uniform(0, 255), random.uniform(0, 255), random.uniform(0, 255)));
        }
        const cv::Rect2d box(-0.2, 0.0, 0.5, 0.4);
        drawRectangle(frame.colour, box, kBoxDepth, camera_x, cv::Scalar(40, 60, 200));
        drawRectangle(frame.depth, box, kBoxDepth, camera_x, cv::Scalar(kBoxDepth * 5000));
        frames.push_back(frame);
    }
    return frames;
}

std::string cameraText(double depth_scale) {
    return "width: 320\nheight: 240\nfx: 300\nfy: 300\ncx: 160\ncy: 120\ndepth_scale: " +
           std::to_string(depth_scale) + "\n";
}

void writeTumFolder(const std::filesystem::path& folder, const std::vector<TumFrame>& frames) {
    std::filesystem::create_directories(folder / "rgb");
    std::filesystem::create_directories(folder / "depth");
    std::ofstream colour_list(folder / "rgb.txt"), depth_list(folder / "depth.txt"),
        truth(folder / "groundtruth.txt");
    for (std::size_t i = 0; i < frames.size(); ++i) {
        const TumFrame& frame = frames[i];
        char name[32], line[128];
        std::snprintf(name, sizeof name, "%04zu.png", i);
        std::snprintf(line, sizeof line, "%.6f ", frame.timestamp);
        colour_list << line << "rgb/" << name << '\n';
        depth_list << line << "depth/" << name << '\n';
        std::snprintf(line, sizeof line, "%.6f %.6f 0 0 0 0 0 1\n", frame.timestamp,
                      static_cast<double>(i) * kStep);
        truth << line;
        if (!cv::imwrite((folder / "rgb" / name).string(), frame.colour) ||
            !cv::imwrite((folder / "depth" / name).string(), frame.depth))
            throw std::runtime_error("cannot write images into " + folder.string());
    }
    std::ofstream(folder / "camera.txt") << cameraText();
}

}  // namespace roevo::test
