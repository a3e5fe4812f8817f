#include "roevo_mrpt/camera_conversions.h"

#include <stdexcept>

namespace roevo {

mrpt::img::TCamera toMrptCamera(const PinholeCamera& camera, const std::string& name) {
    mrpt::img::TCamera out;
    out.ncols = static_cast<std::uint32_t>(camera.width);
    out.nrows = static_cast<std::uint32_t>(camera.height);
    out.setIntrinsicParamsFromValues(camera.fx, camera.fy, camera.cx, camera.cy);
    const auto& d = camera.distortion;
    if (camera.isDistorted()) out.setDistortionPlumbBob(d[0], d[1], d[2], d[3], d[4]);
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
    using mrpt::img::DistortionModel;
    if (camera.distortion == DistortionModel::plumb_bob) {
        if (camera.k4() != 0 || camera.k5() != 0 || camera.k6() != 0)
            throw std::runtime_error("the " + what +
                                     " uses the rational lens model (k4, k5, k6), which is not supported");
        out.distortion = {camera.k1(), camera.k2(), camera.p1(), camera.p2(), camera.k3()};
    } else if (camera.distortion != DistortionModel::none) {
        throw std::runtime_error(
            "the " + what +
            " uses a fish-eye lens model, which is not supported: undistort the images first");
    }
    if (const std::string fault = out.check(); !fault.empty())
        throw std::runtime_error("the intrinsics of the " + what + " are unusable: " + fault);
    return out;
}

}  // namespace roevo
