#include "offscreen.h"

#include <mrpt/img/CImage.h>
#include <mrpt/poses/CPose3D.h>

#include <memory>
#include <opencv2/imgproc.hpp>
#include <stdexcept>

#include "roevo_mrpt/scene_objects.h"

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

OffscreenRenderer::OffscreenRenderer(compat::Scene& scene, const Background& background, cv::Size size)
    : scene_(scene), size_(size) {
    const cv::Size large = size * kSuperSampling;
    const auto padded_width = (static_cast<unsigned>(large.width) + kWidthStep - 1) / kWidthStep * kWidthStep;
    renderer_ = createRenderer(padded_width, static_cast<unsigned>(large.height));

    const auto& [r, g, b] = background.colour();
    background_ = 255 * cv::Scalar(b, g, r);
    const auto viewport = scene.getViewport("main");
    viewport->setCustomBackgroundColor(mrpt::img::TColorf(r, g, b));
    auto& lights = viewport->lightParameters();
    compat::setWhiteLight(lights.ambient, 0.6f);
    compat::setWhiteLight(lights.diffuse, 0.7f);
    compat::setWhiteLight(lights.specular, 0.1f);
}

cv::Mat OffscreenRenderer::drawLarge() {
    mrpt::img::CImage image;
    renderer_->render_RGB(scene_, image);
    return image.asCvMatRef()(cv::Rect({}, size_ * kSuperSampling)).clone();
}

cv::Mat OffscreenRenderer::draw(const View& view, const std::vector<compat::SceneObject::Ptr>& below) {
    scene_.getViewport("main")->setViewportClipDistances(static_cast<float>(view.near),
                                                         static_cast<float>(view.far));
    compat::scene::CCamera camera;
    camera.set6DOFMode(true);
    camera.setProjectiveModel(true);
    camera.setProjectiveFOVdeg(static_cast<float>(view.vertical_fov_deg));
    camera.setPose(mrpt::poses::CPose3D(mrpt::math::CMatrixDouble44(view.T_scene_camera.matrix())));
    renderer_->setCamera(scene_, camera);

    cv::Mat picture = drawLarge();
    if (!below.empty()) {
        for (const auto& object : below) object->setVisibility(false);
        const cv::Mat over = drawLarge();
        for (const auto& object : below) object->setVisibility(true);
        cv::Mat untouched;
        cv::inRange(over, background_ - cv::Scalar::all(0.6), background_ + cv::Scalar::all(0.6), untouched);
        over.copyTo(picture, ~untouched);
    }
    cv::Mat shrunk;
    cv::resize(picture, shrunk, size_, 0, 0, cv::INTER_AREA);
    return shrunk;
}

}  // namespace roevo
