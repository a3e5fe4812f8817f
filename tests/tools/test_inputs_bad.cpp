// Folders as people have them, damaged, foreign and contradictory: one line that says where and what to do.
#include <gtest/gtest.h>

#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>

#include "mrpt/test_helpers.h"
#include "recordings/dataset_reader.h"
#include "roevo_mrpt/image_conversions.h"
#include "tools/folder_kinds.h"
#include "tools/small_dataset.h"

namespace roevo {
namespace {

namespace fs = std::filesystem;
using namespace test;

std::string openError(const std::string& folder, const FolderChoice& choice = {}) {
    DatasetOptions options;
    options.folder = choice;
    const std::string error = errorOf([&] { openDataset(folder, options); });
    EXPECT_EQ(error.find('\n'), std::string::npos) << error;
    return error;
}

std::string summary(const std::string& folder, const FolderChoice& choice = {}) {
    DatasetOptions options;
    options.folder = choice;
    return openDataset(folder, options).summary();
}

const std::string kYaml =
    "Camera.fx: 60\nCamera.fy: 61\nCamera.cx: 31.5\nCamera.cy: 23.5\nDepthMapFactor: 5000\n";

TEST(BadInputs, TwoIntrinsicsThatDiffer) {
    const SmallDataset folder("plain");
    folder.remove("camera.txt");
    folder.write("a.yaml", kYaml);
    folder.write("b.json",
                 R"({"width": 64, "height": 48, "intrinsic_matrix": [60, 0, 0, 0, 61, 0, 31.5, 23.5, 1]})");
    EXPECT_CONTAINS(summary(folder.path()), "camera 64x48 fx 60 fy 61") << "they agree";
    folder.write("b.json",
                 R"({"width": 64, "height": 48, "intrinsic_matrix": [70, 0, 0, 0, 61, 0, 31.5, 23.5, 1]})");
    EXPECT_CONTAINS(openError(folder.path()), "two intrinsics that differ: a.yaml (");
    EXPECT_CONTAINS(openError(folder.path()), "fx 60 fy 61");
    EXPECT_CONTAINS(openError(folder.path()), "fx 70 fy 61");
    FolderChoice choice;
    choice.intrinsics = {60, 61, 31.5, 23.5};
    choice.depth_scale = 5000;
    EXPECT_CONTAINS(summary(folder.path(), choice), "from the command line") << "which ends the doubt";
    folder.writeCamera("5000");
    EXPECT_CONTAINS(summary(folder.path()), "b.json says 64x48 fx 70");
    folder.remove("camera.txt");
    folder.write("b.json", R"({"fx": 60, "fy": 61, "cx": 31.5, "cy": 23.5, "depth_scale": 0.001})");
    EXPECT_CONTAINS(openError(folder.path()), "with other depth scales");
}

TEST(BadInputs, ADepthScaleThatNobodyTells) {
    const SmallDataset lists("tum");
    lists.remove("camera.txt");
    lists.write("camera.yaml", kYaml.substr(0, kYaml.find("Depth")));
    EXPECT_CONTAINS(openError(lists.path()), "give --depth-scale");
    EXPECT_CONTAINS(openError(lists.path()), "depth_scale 5000 would give 2 m");
    FolderChoice choice;
    choice.depth_scale = 5000;
    EXPECT_CONTAINS(summary(lists.path(), choice), "median depth 2 m");
    choice.depth_scale = 50;
    EXPECT_CONTAINS(openError(lists.path(), choice), "depth_scale 5000 would give 2 m");
    const SmallDataset pair("plain");
    pair.remove("camera.txt");
    pair.write("camera.yaml", kYaml.substr(0, kYaml.find("Depth")));
    EXPECT_CONTAINS(summary(pair.path()), "depth is taken as mm");
    EXPECT_CONTAINS(summary(pair.path()), "median depth 10 m") << "and what comes of it is seen";
}

TEST(BadInputs, StampsThatDoNotOverlap) {
    const SmallDataset folder("plain");
    for (int i = 0; i < 3; i++)
        fs::rename(folder / folder.depth(i), folder / ("depth/" + std::to_string(50 + i) + ".5.png"));
    EXPECT_CONTAINS(openError(folder.path()), "no colour image has a depth image within 0.02 s");
    EXPECT_CONTAINS(openError(folder.path()), "3 colour, 3 depth images");
    const SmallDataset truth("plain");
    truth.write("groundtruth.txt", "9000 0 0 0 0 0 0 1\n9001 0 0 0 0 0 0 1\n");
    EXPECT_CONTAINS(summary(truth.path()), "warning: the ground truth is of another time: images from 3.333");
}

TEST(BadInputs, ClocksInOtherUnits) {
    const SmallDataset folder("plain", 3);
    std::string truth;
    for (int i = 0; i < 3; i++)
        truth += std::to_string(std::llround(1e9 * SmallDataset::time(i))) + " 0 0 " + std::to_string(i) +
                 " 0 0 0 1\n";
    folder.write("groundtruth.txt", truth);
    const DatasetReader nanoseconds = openDataset(folder.path());
    EXPECT_CONTAINS(nanoseconds.summary(), "times of the ground truth are in ns");
    EXPECT_EQ(nanoseconds.groundTruth().poses[1].timestamp, SmallDataset::time(1));
    EXPECT_FALSE(nanoseconds.groundTruth().copyable);
    // 200 Hz in ms look like frames in seconds, but for the ground truth
    const SmallDataset fast("tum", 3);
    std::string list, poses;
    for (int i = 0; i < 3; i++) {
        list += std::to_string(1000 + 5 * i) + " " + fast.colour(i) + "\n";
        poses += std::to_string(1 + 0.005 * i) + " 0 0 0 0 0 0 1\n";
        fast.write("depth.txt", list);
    }
    fast.write("rgb.txt", list);
    std::string depth = list;
    for (std::size_t at = 0; (at = depth.find("rgb/", at)) != std::string::npos;)
        depth.replace(at, 3, "depth");
    fast.write("depth.txt", depth);
    fast.write("groundtruth.txt", poses);
    const DatasetReader milliseconds = openDataset(fast.path());
    EXPECT_CONTAINS(milliseconds.summary(), "times of the images are in ms, as the ground truth tells");
    EXPECT_CONTAINS(milliseconds.summary(), "200.0 Hz");
    EXPECT_EQ(milliseconds.entry(2).timestamp, 1.01);
    EXPECT_EQ(milliseconds.entry(2).depth_timestamp, 1.01);
}

TEST(BadInputs, CommandLinesThatContradictThemselves) {
    const SmallDataset folder("plain");
    const auto usage = [&](const std::vector<std::string>& more, const std::string& words) {
        for (const char* program : {"roevo-odometry", "rgbd2rawlog"}) {
            std::vector<std::string> arguments{"--input", folder.path(), "--output",
                                               folder.parent() / "o.rawlog"};
            arguments.insert(arguments.end(), more.begin(), more.end());
            const auto result = runProgram(program, arguments);
            EXPECT_EQ(result.exit_code, 2) << result.all();
            EXPECT_CONTAINS(result.err, words);
        }
        EXPECT_EQ(countEntries(folder.parent().path()), 1) << "only the dataset";
    };
    usage({"--intrinsics", "60", "61", "31.5", "23.5"}, "--intrinsics needs --depth-scale");
    usage({"--distortion", "0.1", "-0.2", "0", "0"}, "--distortion needs --intrinsics");
    usage({"--intrinsics", "60,61,31.5,23.5", "--depth-scale", "5000", "--distortion", "1,2,3,4,5,6"},
          "--distortion: 4, 5 or 8 numbers");
    usage({"--intrinsics", "60,61,31.5,23.5", "--depth-scale", "5000", "--distortion", "1,2,3,4", "--fisheye",
           "1,2,3,4"},
          "one lens at a time");
    usage({"--intrinsics", "60", "61"}, "--intrinsics");
    usage({"--depth-scale", "0"}, "--depth-scale");
    usage({"--frame-rate", "10"}, "--frame-rate is for images that are numbered, and those of ");
}

TEST(BadInputs, AFrameRateThatIsNotUsed) {
    FolderChoice choice;
    choice.frame_rate = 10;
    for (const char* layout : {"tum", "eth3d", "plain"})
        EXPECT_CONTAINS(openError(SmallDataset(layout).path(), choice), " have times");
    const SmallDataset icl("icl"), scenes("7scenes");
    EXPECT_CONTAINS(openError(icl.path(), choice), " have 30 Hz by their layout, icl");
    EXPECT_CONTAINS(openError(scenes.path(), choice), " have 30 Hz by their layout, 7scenes");
    choice.frame_rate = 30;
    EXPECT_EQ(openError(icl.path(), choice), "") << "as it is anyway";
}

TEST(BadInputs, IntrinsicsThatAreNone) {
    const SmallDataset folder("plain");
    FolderChoice choice;
    choice.depth_scale = 5000;
    choice.intrinsics = {60, 61, 900, 23.5};
    EXPECT_CONTAINS(openError(folder.path(), choice),
                    "the command line: camera: principal point (900, 23.5)");
    choice.intrinsics = {0, 61, 31, 23.5};
    EXPECT_CONTAINS(openError(folder.path(), choice), "fx = 0");
    choice = {};
    choice.associations = "none.txt";
    EXPECT_CONTAINS(openError(folder.path(), choice), "none.txt: No such file");
    folder.write("pairs.txt", "1 rgb/a.png\n");
    choice.associations = "pairs.txt";
    EXPECT_CONTAINS(openError(folder.path(), choice),
                    "pairs.txt:1: expected 'timestamp image timestamp depth_image'");
}

TEST(BadInputs, ChoicesWithTooFewNumbersOrNone) {
    const SmallDataset folder("plain");
    const auto error = [&](void (*change)(FolderChoice&)) {
        FolderChoice choice;
        choice.intrinsics = {60, 61, 31.5, 23.5};
        choice.depth_scale = 5000;
        change(choice);
        return openError(folder.path(), choice);
    };
    EXPECT_EQ(error([](FolderChoice&) {}), "");
    EXPECT_CONTAINS(error([](FolderChoice& c) { c.intrinsics.resize(2); }),
                    "--intrinsics: 4 numbers (fx fy cx cy), not 2");
    EXPECT_CONTAINS(error([](FolderChoice& c) { c.intrinsics.push_back(1); }), "--intrinsics: 4 numbers");
    EXPECT_CONTAINS(error([](FolderChoice& c) { c.fisheye = {0.1}; }),
                    "--fisheye: 4 numbers (k1 k2 k3 k4), not 1");
    EXPECT_CONTAINS(error([](FolderChoice& c) { c.intrinsics.clear(), c.depth_scale = -1; }),
                    "--depth-scale: a number above 0, not -1");
    EXPECT_CONTAINS(error([](FolderChoice& c) { c.intrinsics.clear(), c.depth_scale = NAN; }),
                    "--depth-scale: a number above 0, not nan");
    EXPECT_CONTAINS(error([](FolderChoice& c) { c.depth_scale = INFINITY; }), "--depth-scale");
    EXPECT_CONTAINS(error([](FolderChoice& c) { c.frame_rate = -30; }),
                    "--frame-rate: a number above 0, not -30");
}

TEST(BadInputs, DepthThatIsHalfThere) {
    const TemporaryFolder folder;
    setenv("OPENCV_IO_ENABLE_OPENEXR", "1", 0);
    cv::Mat depth(48, 64, CV_32FC1);
    cv::randu(depth, 1, 3);
    for (const char* name : {"a.tiff", "a.exr"}) {
        const std::string file = folder / name;
        cv::imwrite(file, depth);
        EXPECT_EQ(cv::norm(readAnyDepthFile(file), depth, cv::NORM_INF), 0) << name;
        fs::resize_file(file, fs::file_size(file) / 2);
        EXPECT_CONTAINS(errorOf([&] { readAnyDepthFile(file); }), file);
    }
    cv::imwrite(folder / "colour.tiff", cv::Mat(48, 64, CV_8UC3, cv::Scalar(1, 2, 3)));
    EXPECT_CONTAINS(errorOf([&] { readAnyDepthFile(folder / "colour.tiff"); }), "8 bits and 3 channel(s)");
    EXPECT_CONTAINS(errorOf([&] { readDepthFile(folder / "a.tiff"); }), "a.tiff")
        << "bags and rawlogs have 16 bits";
}

std::string npy(const std::string& head, std::size_t bytes) {
    return std::string("\x93NUMPY\x01\x00", 8) + static_cast<char>(head.size()) + '\0' + head +
           std::string(bytes, '\1');
}

TEST(BadInputs, ArraysThatAreNoDepth) {
    const TemporaryFolder folder;
    const auto error = [&](const std::string& bytes) {
        writeFile(folder / "a.npy", bytes);
        const std::string text = errorOf([&] { readAnyDepthFile(folder / "a.npy"); });
        EXPECT_TRUE(text.empty() || text.find("a.npy") != std::string::npos) << text;
        return text;
    };
    const std::string good = "{'descr': '<u2', 'fortran_order': False, 'shape': (2, 3), }";
    EXPECT_EQ(error(npy(good, 12)), "");
    EXPECT_EQ(error(npy("{'shape': (2, 3, 1), 'fortran_order': False, 'descr': '<f4'}", 24)), "");
    EXPECT_CONTAINS(error(npy(good, 11)), "truncated array: 11 of 12 bytes");
    EXPECT_CONTAINS(error(npy(good, 13)), "13 of 12 bytes");
    EXPECT_CONTAINS(error(npy(good, 12).substr(0, 30)), "truncated array");
    EXPECT_CONTAINS(error(npy("{'descr': '<c8', 'fortran_order': False, 'shape': (2, 3), }", 12)),
                    "an array of '<c8'");
    EXPECT_CONTAINS(error(npy("{'descr': '<u2', 'fortran_order': True, 'shape': (2, 3), }", 12)),
                    "ascontiguousarray");
    for (const char* shape :
         {"(6,)", "(2, 3, 3)", "(-2, 3)", "(99999, 99999)", "(2, 3", "()", "(2, 3, 1, 1)"})
        EXPECT_CONTAINS(
            error(npy("{'descr': '<u2', 'fortran_order': False, 'shape': " + std::string(shape) + "}", 12)),
            "shape");
}

TEST(BadInputs, FloatsThatAreNoDepth) {
    const SmallDataset folder("plain");
    folder.writeCamera("1");
    for (int i = 0; i < 3; i++) {
        cv::Mat depth(48, 64, CV_32FC1, cv::Scalar(2));
        depth.at<float>(0, 0) = NAN, depth.at<float>(0, 1) = INFINITY, depth.at<float>(0, 2) = -1;
        depth.at<float>(0, 3) = 20;
        fs::remove(folder / folder.depth(i));
        cv::imwrite(fs::path(folder / folder.depth(i)).replace_extension(".tiff").string(), depth);
    }
    const DatasetReader reader = openDataset(folder.path());
    const cv::Mat depth = reader.readFrame(0).depth;
    for (int u = 0; u < 4; u++) EXPECT_EQ(depth.at<float>(0, u), 0) << u;
    EXPECT_FLOAT_EQ(depth.at<float>(0, 4), 2);
    EXPECT_CONTAINS(reader.warning(), "1 depth values beyond 13.107 m");
    (void)reader.readFrame(0);
    EXPECT_CONTAINS(reader.warning(), "1 depth values") << "counted once";
    folder.writeCamera("5000");
    EXPECT_CONTAINS(openError(folder.path()), "depth_scale 1 would give 2 m");
    folder.writeCamera("1");
    cv::imwrite(folder / folder.depth(1), cv::Mat(48, 64, CV_16UC1, cv::Scalar(10000)));
    fs::remove(fs::path(folder / folder.depth(1)).replace_extension(".tiff"));
    EXPECT_CONTAINS(errorOf([&] { openDataset(folder.path()).readFrame(1); }),
                    "is of 16 bits, others hold floats");
}

/// Every text file of a kind of folder, cut in the middle or with something else in it.
class DamagedFolders : public testing::TestWithParam<int> {};
INSTANTIATE_TEST_SUITE_P(Kinds, DamagedFolders, testing::Range(0, static_cast<int>(folderKinds().size())));

TEST_P(DamagedFolders, AreOneLineOrAreRead) {
    const auto& kind = folderKinds()[static_cast<std::size_t>(GetParam())];
    const SmallDataset source("tum", 3);
    const TemporaryFolder folder;
    const DatasetReader reader = openDataset(source.path());
    if (std::string(kind.name).find("lens") != std::string::npos) return;
    kind.write(reader, folder / "input");
    for (const auto& entry : fs::recursive_directory_iterator(folder / "input")) {
        const std::string ending = entry.path().extension().string();
        if (!entry.is_regular_file() || ending == ".png" || ending == ".jpg") continue;
        const std::string whole = readFile(entry.path());
        for (const std::string& text :
             {whole.substr(0, whole.size() / 2), std::string("nonsense\n"), std::string()}) {
            std::ofstream(entry.path(), std::ios::binary) << text;
            DatasetOptions options;
            options.folder.depth_scale = 5000;
            const std::string error = errorOf([&] {
                const DatasetReader damaged = openDataset(folder / "input", options);
                for (std::size_t i = 0; i < damaged.size(); i++) (void)errorOf([&] { damaged.readFrame(i); });
            });
            EXPECT_EQ(error.find('\n'), std::string::npos) << error;
            EXPECT_TRUE(error.empty() || error.find("input") != std::string::npos) << error;
        }
        std::ofstream(entry.path(), std::ios::binary) << whole;
    }
}

}  // namespace
}  // namespace roevo
