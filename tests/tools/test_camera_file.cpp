// What programs write into camera.txt, read back.
#include <gtest/gtest.h>

#include "programs/text.h"
#include "recordings/camera_file.h"
#include "support/run_program.h"

namespace roevo {
namespace {

TEST(CameraFile, HasALineForEachKeyAndTheNotesLast) {
    const PinholeCamera camera{
        640, 480, 520.9, 521, 325.1, 249.7, {0.2312, -0.7849, -0.0033, -0.0001, 0.9172}};
    EXPECT_EQ(cameraFileText(camera, 5000, {"note: made up", "frame: 3"}, plainNumber),
              "width: 640\nheight: 480\nfx: 520.9\nfy: 521\ncx: 325.1\ncy: 249.7\n"
              "distortion_k1_k2_p1_p2_k3: 0.2312 -0.7849 -0.0033 -0.0001 0.9172\n"
              "depth_scale: 5000   # PNG value / depth_scale = metres\nnote: made up\nframe: 3\n");
}

TEST(CameraFile, WritesNumbersAsItIsTold) {
    EXPECT_EQ(
        cameraFileText({320, 240, 262.5, 0.1, 3, 4, {}}, 1000, {}, allDigits),
        "width: 320\nheight: 240\nfx: 262.5\nfy: 0.10000000000000001\ncx: 3\ncy: 4\n"
        "distortion_k1_k2_p1_p2_k3: 0 0 0 0 0\ndepth_scale: 1000   # PNG value / depth_scale = metres\n");
}

TEST(CameraFile, ReadsBackTheSameNumbers) {
    const test::TemporaryFolder folder;
    const PinholeCamera camera{640, 480, 1e3 / 3, 500.1, 1e3 / 7, 240, {1e-7, -1.0 / 3, 0, 0.1, -0.25}};
    for (const auto number : {plainNumber, allDigits}) {
        test::writeFile(folder / "camera.txt", cameraFileText(camera, 1e4 / 3, {"note: x"}, number));
        const CameraDescription back = readCameraFile(folder / "camera.txt");
        EXPECT_TRUE(back.camera == camera);
        EXPECT_EQ(back.depth_scale, 1e4 / 3);
    }
}

TEST(CameraFile, WhatStandsThereTwiceIsRefused) {
    const test::TemporaryFolder folder;
    const std::string file = folder / "camera.txt",
                      text = cameraFileText({320, 240, 262.5, 262.5, 160, 120, {}}, 1000, {}, plainNumber);
    test::writeFile(file, text + "note: one\nnote: two\n");
    EXPECT_EQ(readCameraFile(file).camera.fx, 262.5) << "notes may";
    test::writeFile(file, text + "fx: 525\n");
    try {
        readCameraFile(file);
        FAIL() << "which one counts?";
    } catch (const std::runtime_error& error) {
        EXPECT_EQ(std::string(error.what()), file + ":9: fx stands here again, first in " + file + ":3");
    }
}

}  // namespace
}  // namespace roevo
