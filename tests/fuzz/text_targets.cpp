// Files that people and scripts write.
#include <cmath>
#include <map>
#include <memory>

#include "evaluation/evaluate.h"
#include "evaluation/trajectory_io.h"
#include "fuzz/promises.h"
#include "recordings/camera_file.h"
#include "recordings/dataset_reader.h"
#include "roevo_mrpt/config_file.h"
#include "tools/small_dataset.h"

namespace roevo::fuzz {
namespace {

using test::SmallDataset;
using test::TemporaryFolder;

const std::vector<std::string> kLayouts = {"tum", "icl", "eth3d", "7scenes", "plain"};

struct Layout {
    explicit Layout(const std::string& name) : dataset(name) {
        files = dataset.lists();
        files.push_back(name == "eth3d" ? "calibration.txt" : "camera.txt");
        files.push_back(name == "7scenes" ? SmallDataset::pose(0) : dataset.truthFile());
    }
    SmallDataset dataset;
    std::vector<std::string> files;  ///< those of text
};

Layout& layout(std::size_t number) {
    static std::map<std::size_t, std::unique_ptr<Layout>> made;
    auto& one = made[number];
    if (!one) one = std::make_unique<Layout>(kLayouts[number]);
    return *one;
}

/// A file with these bytes.
std::string fileOf(std::string_view bytes) {
    static const TemporaryFolder folder;
    test::writeFile(folder / "file.txt", std::string(bytes));
    return folder / "file.txt";
}

}  // namespace

/// The first byte says which layout, then the text of its files, each with a zero at its end; those that
/// remain are not there.
void runDatasetFolder(std::string_view bytes) {
    if (bytes.empty()) return;
    Layout& chosen = layout(static_cast<unsigned char>(bytes[0]) % kLayouts.size());
    bytes.remove_prefix(1);
    for (const std::string& file : chosen.files) {
        const std::size_t end = bytes.find('\0');
        if (end == std::string_view::npos) {
            chosen.dataset.remove(file);
            continue;
        }
        chosen.dataset.write(file, std::string(bytes.substr(0, end)));
        bytes.remove_prefix(end + 1);
    }
    accepted([&] {
        DatasetOptions options;
        options.tolerate_missing = true;
        const DatasetReader reader = openDataset(chosen.dataset.path(), options);
        (void)reader.summary();
        double last = -INFINITY;
        for (std::size_t i = 0; i < reader.size(); i++) {
            require(reader.entry(i).timestamp > last, "stamps do not go up");
            last = reader.entry(i).timestamp;
            if (i < 5) accepted([&] { (void)reader.readFrame(i); });
        }
        for (const StampedPose& pose : reader.groundTruth().poses) requireRigid(pose.T_world_camera);
    });
}

std::vector<std::string> datasetFolderSeeds() {
    std::vector<std::string> seeds;
    for (std::size_t i = 0; i < kLayouts.size(); i++) {
        std::string seed(1, static_cast<char>(i));
        const Layout fresh(kLayouts[i]);
        for (const std::string& file : fresh.files) seed += fresh.dataset.read(file) + '\0';
        seeds.push_back(seed);
    }
    return seeds;
}

void runCameraFile(std::string_view bytes) {
    accepted([&] {
        const CameraDescription camera = readCameraFile(fileOf(bytes));
        require(camera.camera.check().empty() && camera.depth_scale > 0, "an unusable camera is accepted");
    });
}

std::vector<std::string> cameraFileSeeds() {
    return {SmallDataset("tum").read("camera.txt"),
            "# a lens\nwidth: 640\nheight: 480\nfx: 517.3\nfy: 516.5\ncx: 318.6\ncy: 255.3\n"
            "distortion_k1_k2_p1_p2_k3: 0.2624 -0.9531 -0.0054 0.0026 1.1633\ndepth_scale: 5e3 # per m\n"
            "frame_rate: 30\nnote: of a desk\n"};
}

/// What is accepted says the same again when it is written and read.
void runOptions(std::string_view bytes) {
    OdometryOptions options;
    if (!accepted([&] { loadConfigText(std::string(bytes), "options", options); })) return;
    OdometryOptions again;
    const std::string text = toConfigText(options);
    loadConfigText(text, "what was written", again);
    require(toConfigText(again) == text, "options change when they are written and read");
}

std::vector<std::string> optionsSeeds() {
    return {"[edges]\nmin_length = 15 ; points\n[keyframe]\nmax_rotation_deg=10\n// more\nmode = tr\n",
            "# nothing\n", toConfigText(OdometryOptions())};
}

void runTrajectory(std::string_view bytes) {
    accepted([&] {
        const auto poses = readTrajectory(fileOf(bytes), {}, {{1, 1.1, 1.2, 1.3, 2.3}, "times"});
        for (const StampedPose& pose : poses) requireRigid(pose.T_world_camera);
        for (std::size_t i = 1; i < poses.size(); i++)
            require(poses[i].timestamp > poses[i - 1].timestamp, "stamps do not go up");
        const double error = evaluate(poses, poses).ate.translation.rmse;
        require(std::isfinite(error), "the error of a trajectory against itself is no number");
    });
}

std::vector<std::string> trajectorySeeds() {
    return {
        "# timestamp tx ty tz qx qy qz qw\n1.0 0 0 0 0 0 0 1\n1.1 0.1 0 0 0 0 0 1\n1.2 0.1 0.2 0 0 0 0 1\n"
        "1.3 0 0 0.5 0.5 0.5 0.5 0.5\n2.3 0 0 0.5 -0.5 0.5 -0.5 0.5\n",
        "1 0 0 0 0 1 0 0 0 0 1 0\n0 -1 0 1 1 0 0 0 0 0 1 0\n1e0 0 0 2 0 1 0 0 0 0 1 0\n1 0 0 0 0 1 0 3 0 0 1 "
        "0\n"
        "1 0 0 0 0 1 0 0 0 0 1 4\n",
        "#timestamp,x,y,z,qw,qx,qy,qz,vx\n1403636579758555392,4.6,-1.7,0.5,1,0,0,0,0\n"
        "1403636579763555584,4.7,-1.7,0.5,0.5,0.5,0.5,-0.5,0\n1403636579863555584,4.7,1,0.5,1,0,0,0,0\n"};
}

}  // namespace roevo::fuzz
