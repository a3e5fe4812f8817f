#pragma once
#include <pybind11/numpy.h>

#include <string>

#include "roevo/camera/pinhole_camera.h"
#include "roevo/camera/rgbd_frame.h"
#include "roevo/types.h"

namespace roevo::python {

/// @param name  as errors call it
/// @throws py::type_error where it is no number
double toNumber(const pybind11::object& value, const std::string& name);

/// What roevo.register_depth() does.
pybind11::array_t<float> registerDepth(const pybind11::object& depth, const PinholeCamera& depth_camera,
                                       const PinholeCamera& colour_camera, const Pose& T_colour_depth,
                                       const pybind11::object& depth_scale);

/// The arrays of one frame, copied, so that their owner may do with them as it likes.
/// @param colour       uint8, height x width x 3 (RGB, or BGR when told) or height x width (grey)
/// @param depth        height x width: uint16 with depth_scale units per metre, or float32 in metres; unknown
///                     where 0 or no number
/// @param mask         None, or bool or uint8, height x width: False or 0 where RgbdFrame::mask is to be 0
/// @throws py::type_error, std::invalid_argument in one line: which argument, what it is and what was
/// expected
RgbdFrame toFrame(const pybind11::object& colour, const pybind11::object& depth,
                  const pybind11::object& stamp, const pybind11::object& depth_scale, bool bgr,
                  const pybind11::object& mask, const PinholeCamera& camera);

}  // namespace roevo::python
