// What programs other than ours write about their images: calibrations, arrays, folders of phones and
// datasets.
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>
#include <memory>

#include "fuzz/promises.h"
#include "recordings/calibration_file.h"
#include "recordings/dataset_reader.h"
#include "roevo_mrpt/image_conversions.h"
#include "tools/folder_kinds.h"
#include "tools/small_dataset.h"

namespace roevo::fuzz {
namespace {

namespace fs = std::filesystem;
using test::TemporaryFolder;

/// A folder of every kind whose images are soon read.
struct Folder {
    explicit Folder(const test::FolderKind& kind) : format(kind.format) {
        static const test::SmallDataset small("tum");
        static const DatasetReader reader = openDataset(small.path());
        kind.write(reader, folder / "input");
        for (const auto& entry : fs::recursive_directory_iterator(folder / "input")) {
            const std::string ending = entry.path().extension().string();
            const bool text = ending == ".txt" || ending == ".csv" || ending == ".yaml" || ending == ".json";
            if (entry.is_regular_file() && text) files.push_back(entry.path());
        }
        std::sort(files.begin(), files.end());
    }
    TemporaryFolder folder;
    std::string format;
    std::vector<fs::path> files;  ///< those of text
};

std::vector<const test::FolderKind*> quickKinds() {
    std::vector<const test::FolderKind*> out;
    for (const test::FolderKind& kind : test::folderKinds())
        if (std::string(kind.name).find("lens") == std::string::npos) out.push_back(&kind);
    return out;
}

Folder& folderOf(std::size_t number) {
    static std::map<std::size_t, std::unique_ptr<Folder>> made;
    auto& one = made[number];
    if (!one) one = std::make_unique<Folder>(*quickKinds()[number]);
    return *one;
}

}  // namespace

void runCalibrationFile(std::string_view bytes) {
    static const TemporaryFolder folder;
    test::writeFile(folder / "camera.yaml", std::string(bytes));
    accepted([&] {
        auto camera = readCalibrationFile(folder / "camera.yaml");
        if (!camera) return;
        const PinholeCamera& c = camera->camera;
        require(std::isfinite(camera->depth_scale) && camera->depth_scale >= 0, "a depth scale is none");
        require((c.width == 0) == (c.height == 0), "half a size");
        require(asIfCentred(c).check().empty(), "an unusable camera is accepted");
    });
}

std::vector<std::string> calibrationFileSeeds() {
    return {
        "image_width: 640\nimage_height: 480\ncamera_matrix:\n  rows: 3\n  cols: 3\n  data: [525.5, 0, "
        "319.25, 0, "
        "526.5, 239.75, 0, 0, 1]\ndistortion_model: plumb_bob\ndistortion_coefficients:\n  data: [0.1, 0, 0, "
        "0, 0]\n",
        "%YAML:1.0\nCamera.type: \"KannalaBrandt8\"\nCamera.fx: 525.5\nCamera.fy: 526.5\nCamera.cx: 319.25\n"
        "Camera.cy: 239.75\nCamera.k1: 0.1\nDepthMapFactor: 5000.0\n",
        R"({"width": 640, "height": 480, "intrinsic_matrix": [525.5, 0, 0, 0, 526.5, 0, 319.25, 239.75, 1]})",
        R"({"color": {"w": 640, "h": 480, "fx": 525.5, "fy": 526.5, "ppx": 319.25, "ppy": 239.75, "coeffs": []}})",
        "&a {camera: *a, K: &b [*b, [1, 2]]}\n"};
}

void runArray(std::string_view bytes) {
    static const TemporaryFolder folder;
    test::writeFile(folder / "a.npy", "\x93NUMPY" + std::string(bytes));
    accepted([&] {
        const cv::Mat depth = readAnyDepthFile(folder / "a.npy");
        require(!depth.empty() && (depth.type() == CV_16UC1 || depth.type() == CV_32FC1),
                "an array is no depth");
    });
}

std::vector<std::string> arraySeeds() {
    std::vector<std::string> seeds;
    for (const char* type : {"'<u2'", "'<f4'", "'<f8'"}) {
        const std::string head =
            std::string("{'descr': ") + type + ", 'fortran_order': False, 'shape': (2, 3), }\n";
        seeds.push_back(std::string("\1\0", 2) + static_cast<char>(head.size()) + '\0' + head +
                        std::string(type[3] == '8'   ? 48
                                    : type[3] == '4' ? 24
                                                     : 12,
                                    '\1'));
    }
    return seeds;
}

/// The first byte says which kind, then the text of its files, each with a zero at its end; those that remain
/// are empty.
void runOtherFolder(std::string_view bytes) {
    if (bytes.empty()) return;
    Folder& chosen = folderOf(static_cast<unsigned char>(bytes[0]) % quickKinds().size());
    bytes.remove_prefix(1);
    for (const fs::path& file : chosen.files) {
        const std::size_t end = std::min(bytes.find('\0'), bytes.size());
        test::writeFile(file, std::string(bytes.substr(0, end)));
        bytes.remove_prefix(std::min(end + 1, bytes.size()));
    }
    accepted([&] {
        DatasetOptions options;
        options.tolerate_missing = true;
        options.folder.depth_scale = 5000;
        const DatasetReader reader = openDataset(chosen.folder / "input", options);
        (void)reader.summary();
        double last = -INFINITY;
        for (std::size_t i = 0; i < reader.size(); i++) {
            require(reader.entry(i).timestamp > last, "stamps do not go up");
            last = reader.entry(i).timestamp;
            if (i < 2) accepted([&] { (void)reader.readFrame(i); });
        }
        for (const StampedPose& pose : reader.groundTruth().poses) requireRigid(pose.T_world_camera);
    });
}

std::vector<std::string> otherFolderSeeds() {
    std::vector<std::string> seeds;
    const auto kinds = quickKinds();
    for (std::size_t i = 0; i < kinds.size(); i++) {
        std::string seed(1, static_cast<char>(i));
        const Folder fresh(*kinds[i]);
        for (const fs::path& file : fresh.files) seed += test::readFile(file) + '\0';
        seeds.push_back(seed);
    }
    return seeds;
}

}  // namespace roevo::fuzz
