#include "renderer.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <thread>

#include "texture.h"

namespace roevo::simulator {
namespace {

constexpr int kBandRows = 16, kTileColumns = 32;
constexpr float kContrast = 7.f / 255;  // of neighbouring pixels, above which more rays are cast

/// Eight offsets, one in every eighth of a pixel's rows and columns and symmetric about the centre, so that
/// edges are smooth in any direction and nothing is shifted.
constexpr int kSamples = 8;
constexpr double kColumns[kSamples] = {3, 6, 0, 5, 2, 7, 1, 4};
/// The first four are spread and symmetric too: they do where they agree.
constexpr int kOrder[kSamples] = {0, 7, 2, 5, 1, 6, 3, 4};
double sampleOffset(double eighth) {
    return (eighth - 3.5) / kSamples;
}

Eigen::Vector2d undistort(const PinholeCamera& camera, const Eigen::Vector2d& pixel) {
    Eigen::Vector2d ideal = pixel;
    if (camera.isDistorted())
        for (int i = 0; i < 60; ++i) ideal += pixel - camera.distortPixel(ideal);
    return {(ideal.x() - camera.cx) / camera.fx, (ideal.y() - camera.cy) / camera.fy};
}

}  // namespace

struct Renderer::Band {
    int first_row = 0, last_row = 0;  // half open
    std::shared_ptr<const View> view;
};

Renderer::Renderer(const Scene& scene, const PinholeCamera& camera, int threads)
    : scene_(scene), camera_(camera), threads_(threads) {
    rays_.create(camera.height, camera.width, CV_64FC2);
    for (int row = 0; row < camera.height; ++row) {
        for (int col = 0; col < camera.width; ++col) {
            const Eigen::Vector2d ray = undistort(camera, {col, row});
            rays_.at<cv::Vec2d>(row, col) = {ray.x(), ray.y()};
        }
    }
}

void Renderer::forEachBand(int count, const std::function<void(int)>& work) const {
    std::atomic<int> next{0};
    const auto run = [&] {
        for (int i = next++; i < count; i = next++) work(i);
    };
    std::vector<std::thread> helpers;
    for (int i = 1; i < std::min(threads_, count); ++i) helpers.emplace_back(run);
    run();
    for (std::thread& helper : helpers) helper.join();
}

Rendering Renderer::render(const std::function<Instant(double row)>& instant_of_row, bool by_row,
                           bool with_colour) const {
    if (with_colour)
        std::call_once(bake_once_, [&] { baked_ = std::make_unique<const BakedLight>(scene_, threads_); });
    const int rows = by_row ? 1 : kBandRows;
    std::vector<Band> bands;
    for (int row = 0; row < camera_.height; row += rows) {
        Band band{row, std::min(row + rows, camera_.height), nullptr};
        band.view = by_row || bands.empty() ? std::make_shared<const View>(scene_, instant_of_row(row))
                                            : bands[0].view;
        bands.push_back(band);
    }
    Rendering out;
    if (with_colour) {
        out.colour.create(camera_.height, camera_.width, CV_32FC3);
        out.moving_shadow.create(camera_.height, camera_.width, CV_8UC1);
    }
    out.depth.create(camera_.height, camera_.width, CV_32FC1);
    out.objects.create(camera_.height, camera_.width, CV_32SC1);
    forEachBand(static_cast<int>(bands.size()),
                [&](int i) { renderCentres(bands[static_cast<size_t>(i)], out); });
    if (!with_colour) return out;
    cv::Mat smooth = out.colour.clone();
    forEachBand(static_cast<int>(bands.size()),
                [&](int i) { refine(bands[static_cast<size_t>(i)], out, smooth); });
    out.colour = smooth;
    return out;
}

namespace {

/// Ideal image coordinates covered by a block of pixels, one pixel wider on every side. A lens maps the rim
/// of a block onto the rim of its image.
ImageRect rectOf(const cv::Mat& rays, const PinholeCamera& camera, int first_row, int last_row, int first_col,
                 int last_col) {
    ImageRect rect;
    for (const int row : {first_row, last_row - 1})
        for (int col = first_col; col < last_col; ++col) {
            const auto& ray = rays.at<cv::Vec2d>(row, col);
            rect.include(ray[0], ray[1]);
        }
    for (int row = first_row; row < last_row; ++row)
        for (const int col : {first_col, last_col - 1}) {
            const auto& ray = rays.at<cv::Vec2d>(row, col);
            rect.include(ray[0], ray[1]);
        }
    const double margin_x = 1.5 / camera.fx, margin_y = 1.5 / camera.fy;
    return {rect.x0 - margin_x, rect.x1 + margin_x, rect.y0 - margin_y, rect.y1 + margin_y};
}

}  // namespace

void Renderer::renderCentres(const Band& band, Rendering& out) const {
    const View& view = *band.view;
    std::vector<int> in_band, in_tile;
    view.select(rectOf(rays_, camera_, band.first_row, band.last_row, 0, camera_.width), view.all(), in_band);
    for (int col0 = 0; col0 < camera_.width; col0 += kTileColumns) {
        const int col1 = std::min(col0 + kTileColumns, camera_.width);
        view.select(rectOf(rays_, camera_, band.first_row, band.last_row, col0, col1), in_band, in_tile);
        for (int row = band.first_row; row < band.last_row; ++row) {
            for (int col = col0; col < col1; ++col) {
                const auto& ray = rays_.at<cv::Vec2d>(row, col);
                ViewHit hit;
                const bool seen = view.trace(ray[0], ray[1], in_tile, hit);
                out.depth.at<float>(row, col) = static_cast<float>(hit.depth);
                out.objects.at<int>(row, col) = hit.primitive;
                if (out.colour.empty()) continue;
                bool moving_shadow = false;
                const Colour colour =
                    seen ? shade(view, ray[0], ray[1], hit, 1, &moving_shadow) : Colour(0, 0, 0);
                out.colour.at<cv::Vec3f>(row, col) = {colour.z(), colour.y(), colour.x()};
                out.moving_shadow.at<uchar>(row, col) = moving_shadow;
            }
        }
    }
}

void Renderer::refine(const Band& band, const Rendering& centres, cv::Mat& smooth) const {
    const View& view = *band.view;
    std::vector<int> in_band, in_tile;
    view.select(rectOf(rays_, camera_, band.first_row, band.last_row, 0, camera_.width), view.all(), in_band);
    const auto rough = [&](int row, int col) {
        const auto& own = centres.colour.at<cv::Vec3f>(row, col);
        const int object = centres.objects.at<int>(row, col);
        const auto differs = [&](int r, int c) {
            const auto& other = centres.colour.at<cv::Vec3f>(r, c);
            return centres.objects.at<int>(r, c) != object || std::abs(own[0] - other[0]) > kContrast ||
                   std::abs(own[1] - other[1]) > kContrast || std::abs(own[2] - other[2]) > kContrast;
        };
        return (col > 0 && differs(row, col - 1)) || (col + 1 < camera_.width && differs(row, col + 1)) ||
               (row > 0 && differs(row - 1, col)) || (row + 1 < camera_.height && differs(row + 1, col));
    };
    for (int col0 = 0; col0 < camera_.width; col0 += kTileColumns) {
        const int col1 = std::min(col0 + kTileColumns, camera_.width);
        view.select(rectOf(rays_, camera_, band.first_row, band.last_row, col0, col1), in_band, in_tile);
        for (int row = band.first_row; row < band.last_row; ++row) {
            for (int col = col0; col < col1; ++col) {
                if (!rough(row, col)) continue;
                const auto& ray = rays_.at<cv::Vec2d>(row, col);
                const int left = std::max(col - 1, 0), right = std::min(col + 1, camera_.width - 1);
                const int top = std::max(row - 1, 0), bottom = std::min(row + 1, camera_.height - 1);
                const cv::Vec2d along_u =
                    (rays_.at<cv::Vec2d>(row, right) - rays_.at<cv::Vec2d>(row, left)) / (right - left);
                const cv::Vec2d along_v =
                    (rays_.at<cv::Vec2d>(bottom, col) - rays_.at<cv::Vec2d>(top, col)) / (bottom - top);
                Colour sum(0, 0, 0), least = Colour::Constant(1), most(0, 0, 0);
                int taken = 0;
                for (const int i : kOrder) {
                    if (taken == kSamples / 2 && (most - least).maxCoeff() < kContrast) break;
                    const cv::Vec2d at =
                        ray + sampleOffset(kColumns[i]) * along_u + sampleOffset(i) * along_v;
                    ViewHit hit;
                    Colour colour(0, 0, 0);
                    if (view.trace(at[0], at[1], in_tile, hit))
                        colour = shade(view, at[0], at[1], hit, 0.4f, nullptr);
                    sum += colour;
                    least = least.cwiseMin(colour);
                    most = most.cwiseMax(colour);
                    ++taken;
                }
                sum /= static_cast<float>(taken);
                smooth.at<cv::Vec3f>(row, col) = {sum.z(), sum.y(), sum.x()};
            }
        }
    }
}

Colour Renderer::shade(const View& view, double x, double y, const ViewHit& hit, float pixel_width,
                       bool* moving_shadow) const {
    const Primitive& primitive = scene_.primitives[static_cast<size_t>(hit.primitive)];
    const Material& material = scene_.materials[static_cast<size_t>(primitive.material)];
    const FacePoint face = facePointOf(primitive, hit.unit_point, hit.unit.normal);
    const Pose& T_world_camera = view.instant().T_world_camera;
    const Eigen::Vector3d way = T_world_camera.linear() * Eigen::Vector3d(x, y, 1);
    const Eigen::Vector3d point = T_world_camera.translation() + way * hit.depth;
    Eigen::Vector3d normal = worldNormal(primitive, hit.unit.normal);
    const double facing = -normal.dot(way);
    if (facing < 0) normal = -normal;  // a sheet seen from its back

    SurfacePoint surface{face.u, face.v, face.half_u, face.half_v, 0};
    const double slant = std::max(std::abs(facing) / way.norm(), 0.1);
    surface.footprint = pixel_width * static_cast<float>(hit.depth / camera_.fx / std::sqrt(slant));
    const Colour albedo = textureColour(material, surface);
    if (material.emission >= 1) return albedo.cwiseMin(1.f);

    const BakedLight::Shares shares = baked_->at(hit.primitive, face);
    // Light from the surroundings comes from above rather than from below.
    Colour light =
        Colour::Constant(scene_.ambient * shares[0] * (0.85f + 0.15f * static_cast<float>(normal.z())));
    int baked_index = 0;
    for (const Light& lamp : scene_.lights) {
        const Eigen::Vector3d to_lamp = lamp.position - point;
        const double distance2 = to_lamp.squaredNorm();
        const double cosine = normal.dot(to_lamp) / std::sqrt(distance2);
        float share = 1;
        if (!lamp.sharp_shadows) share = shares[static_cast<size_t>(1 + baked_index++)];
        if (cosine <= 0) continue;
        if (lamp.sharp_shadows) {
            const View::Blocking blocking = view.blocking(point + 1e-4 * normal, lamp.position);
            if (moving_shadow && blocking.moving && !blocking.resting && cosine > 0.02) *moving_shadow = true;
            if (blocking.moving || blocking.resting) continue;
        }
        const auto falloff = static_cast<float>(cosine / (1 + distance2 / (lamp.reach * lamp.reach)));
        light += lamp.tint * (lamp.power * share * falloff);
    }
    const Colour lit =
        albedo.cwiseProduct(light * (1 - material.emission) + Colour::Constant(material.emission));
    return lit.cwiseMin(1.f);
}

}  // namespace roevo::simulator
