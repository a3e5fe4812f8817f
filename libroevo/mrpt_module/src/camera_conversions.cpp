#include "roevo_mrpt/camera_conversions.h"

#include <stdexcept>
#include <utility>

#include "camera/off_centre.h"

namespace roevo {
namespace {

/// MRPT's converters of TUM's sequences and its demo of OpenNI2 wrote rows for columns: of an image that is
/// wider than high the principal point is then too far to the right and up, and in the middle the other way
/// round.
bool isTransposed(const PinholeCamera& camera) {
    PinholeCamera turned = camera;
    std::swap(turned.width, turned.height);
    return camera.width < camera.height && camera.cx > 0.6 * camera.width &&
           camera.cy < 0.45 * camera.height && offCentre(turned) < 0.1;
}

}  // namespace

mrpt::img::TCamera toMrptCamera(const PinholeCamera& camera, const std::string& name) {
    mrpt::img::TCamera out;
    out.ncols = static_cast<std::uint32_t>(camera.width);
    out.nrows = static_cast<std::uint32_t>(camera.height);
    out.setIntrinsicParamsFromValues(camera.fx, camera.fy, camera.cx, camera.cy);
    const auto& d = camera.distortion;
    if (camera.lens == LensModel::kKannalaBrandt) {
        out.setDistortionKannalaBrandt(d[0], d[1], d[2], d[3]);
    } else if (camera.isDistorted()) {
        out.setDistortionPlumbBob(d[0], d[1], d[2], d[3], d[4]);
        out.k4(camera.denominator[0]);
        out.k5(camera.denominator[1]);
        out.k6(camera.denominator[2]);
    }
    out.cameraName = name;
    return out;
}

PinholeCamera fromMrptCamera(const mrpt::img::TCamera& camera, const std::string& what) {
    // An untouched TCamera says 640x480 and holds zeros: MRPT itself does not complain.
    if (!(camera.fx() != 0 && camera.fy() != 0))
        throw std::runtime_error(
            "no intrinsics: the " + what +
            " of this observation has focal length 0; calibrate it and write the parameters into the rawlog");
    PinholeCamera out;
    out.width = static_cast<int>(camera.ncols);
    out.height = static_cast<int>(camera.nrows);
    out.fx = camera.fx();
    out.fy = camera.fy();
    out.cx = camera.cx();
    out.cy = camera.cy();
    if (isTransposed(out)) std::swap(out.width, out.height);
    using mrpt::img::DistortionModel;
    if (camera.distortion == DistortionModel::plumb_bob) {
        out.distortion = {camera.k1(), camera.k2(), camera.p1(), camera.p2(), camera.k3()};
        out.denominator = {camera.k4(), camera.k5(), camera.k6()};
    } else if (camera.distortion == DistortionModel::kannala_brandt) {
        out.distortion = {camera.k1(), camera.k2(), camera.k3(), camera.k4(), 0};
        out.lens = LensModel::kKannalaBrandt;
    }
    if (const std::string fault = out.check(); !fault.empty())
        throw std::runtime_error("the intrinsics of the " + what + " are unusable: " + fault);
    return out;
}

}  // namespace roevo
