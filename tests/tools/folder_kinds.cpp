#include "tools/folder_kinds.h"

#include <cmath>
#include <cstdlib>
#include <opencv2/core.hpp>

#include "programs/text.h"
#include "tools/folder_writer.h"

namespace roevo::test {
namespace {

namespace fs = std::filesystem;

/// Images that are named by number, and their camera by somebody else's file.
void numberedImages(const FolderWriter& out, const std::string& colour = "rgb/%05ld.png") {
    out.images([&](std::size_t i) { return format(colour.c_str(), out.number(i)); },
               [&](std::size_t i) { return format("depth/%05ld.png", out.number(i)); });
    out.copyTruth();
}

/// Lists of stamps that are written by `stamp`.
void lists(const FolderWriter& out, const std::string& head, const std::string& between,
           const std::function<std::string(double)>& stamp) {
    std::string colours = head, depths = head;
    for (std::size_t i = 0; i < out.size(); i++) {
        const std::string name = stampText(out.time(i)) + ".png";
        colours += stamp(out.time(i)) + between + "rgb/" + name + "\n";
        depths += stamp(out.time(i)) + between + "depth/" + name + "\n";
    }
    out.images([&](std::size_t i) { return "rgb/" + stampText(out.time(i)) + ".png"; },
               [&](std::size_t i) { return "depth/" + stampText(out.time(i)) + ".png"; });
    out.text("rgb.txt", colours);
    out.text("depth.txt", depths);
    out.cameraFile();
    out.copyTruth();
}

std::string microseconds(double time) {
    return std::to_string(std::llround(1e6 * time));
}

/// Depth images in files of another kind, with `value` of a depth in units.
void depthFiles(const FolderWriter& out, const char* pattern,
                const std::function<cv::Mat(std::size_t)>& image, const std::string& scale) {
    for (std::size_t i = 0; i < out.size(); i++) {
        out.image(format("rgb/%05ld.png", out.number(i)), out.colour(i));
        out.image(format(pattern, out.number(i)), image(i));
    }
    out.copyTruth();
    out.text("camera.txt",
             format("width: %d\nheight: %d\nfx: %.17g\nfy: %.17g\ncx: %.17g\ncy: %.17g\n", out.camera()) +
                 "frame_rate: 30\ndepth_scale: " + scale + "\n");
}

/// numbered images with a camera in a file of somebody else.
FolderKind withCamera(const char* name, const char* file, const char* pattern, Arguments more) {
    return {name, "plain",
            [=](const DatasetReader& from, const fs::path& to) {
                const FolderWriter out(from, to);
                numberedImages(out);
                out.text(file, format(pattern, out.camera()));
                return more;
            },
            FolderKind::kSame};
}

/// Colour, depth in mm, and the camera in Open3D's JSON with what `more` adds to it.
Arguments writeOpen3d(const DatasetReader& from, const fs::path& to, const std::string& colour,
                      const char* camera, const std::string& more) {
    const FolderWriter out(from, to);
    for (std::size_t i = 0; i < out.size(); i++) {
        out.image(format("color/%05ld.", out.number(i)) + colour, out.colour(i));
        out.image(format("depth/%05ld.png", out.number(i)), out.millimetres(i));
    }
    out.text(camera, format("{\"width\": %d, \"height\": %d, \"intrinsic_matrix\": [%.17g, 0, 0, 0, %.17g, "
                            "0, %.17g, %.17g, 1]",
                            out.camera()) +
                         more + "}");
    out.copyTruth();
    return {};
}

}  // namespace

const std::vector<FolderKind>& folderKinds() {
    static const std::vector<FolderKind> kinds = {
        {"times in names, depth 4 ms later", "plain",
         [](const DatasetReader& from, const fs::path& to) {
             const FolderWriter out(from, to);
             out.images([&](std::size_t i) { return "rgb/" + stampText(out.time(i)) + ".png"; },
                        [&](std::size_t i) { return "depth/" + stampText(out.time(i) + 0.004) + ".png"; });
             out.cameraFile();
             out.copyTruth();
             return Arguments{};
         },
         FolderKind::kSame},
        {"rgb/rgb_00030.png, depth/depth_00030.png", "plain",
         [](const DatasetReader& from, const fs::path& to) {
             const FolderWriter out(from, to);
             out.images([&](std::size_t i) { return format("rgb/rgb_%05ld.png", out.number(i)); },
                        [&](std::size_t i) { return format("depth/depth_%05ld.png", out.number(i)); });
             out.cameraFile();
             out.copyTruth();
             return Arguments{};
         },
         FolderKind::kSame},
        {"rgb_00030.png and depth_00030.png side by side", "plain",
         [](const DatasetReader& from, const fs::path& to) {
             const FolderWriter out(from, to);
             out.images([&](std::size_t i) { return format("rgb_%05ld.png", out.number(i)); },
                        [&](std::size_t i) { return format("depth_%05ld.png", out.number(i)); });
             out.cameraFile();
             out.copyTruth();
             return Arguments{};
         },
         FolderKind::kSame},
        {"walk_Color_1033.333.png (ms), as rs-convert names them", "plain",
         [](const DatasetReader& from, const fs::path& to) {
             const FolderWriter out(from, to);
             out.images([&](std::size_t i) { return format("walk_Color_%.14f.png", 1000 * out.time(i)); },
                        [&](std::size_t i) { return format("walk_Depth_%.14f.png", 1000 * out.time(i)); });
             out.cameraFile();
             out.copyTruth();
             return Arguments{};
         },
         FolderKind::kSame},
        {"lists as CSV with a head", "tum",
         [](const DatasetReader& from, const fs::path& to) {
             lists(FolderWriter(from, to), "timestamp,filename\n", ",", &stampText);
             return Arguments{};
         },
         FolderKind::kSame},
        {"lists with a head without #", "tum",
         [](const DatasetReader& from, const fs::path& to) {
             lists(FolderWriter(from, to), "timestamp filename\n", " ", &stampText);
             return Arguments{};
         },
         FolderKind::kSame},
        {"lists in us", "tum",
         [](const DatasetReader& from, const fs::path& to) {
             lists(FolderWriter(from, to), "", " ", &microseconds);
             return Arguments{};
         },
         FolderKind::kSame},
        {"lists in ns", "tum",
         [](const DatasetReader& from, const fs::path& to) {
             lists(FolderWriter(from, to), "", " ", [](double time) { return microseconds(time) + "000"; });
             return Arguments{};
         },
         FolderKind::kSame},
        {"--associations", "tum",
         [](const DatasetReader& from, const fs::path& to) {
             const FolderWriter out(from, to);
             std::string pairs;
             for (std::size_t i = 0; i < out.size(); i++) {
                 const std::string name = "a" + std::to_string(i) + ".png", stamp = stampText(out.time(i));
                 pairs += stamp + " left/" + name + " " + stamp + " range/" + name + "\n";
             }
             out.images([](std::size_t i) { return "left/a" + std::to_string(i) + ".png"; },
                        [](std::size_t i) { return "range/a" + std::to_string(i) + ".png"; });
             out.text("pairs.txt", pairs);
             out.cameraFile();
             out.copyTruth();
             return Arguments{"--associations", "pairs.txt"};
         },
         FolderKind::kSame},
        withCamera(
            "camera_info of ROS (.yaml)", "camera_info.yaml",
            "image_width: %1$d\nimage_height: %2$d\ncamera_name: a\ncamera_matrix:\n  rows: 3\n  cols: 3\n"
            "  data: [%3$.17g, 0, %5$.17g, 0, %4$.17g, %6$.17g, 0, 0, 1]\ndistortion_model: plumb_bob\n"
            "distortion_coefficients:\n  rows: 1\n  cols: 5\n  data: [0, 0, 0, 0, 0]\n",
            {"--depth-scale", "5000"}),
        withCamera(
            "ORB-SLAM's .yaml", "TUM1.yaml",
            "%%YAML:1.0\n\n#----\n# Camera Parameters\n#----\nCamera.type: \"PinHole\"\nCamera.width: %d\n"
            "Camera.height: %d\nCamera.fx: %.17g\nCamera.fy: %.17g\nCamera.cx: %.17g\nCamera.cy: %.17g\n"
            "Camera.k1: 0.0\nCamera.k2: 0.0\nCamera.p1: 0.0\nCamera.p2: 0.0\nCamera.fps: 30.0\n"
            "DepthMapFactor: 5000.0\n",
            {}),
        withCamera(
            "Open3D's camera_intrinsic.json", "camera_intrinsic.json",
            "{\n\t\"width\" : %d,\n\t\"height\" : %d,\n\t\"intrinsic_matrix\" : [ %.17g, 0, 0, 0, %.17g, 0, "
            "%.17g, %.17g, 1 ]\n}\n",
            {"--depth-scale", "5000"}),
        withCamera(
            "RealSense's intrinsics as .json", "intrinsics.json",
            "{\"color\": {\"width\": %d, \"height\": %d, \"fx\": %.17g, \"fy\": %.17g, \"ppx\": %.17g, "
            "\"ppy\": "
            "%.17g, \"model\": \"Inverse Brown Conrady\", \"coeffs\": [0, 0, 0, 0, 0]}, \"depth_scale\": "
            "0.0002}\n",
            {}),
        {"--intrinsics and --depth-scale", "plain",
         [](const DatasetReader& from, const fs::path& to) {
             const FolderWriter out(from, to);
             numberedImages(out, "images/%05ld.png");
             const PinholeCamera& c = out.camera();
             return Arguments{"--intrinsics",  allDigits(c.fx), allDigits(c.fy),
                              allDigits(c.cx), allDigits(c.cy), "--depth-scale",
                              "5000",          "--frame-rate",  "30"};
         },
         FolderKind::kSame},
        {"depth as TIFF of floats (m)", "plain",
         [](const DatasetReader& from, const fs::path& to) {
             const FolderWriter out(from, to);
             depthFiles(
                 out, "depth/%05ld.tiff", [&](std::size_t i) { return out.metres(i); }, "1");
             return Arguments{};
         },
         FolderKind::kSame},
        {"depth as TIFF of 16 bits", "plain",
         [](const DatasetReader& from, const fs::path& to) {
             const FolderWriter out(from, to);
             depthFiles(
                 out, "depth/%05ld.tif", [&](std::size_t i) { return out.depth(i); }, "5000");
             return Arguments{};
         },
         FolderKind::kSame},
        {"depth as EXR (m)", "plain",
         [](const DatasetReader& from, const fs::path& to) {
             setenv("OPENCV_IO_ENABLE_OPENEXR", "1", 0);
             const FolderWriter out(from, to);
             depthFiles(
                 out, "depth/%05ld.exr", [&](std::size_t i) { return out.metres(i); }, "1");
             return Arguments{};
         },
         FolderKind::kSame},
        {"depth as NPY of float32 (m)", "plain",
         [](const DatasetReader& from, const fs::path& to) { return writeArrays(from, to, CV_32F, "<f4"); },
         FolderKind::kSame},
        {"depth as NPY of float64 (m)", "plain",
         [](const DatasetReader& from, const fs::path& to) { return writeArrays(from, to, CV_64F, "<f8"); },
         FolderKind::kSame},
        {"depth as NPY of uint16", "plain",
         [](const DatasetReader& from, const fs::path& to) { return writeArrays(from, to, CV_16U, "<u2"); },
         FolderKind::kSame},
        {"Open3D: color/, depth/ in mm, camera_intrinsic.json", "plain",
         [](const DatasetReader& from, const fs::path& to) {
             return writeOpen3d(from, to, "png", "camera_intrinsic.json", "");
         },
         FolderKind::kOtherDepth},
        {"Azure Kinect, as Open3D's reader of .mkv writes it: JPEG, depth in mm, intrinsic.json", "plain",
         [](const DatasetReader& from, const fs::path& to) {
             return writeOpen3d(from, to, "jpg", "intrinsic.json",
                                ", \"color_mode\": \"MJPG_720P\", \"depth_mode\": \"NFOV_UNBINNED\", "
                                "\"serial_number_\": \"000123\", \"stream_length_usec\": 3000000");
         },
         FolderKind::kOther},
        {"depth camera of half the size in camera.txt", "plain",
         [](const DatasetReader& from, const fs::path& to) {
             const FolderWriter out(from, to);
             for (std::size_t i = 0; i < out.size(); i++) {
                 out.image(format("rgb/%05ld.png", out.number(i)), out.colour(i));
                 out.image(format("depth/%05ld.png", out.number(i)), halved(out.depth(i)));
             }
             PinholeCamera depth = out.camera();
             depth.width /= 2, depth.height /= 2;
             for (double* value : {&depth.fx, &depth.fy, &depth.cx, &depth.cy}) *value /= 2;
             out.cameraFile("frame_rate: 30\ndepth_to_colour: 0 0 0 0 0 0 1\n" +
                            format("depth_width: %d\ndepth_height: %d\ndepth_fx: %.17g\ndepth_fy: %.17g\n"
                                   "depth_cx: %.17g\ndepth_cy: %.17g\n",
                                   depth));
             out.copyTruth();
             return Arguments{};
         },
         FolderKind::kOtherDepth},
        {"ScanNet: JPEG, depth of half the size in mm", "scannet", &writeScanNet, FolderKind::kOther},
        {"Stray Scanner: depth of half the size in mm", "stray", &writeStray, FolderKind::kOtherDepth},
        {"Record3D: depth of half the size as EXR", "record3d", &writeRecord3d, FolderKind::kOtherDepth},
        {"lens of Azure Kinect (rational, 8 terms)", "plain",
         [](const DatasetReader& from, const fs::path& to) {
             return writeThroughLens(
                 from, to,
                 {0, 0, 0, 0, 0, 0, {0.5163, -2.6274, 6e-4, -2e-4, 1.5198}, {0.3963, -2.45, 1.447}});
         },
         FolderKind::kOther},
        {"fish-eye lens (Kannala-Brandt)", "plain",
         [](const DatasetReader& from, const fs::path& to) {
             return writeThroughLens(
                 from, to,
                 {0, 0, 0, 0, 0, 0, {-0.0091, 0.0474, -0.046, 0.0092, 0}, {}, LensModel::kKannalaBrandt});
         },
         FolderKind::kOther}};
    return kinds;
}

}  // namespace roevo::test
