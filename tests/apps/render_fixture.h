#pragma once
#include <gtest/gtest.h>

#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include "evaluation/trajectory_io.h"
#include "roevo_mrpt/scene_builder.h"
#include "support/run_program.h"

namespace roevo::test {

// A room of 4 x 3 x 2.5 m seen from its middle, with a few points 500 m away that must not make it a speck.
inline void writeRoom(const std::string& scene_file, const std::string& trajectory_file) {
    SceneContent content;
    const auto line = [&](Eigen::Vector3f a, Eigen::Vector3f b, std::array<std::uint8_t, 3> colour) {
        MapEdge edge;
        for (int i = 0; i <= 300; ++i) {
            edge.points.push_back(a + (b - a) * static_cast<float>(i) / 300);
            edge.colours.push_back(colour);
        }
        content.map.push_back(edge);
    };
    for (const float y : {-1.25f, 1.25f}) {  // optical axes: y down, z forward
        line({-2, y, -1}, {2, y, -1}, {255, 255, 255});
        line({-2, y, 2}, {2, y, 2}, {255, 255, 255});
        line({-2, y, -1}, {-2, y, 2}, {250, 30, 30});
        line({2, y, -1}, {2, y, 2}, {30, 250, 30});
    }
    MapEdge stray;
    for (int i = 0; i < 5; ++i) stray.points.emplace_back(0.f, 0.f, 500.f + static_cast<float>(i));
    stray.colours.resize(5);
    content.map.push_back(stray);
    for (int i = 0; i < 20; ++i) {
        StampedPose pose;
        pose.timestamp = i;
        pose.T_world_camera.translation().x() = 0.03 * i;
        content.trajectory.push_back(pose);
    }
    content.keyframes.push_back({0, 0, Pose::Identity()});
    content.camera = PinholeCamera{640, 480, 525, 525, 319.5, 239.5, {}};
    saveScene(scene_file, *buildScene(content));
    writeTumTrajectory(trajectory_file, content.trajectory);
}

class RenderProgram : public testing::Test {
  protected:
    RenderProgram() { writeRoom(folder_ / "room.3Dscene", folder_ / "trajectory.txt"); }

    ProgramResult render(const std::vector<std::string>& more) const {
        std::vector<std::string> arguments{"--scene", folder_ / "room.3Dscene", "--output",
                                           folder_ / "room.png"};
        arguments.insert(arguments.end(), more.begin(), more.end());
        return runProgram("roevo-render", arguments);
    }

    // The picture's part that is clearly brighter than the background, 0..1, by bounding box.
    static cv::Rect brightBox(const cv::Mat& picture) {
        cv::Mat channels[3], brightest;
        cv::split(picture, channels);
        cv::max(channels[0], channels[1], brightest);
        cv::max(brightest, channels[2], brightest);
        return cv::boundingRect(brightest > 100);
    }

    TemporaryFolder folder_;
};

}  // namespace roevo::test
