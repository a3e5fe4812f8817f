#include "offscreen.h"

#include <mrpt/img/CImage.h>
#include <mrpt/opengl/CCamera.h>
#include <mrpt/opengl/CFBORender.h>
#include <mrpt/poses/CPose3D.h>

#include <memory>
#include <opencv2/imgproc.hpp>
#include <stdexcept>

#include "roevo_mrpt/mrpt_compat.h"

namespace roevo {
namespace {

constexpr unsigned kWidthStep = 4;  // MRPT reads pixels back with rows of four: other widths corrupt the heap

std::unique_ptr<mrpt::opengl::CFBORender> createRenderer(unsigned width, unsigned height) {
    try {
        return std::make_unique<mrpt::opengl::CFBORender>(width, height);
    } catch (const std::exception& e) {
        const std::string text = e.what();
        if (text.find("numDevices") != std::string::npos || text.find("EGL") != std::string::npos)
            throw std::runtime_error(
                "no OpenGL for drawing without a display; install the software renderer: apt-get install "
                "libegl1 "
                "libgl1-mesa-dri");
        throw;
    }
}

}  // namespace

cv::Mat renderOffscreen(mrpt::opengl::COpenGLScene& scene, const View& view, Background background, int width,
                        int height) {
    const int large_width = width * kSuperSampling, large_height = height * kSuperSampling;
    const auto padded_width = (static_cast<unsigned>(large_width) + kWidthStep - 1) / kWidthStep * kWidthStep;
    const auto renderer = createRenderer(padded_width, static_cast<unsigned>(large_height));

    const auto viewport = scene.getViewport("main");
    viewport->setCustomBackgroundColor(background == Background::kWhite
                                           ? mrpt::img::TColorf(1.f, 1.f, 1.f)
                                           : mrpt::img::TColorf(0.055f, 0.067f, 0.09f));
    viewport->setViewportClipDistances(static_cast<float>(view.near), static_cast<float>(view.far));
    auto& lights = viewport->lightParameters();
    compat::setWhiteLight(lights.ambient, 0.6f);
    compat::setWhiteLight(lights.diffuse, 0.7f);
    compat::setWhiteLight(lights.specular, 0.1f);

    mrpt::opengl::CCamera camera;
    camera.set6DOFMode(true);
    camera.setProjectiveModel(true);
    camera.setProjectiveFOVdeg(static_cast<float>(view.vertical_fov_deg));
    camera.setPose(mrpt::poses::CPose3D(mrpt::math::CMatrixDouble44(view.T_scene_camera.matrix())));
    renderer->setCamera(scene, camera);

    mrpt::img::CImage image;
    renderer->render_RGB(scene, image);
    const cv::Mat large = image.asCvMatRef()(cv::Rect(0, 0, large_width, large_height));
    cv::Mat shrunk;
    cv::resize(large, shrunk, {width, height}, 0, 0, cv::INTER_AREA);
    return shrunk;
}

}  // namespace roevo
