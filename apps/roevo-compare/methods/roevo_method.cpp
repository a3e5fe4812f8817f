#include <filesystem>
#include <nlohmann/json.hpp>
#include <utility>

#include "evaluation/trajectory_io.h"
#include "families.h"
#include "odometry_frame.h"
#include "programs/atomic_file.h"
#include "roevo/odometry.h"
#include "roevo_mrpt/scene_builder.h"

namespace roevo {
namespace {

OdometryOptions inMode(Mode mode, OdometryOptions options) {
    options.mode = mode;
    return options;
}

class RoevoMethod : public Method {
  public:
    /// @param options  but for the mode
    RoevoMethod(const PinholeCamera& camera, const OdometryOptions& options, Mode mode)
        : odometry_(camera, inMode(mode, options)) {}

    std::vector<std::string> stages() const override {
        std::vector<std::string> names{"edges", "coarse"};
        if (mode() != Mode::kCoarse) names.push_back("fine");
        if (mode() == Mode::kBundleAdjustment) names.push_back("waiting");
        return names;
    }

    MethodFrame processFrame(const RgbdFrame& frame) override {
        const FrameResult result = odometry_.processFrame(frame);
        MethodFrame out = toMethodFrame(result, started_);
        out.stage_ms = {result.ms.edges, result.ms.coarse};
        if (mode() != Mode::kCoarse) out.stage_ms.push_back(result.ms.fine);
        if (mode() == Mode::kBundleAdjustment) out.stage_ms.push_back(result.ms.waiting);
        if (result.ms.mapping > 0) {
            mapping_ms_ += result.ms.mapping;
            ++mapped_;
        }
        return out;
    }
    void refused(const RgbdFrame& frame) override { (void)odometry_.processFrame(frame); }

    std::optional<std::vector<StampedPose>> finalTrajectory() override {
        odometry_.refineAll();
        return odometry_.trajectory();
    }

    std::optional<Background> background() const override {
        if (mode() != Mode::kBundleAdjustment) return std::nullopt;
        // Not of a keyframe: after a frame that was left out two of them may come in at once
        return Background{"mapping, by frame with which a map took effect",
                          mapped_ > 0 ? mapping_ms_ / static_cast<double>(mapped_) : 0, mapped_};
    }

    bool writeScene(const std::string& path) override {
        SceneContent content;
        content.map = odometry_.map();
        if (mode() == Mode::kBundleAdjustment) content.keyframe_edges = odometry_.keyframeEdges();
        content.semi_dense = odometry_.semiDense();
        content.trajectory = odometry_.trajectory();
        content.keyframes = odometry_.keyframes();
        content.camera = odometry_.camera().undistorted();
        saveScene(path, *buildScene(content));

        const std::filesystem::path folder = std::filesystem::path(path).parent_path();
        savePly(folder / "map.ply", content.map);
        savePointsPly(folder / "map_semi_dense.ply", content.semi_dense);
        std::vector<StampedPose> keyframes;
        for (const KeyframeInfo& k : content.keyframes) keyframes.push_back({k.timestamp, k.T_world_camera});
        writeTumTrajectory(folder / "keyframes.txt", keyframes);
        const PinholeCamera& c = content.camera;
        writeTextAtomically(folder / "summary.json", nlohmann::ordered_json{{"mode", toString(mode())},
                                                                            {"camera",
                                                                             {{"width", c.width},
                                                                              {"height", c.height},
                                                                              {"fx", c.fx},
                                                                              {"fy", c.fy},
                                                                              {"cx", c.cx},
                                                                              {"cy", c.cy}}}}
                                                             .dump(2) +
                                                         "\n");
        return true;
    }

  private:
    Mode mode() const { return odometry_.options().mode; }

    Odometry odometry_;
    bool started_ = false;
    double mapping_ms_ = 0;
    std::size_t mapped_ = 0;  // frames with which one map or more took effect
};

}  // namespace

std::vector<MethodInfo> roevoMethods() {
    MethodInfo ct, tr, ba;
    ct.name = "roevo-ct";
    ct.label = "ROEVO CT";
    ct.note = "coarse tracking only: photometric, on a sample of the edge points";
    tr.name = "roevo-tr";
    tr.label = "ROEVO TR";
    tr.note = "coarse and fine tracking against the last keyframe, no map";
    ba.name = "roevo-ba";
    ba.label = "ROEVO TR+BA";
    ba.note =
        "tracking with local mapping in a second thread, which shares the one core; its trajectory is the "
        "refined one, as known at the end";
    ct.mode = Mode::kCoarse;
    tr.mode = Mode::kTracking;
    ba.mode = Mode::kBundleAdjustment;
    for (MethodInfo* info : {&ct, &tr, &ba}) info->make = makerOf<RoevoMethod>(*info->mode);
    return {ct, tr, ba};
}

}  // namespace roevo
