#pragma once
/// Small RGB-D recordings in TUM layout that a test makes itself.

#include <filesystem>
#include <functional>
#include <opencv2/core/mat.hpp>
#include <string>
#include <vector>

namespace roevo::test {

/// One frame of a made-up recording; a test may spoil it before it is written.
struct TumFrame {
    double timestamp = 0;
    cv::Mat colour;  ///< CV_8UC3
    cv::Mat depth;   ///< CV_16UC1, 5000 per metre
};

/// A wall of drawn rectangles and a box before it, seen by a camera that slides sideways by 1 cm per frame
/// (30 Hz). 320 x 240 pixels, f = 300.
std::vector<TumFrame> slidingRecording(int num_frames);

/// Writes rgb/, depth/, rgb.txt, depth.txt, camera.txt and groundtruth.txt.
void writeTumFolder(const std::filesystem::path& folder, const std::vector<TumFrame>& frames);

/// Text of camera.txt for these recordings.
std::string cameraText(double depth_scale = 5000);

}  // namespace roevo::test
