// Cameras in the files of other programs.
#include <gtest/gtest.h>

#include "mrpt/test_helpers.h"
#include "recordings/calibration_file.h"
#include "recordings/camera_file.h"
#include "recordings/lens.h"
#include "support/run_program.h"
#include "tools/small_dataset.h"

namespace roevo {
namespace {

using test::errorOf;
using test::TemporaryFolder;
using test::writeFile;

std::optional<CameraDescription> read(const std::string& text, const std::string& name = "camera.yaml") {
    const TemporaryFolder folder;
    writeFile(folder / name, text);
    return readCalibrationFile(folder / name);
}

std::string fault(const std::string& text, const std::string& name = "camera.yaml") {
    const std::string error = errorOf([&] { read(text, name); });
    EXPECT_EQ(error.find('\n'), std::string::npos) << error;
    return error;
}

const PinholeCamera kCamera{640, 480, 525.5, 526.5, 319.25, 239.75, {}};

TEST(CalibrationFile, CameraInfoOfRos) {
    const auto camera = read(
        "image_width: 640\nimage_height: 480\ncamera_name: rgb\ncamera_matrix:\n  rows: 3\n  cols: 3\n"
        "  data: [525.5, 0., 319.25, 0., 526.5, 239.75, 0., 0., 1.]\ndistortion_model: rational_polynomial\n"
        "distortion_coefficients:\n  rows: 1\n  cols: 8\n  data: [0.1, -0.2, 0.001, 0.002, 0.3, 0.4, 0.5, "
        "0.6]\n"
        "projection_matrix:\n  rows: 3\n  cols: 4\n  data: [1, 0, 1, 0, 0, 1, 1, 0, 0, 0, 1, 0]\n");
    ASSERT_TRUE(camera);
    PinholeCamera expected = kCamera;
    expected.distortion = {0.1, -0.2, 0.001, 0.002, 0.3};
    expected.denominator = {0.4, 0.5, 0.6};
    EXPECT_EQ(camera->camera, expected);
    EXPECT_EQ(camera->depth_scale, 0) << "it does not tell";
    EXPECT_EQ(camera->source, "camera.yaml");
}

TEST(CalibrationFile, AMessageOfRosThatWasPrinted) {
    for (const std::string text :
         {"height: 480\nwidth: 640\ndistortion_model: 'equidistant'\nD: [0.1, 0.2, 0.3, 0.4]\n"
          "K: [525.5, 0.0, 319.25, 0.0, 526.5, 239.75, 0.0, 0.0, 1.0]\nR: [1]\n---\n",
          "header:\n  frame_id: a\nheight: 480\nwidth: 640\ndistortion_model: equidistant\nd:\n- 0.1\n- "
          "0.2\n- 0.3\n- "
          "0.4\nk:\n- 525.5\n- 0\n- 319.25\n- 0\n- 526.5\n- 239.75\n- 0\n- 0\n- 1\n"}) {
        const auto camera = read(text);
        ASSERT_TRUE(camera) << text;
        PinholeCamera expected = kCamera;
        expected.distortion = {0.1, 0.2, 0.3, 0.4, 0};
        expected.lens = LensModel::kKannalaBrandt;
        EXPECT_EQ(camera->camera, expected) << text;
    }
}

TEST(CalibrationFile, ASizeThatIsNotToldIsJudgedByThePrincipalPoint) {
    const std::string small = "Camera.fx: 130\nCamera.fy: 131\nCamera.cx: 79.5\nCamera.cy: 59.5\n";
    const auto camera = read(small);
    ASSERT_TRUE(camera);
    EXPECT_EQ(camera->camera.width, 0) << "the images tell it";
    EXPECT_EQ(asIfCentred(camera->camera).width, 159);
    EXPECT_EQ(asIfCentred(camera->camera).check(), "");
    EXPECT_THROW(read("Camera.fx: 1\n" + small.substr(small.find('\n') + 1)), std::runtime_error);
}

TEST(CalibrationFile, OrbSlam) {
    const std::string first =
        "%YAML:1.0\n\n#---\n# Camera\n#---\nCamera.fx: 525.5\nCamera.fy: 526.5\nCamera.cx: 319.25\n"
        "Camera.cy: 239.75\n\nCamera.k1: 0.2624\nCamera.k2: -0.9531\nCamera.p1: -0.0054\n"
        "Camera.p2: 0.0026\nCamera.k3: 1.1633\n\nCamera.fps: 15.0\nCamera.RGB: 1\n\n"
        "DepthMapFactor: 5208.0\nORBextractor.nFeatures: 1000\n";
    const auto old = read(first);
    ASSERT_TRUE(old);
    PinholeCamera expected = kCamera;
    expected.width = expected.height = 0;
    expected.distortion = {0.2624, -0.9531, -0.0054, 0.0026, 1.1633};
    EXPECT_EQ(old->camera, expected);
    EXPECT_EQ(old->depth_scale, 5208);
    EXPECT_EQ(old->frame_rate, 15);
    const auto fisheye = read(
        "%YAML:1.0\nFile.version: \"1.0\"\nCamera.type: \"KannalaBrandt8\"\nCamera1.fx: 525.5\nCamera1.fy: "
        "526.5\n"
        "Camera1.cx: 319.25\nCamera1.cy: 239.75\nCamera1.k1: 0.1\nCamera1.k2: 0.2\nCamera1.k3: "
        "0.3\nCamera1.k4: 0.4\n"
        "Camera.width: 640\nCamera.height: 480\nRGBD.DepthMapFactor: 1000.0\n"
        "T: !!opencv-matrix\n  rows: 4\n  cols: 4\n  dt: f\n  data: [1,0,0,0]\n");
    ASSERT_TRUE(fisheye);
    expected = kCamera;
    expected.distortion = {0.1, 0.2, 0.3, 0.4, 0};
    expected.lens = LensModel::kKannalaBrandt;
    EXPECT_EQ(fisheye->camera, expected);
    EXPECT_EQ(fisheye->depth_scale, 1000);
}

TEST(CalibrationFile, Json) {
    const std::string matrix = "525.5, 0, 0, 0, 526.5, 0, 319.25, 239.75, 1";
    struct Case {
        const char* name;
        std::string text;
        double scale;
    };
    const Case cases[] = {
        {"camera_intrinsic.json",
         "{\n\t\"width\" : 640,\n\t\"height\" : 480,\n\t\"intrinsic_matrix\" : [" + matrix + "]\n}", 0},
        {"intrinsic.json",
         "{\"color_format\": \"RS2_FORMAT_RGB8\", \"depth_scale\": 1000.0, \"fps\": 30.0, \"height\": 480, "
         "\"intrinsic_matrix\": [" +
             matrix + "], \"width\": 640}",
         1000},
        {"metadata",
         "{\"h\": 480, \"w\": 640, \"K\": [" + matrix + "], \"fps\": 60, \"poses\": [[0,0,0,1,0,0,0]]}", 0},
        {"a.json",
         R"({"color": {"width": 640, "height": 480, "fx": 525.5, "fy": 526.5, "ppx": 319.25, "ppy": 239.75,
             "model": "distortion.inverse_brown_conrady", "coeffs": [0, 0, 0, 0, 0]}, "depth_scale": 0.0010000000474974513})",
         1000},
        {"cam_params.json",
         R"({"camera": {"w": 640, "h": 480, "fx": 525.5, "fy": 526.5, "cx": 319.25, "cy": 239.75, "scale": 6553.5}})",
         6553.5},
        {"rows.json",
         R"({"width": 640, "height": 480, "K": [[525.5, 0, 319.25], [0, 526.5, 239.75], [0, 0, 1]]})", 0}};
    for (const Case& one : cases) {
        const auto camera = read(one.text, one.name);
        ASSERT_TRUE(camera) << one.name;
        EXPECT_EQ(camera->camera, kCamera) << one.name;
        EXPECT_EQ(camera->depth_scale, one.scale) << one.name;
    }
}

TEST(CalibrationFile, WhatIsNoCameraIsPassedOverUnlessItsNameSaysSo) {
    EXPECT_FALSE(read("{\"frames\": [1, 2]}", "notes.json"));
    EXPECT_FALSE(read("a: [1, 2\n", "notes.yaml"));
    EXPECT_FALSE(read("fx: many\nfy: 3\n", "notes.yaml"));
    EXPECT_CONTAINS(fault("{\"width\": 640, \"intrinsic_matrix\": [525.5, 0", "camera_intrinsic.json"),
                    "camera_intrinsic.json: no camera can be read from it");
    EXPECT_CONTAINS(fault("K: [1, 2, 3]\n"), "a 3x3 camera matrix is expected");
    EXPECT_CONTAINS(fault("fx: many\nfy: 3\n"), "camera.yaml");
    EXPECT_CONTAINS(fault("fx: .nan\nfy: 3\n"), "is no number");
    EXPECT_CONTAINS(fault("fx: 500\nfy: 500\ncx: -3\ncy: 2\nwidth: 640\nheight: 480\n"), "principal point");
    EXPECT_CONTAINS(fault("fx: 500\nfy: 500\ncx: 3\ncy: 2\nmodel: ftheta\ncoeffs: [1, 2]\n"),
                    "'ftheta' is not supported");
    EXPECT_CONTAINS(fault("K: &a [*a, *a, *a, *a, *a, *a, *a, *a, *a]\n"), "camera.yaml");
    EXPECT_FALSE(read("&a {camera: *a}\n"));
}

TEST(CalibrationFile, NamesThatSpeakForOne) {
    for (const char* name :
         {"a/TUM1.yaml", "camera_info.yml", "Intrinsics.JSON", "x/metadata", "color_depth.json"})
        EXPECT_TRUE(mayBeCalibration(name)) << name;
    for (const char* name :
         {"camera.txt", "depth_camera_info.yaml", "infra1.yaml", "rgb.png", "metadata.txt"})
        EXPECT_FALSE(mayBeCalibration(name)) << name;
}

TEST(Lens, NumberOfTermsAndModelMustBeKnown) {
    const auto lens = [](const std::string& model, const std::vector<double>& terms) {
        PinholeCamera camera = kCamera;
        setLens(model, terms, camera);
        return camera;
    };
    EXPECT_EQ(lens("plumb_bob", {0.1, 0.2, 0.3, 0.4}).distortion[3], 0.4);
    EXPECT_EQ(lens("rational_polynomial", std::vector<double>(14, 0)), kCamera);
    EXPECT_EQ(lens("anything", {0, 0}), kCamera);
    EXPECT_EQ(lens("Kannala Brandt4", {0, 0, 0, 0, 0}).lens, LensModel::kKannalaBrandt)
        << "no term is a lens, too";
    EXPECT_CONTAINS(errorOf([&] { lens("rational_polynomial", std::vector<double>(12, 0.1)); }),
                    "with 12 coefficients");
    EXPECT_CONTAINS(errorOf([&] { lens("equidistant", {1, 2, 3, 4, 5}); }), "with 5 coefficients");
    EXPECT_CONTAINS(errorOf([&] { lens("omni", {1}); }), "'omni' is not supported");
}

TEST(CameraFile, OtherLensesAndTheDepthCamera) {
    const TemporaryFolder folder;
    const auto readText = [&](const std::string& text) {
        writeFile(folder / "camera.txt", text);
        return readCameraFile(folder / "camera.txt");
    };
    PinholeCamera rational = kCamera, fisheye = kCamera;
    rational.distortion = {0.1, -0.2, 0.001, 0.002, 0.3};
    rational.denominator = {0.4, 0.5, 0.6};
    fisheye.distortion = {0.1, 0.2, 0.3, 0.4, 0};
    fisheye.lens = LensModel::kKannalaBrandt;
    const auto exact = [](double value) { return std::to_string(value); };
    for (const PinholeCamera& camera : {kCamera, rational, fisheye})
        EXPECT_EQ(readText(cameraFileText(camera, 1000, {}, exact)).camera, camera);
    const std::string own = cameraFileText(kCamera, 1000, {}, exact);
    EXPECT_FALSE(readText(own).registration);
    const std::string depth =
        "depth_width: 320\ndepth_height: 288\ndepth_fx: 252\ndepth_fy: 253\ndepth_cx: 160\n"
        "depth_cy: 144\n";
    const auto both = readText(own + depth +
                               "depth_fisheye_k1_k2_k3_k4: 1 2 3 4\ndepth_to_colour: 0.03 0.01 -0.02 0 0 "
                               "0.6 0.8\n");
    ASSERT_TRUE(both.registration);
    EXPECT_EQ(both.camera, kCamera);
    EXPECT_EQ(both.registration->depth_camera,
              (PinholeCamera{320, 288, 252, 253, 160, 144, {1, 2, 3, 4, 0}, {}, LensModel::kKannalaBrandt}));
    // Turned by 2 atan(0.6 / 0.8) about z
    EXPECT_NEAR(both.registration->T_colour_depth.linear()(0, 0), 0.28, 1e-12);
    EXPECT_NEAR(both.registration->T_colour_depth.linear()(1, 0), 0.96, 1e-12);
    EXPECT_EQ(both.registration->T_colour_depth.translation(), Eigen::Vector3d(0.03, 0.01, -0.02));
    EXPECT_CONTAINS(errorOf([&] { readText(own + "depth_fx: 252\n"); }),
                    "the depth camera lacks depth_width");
    EXPECT_CONTAINS(errorOf([&] { readText(own + "depth_to_colour: 0 0 0 0 0 0 1\n"); }), "no depth camera");
    EXPECT_CONTAINS(errorOf([&] { readText(own + depth + "depth_to_colour: 0 0 0 0 0 0 2\n"); }),
                    "length is not 1");
    EXPECT_CONTAINS(errorOf([&] { readText(own + "fisheye_k1_k2_k3_k4: 1 2 3 4\n"); }), "one lens at a time");
}

}  // namespace
}  // namespace roevo
