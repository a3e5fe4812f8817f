#pragma once
/// For tests of roevo-render's 3-D view: a result folder to make pages of.

#include <cmath>

#include "evaluation/trajectory_io.h"
#include "roevo_mrpt/scene_builder.h"
#include "web_page.h"

namespace roevo::test {

constexpr Rgb kMagenta{250, 30, 250};

// A circle in the plane y = 0, as a camera that turns with it would walk it.
inline std::vector<StampedPose> circle(double radius) {
    std::vector<StampedPose> poses;
    for (int i = 0; i < 60; ++i) {
        const double angle = 2 * kPi * i / 60;
        poses.push_back(
            {100 + 0.1 * i, Pose(Eigen::Quaterniond(Eigen::AngleAxisd(angle, Eigen::Vector3d::UnitY())),
                                 {radius * std::sin(angle), 0, radius * std::cos(angle)})});
    }
    return poses;
}

inline std::vector<StampedPose> moved(const Pose& T, std::vector<StampedPose> poses) {
    for (StampedPose& pose : poses) pose.T_world_camera = T * pose.T_world_camera;
    return poses;
}

inline const Pose kElsewhere(Eigen::Quaterniond(Eigen::AngleAxisd(1.1,
                                                                  Eigen::Vector3d(1, 2, 3).normalized())),
                             {5, -7, 2});

inline MapEdge lineOf(const Eigen::Vector3f& from, const Eigen::Vector3f& to, int points) {
    MapEdge edge;
    for (int i = 0; i < points; ++i) {
        edge.points.push_back(from + (to - from) * static_cast<float>(i) / static_cast<float>(points - 1));
        edge.colours.push_back(kMagenta);
    }
    return edge;
}

/// A result folder as roevo-odometry leaves it: a circle of radius 1 in a room.
class RenderPage : public testing::Test {
  protected:
    void SetUp() override {
        std::filesystem::create_directories(result());
        writeTumTrajectory(result() + "/trajectory.txt", circle(1));
        writeTumTrajectory(result() + "/trajectory_live.txt", circle(1.02));
        writeTumTrajectory(result() + "/keyframes.txt", {circle(1)[0], circle(1)[20]});
        for (const float y : {-1.2f, 1.2f})
            for (const float x : {-2.f, 2.f}) {
                map_.push_back(lineOf({x, y, -2}, {x, y, 2}, 200));
                map_.push_back(lineOf({-2, y, x}, {2, y, x}, 150));
            }
        map_.push_back(lineOf({0, 0, 500}, {0.1f, 0, 500}, 10));  // far off: it may not spoil the others
        savePly(result() + "/map.ply", map_);
        for (int i = 0; i < 3000; ++i)
            surface_.push_back(
                {{2 * std::sin(0.01f * static_cast<float>(i)), 1.f, 0.001f * static_cast<float>(i)},
                 {static_cast<std::uint8_t>(i % 256), 7, 200}});
        savePointsPly(result() + "/map_semi_dense.ply", surface_);
        writeSummary();
    }

    void writeSummary(const nlohmann::json& more = nlohmann::json::object()) const {
        nlohmann::json summary = {{"input", {{"path", "data/some room/"}}}, {"mode", "ba"}};
        summary["camera"] = {{"width", 640}, {"height", 480}, {"fx", 525},
                             {"fy", 525},    {"cx", 319.5},   {"cy", 239.5}};
        summary.update(more);
        writeFile(result() + "/summary.json", summary.dump());
    }

    std::string result() const { return folder_ / "result"; }
    std::string page() const { return folder_ / "view.html"; }

    ProgramResult render(const std::vector<std::string>& more = {}) const {
        std::vector<std::string> arguments{"--input", result(), "--output", page()};
        arguments.insert(arguments.end(), more.begin(), more.end());
        return runProgram("roevo-render", arguments);
    }

    nlohmann::json data() const { return dataOf(readFile(page())); }

    TemporaryFolder folder_;
    EdgeMap map_;
    std::vector<ColouredPoint> surface_;
};

}  // namespace roevo::test
