// Whether the map tells edges of the world from borders of moving cast shadows: the simulator knows.
#include <gtest/gtest.h>

#include <map>

#include "core/support/simulated.h"

namespace roevo {
namespace {

constexpr int kShadowFrames = 130, kBorder = 2;  // px; as simulator::SimulatedFrame::shadow_border

/// Whether the pixel lies within kBorder of where one object ends and another begins.
bool onObjectBorder(const cv::Mat& objects, int u, int v) {
    for (int dv = -kBorder; dv <= kBorder; ++dv) {
        for (int du = -kBorder; du <= kBorder; ++du) {
            const int x = std::clamp(u + du, 0, objects.cols - 1),
                      y = std::clamp(v + dv, 0, objects.rows - 1);
            if (objects.at<std::int32_t>(y, x) != objects.at<std::int32_t>(v, u)) return true;
        }
    }
    return false;
}

struct Count {
    int all = 0, kept_out = 0, pseudo = 0;

    void add(EdgeVerdict verdict) {
        ++all;
        kept_out += verdict == EdgeVerdict::kTrue ? 0 : 1;  // optimised are true edges only
        pseudo += isPseudo(verdict) ? 1 : 0;
    }
};

TEST(ShadowEdges, ThoseOfMovingShadowsAreKeptOutAndOthersAreNot) {
    simulator::SimulationOptions options;
    options.scene = "shadows";
    options.fps = 15;
    options.useKinectNoise();
    const simulator::Simulator simulator(options);
    struct Masks {
        cv::Mat shadow_border, objects;
    };
    std::map<double, Masks> masks;  // by the stamp of the frame
    Odometry odometry(simulator.camera(), OdometryOptions());
    double longest_readout = 0;
    for (int i = 0; i < kShadowFrames; ++i) {
        const simulator::SimulatedFrame frame = simulator.frame(i);
        (void)odometry.processFrame({frame.timestamp, frame.grey, frame.depth_noisy, cv::Mat()});
        longest_readout = std::max(longest_readout, std::abs(odometry.readoutTime()));
        masks[frame.timestamp] = {frame.shadow_border, frame.objects};
    }
    std::map<int, KeyframeInfo> keyframes;
    odometry.trajectory();  // waits for the mapper
    for (const KeyframeInfo& keyframe : odometry.keyframes()) keyframes[keyframe.id] = keyframe;
    Count shadows, others;
    for (const MapEdge& edge : odometry.keyframeEdges()) {
        const KeyframeInfo& keyframe = keyframes.at(edge.keyframe_id);
        const Masks& at = masks.at(keyframe.timestamp);
        for (const Eigen::Vector3f& point : edge.points) {
            const Eigen::Vector2d pixel =
                simulator.camera().project(keyframe.T_world_camera.inverse() * point.cast<double>());
            const int u = static_cast<int>(std::lround(pixel.x())),
                      v = static_cast<int>(std::lround(pixel.y()));
            if (u < 0 || v < 0 || u >= at.objects.cols || v >= at.objects.rows) continue;
            if (at.shadow_border.at<std::uint8_t>(v, u) == 0) {
                others.add(edge.verdict);
            } else if (!onObjectBorder(at.objects, u, v)) {  // else it may be either
                shadows.add(edge.verdict);
            }
        }
    }
    RecordProperty("shadows_kept_out",
                   std::to_string(shadows.kept_out) + " of " + std::to_string(shadows.all));
    RecordProperty("others_pseudo", std::to_string(others.pseudo) + " of " + std::to_string(others.all));
    EXPECT_GT(keyframes.size(), 6U);
    ASSERT_GT(shadows.all, 300);
    EXPECT_GE(shadows.kept_out, 0.9 * shadows.all) << shadows.kept_out << " of " << shadows.all;
    EXPECT_LE(others.pseudo, 0.05 * others.all) << others.pseudo << " of " << others.all;
    EXPECT_GE(others.all - others.kept_out, 0.6 * others.all) << "most are used";
    // All rows of this camera are read at once; what moves in the scene must not teach otherwise
    EXPECT_LT(longest_readout, 0.004);
    RecordProperty("longest_readout_ms", std::to_string(1000 * longest_readout));
}

}  // namespace
}  // namespace roevo
