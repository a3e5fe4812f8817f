#pragma once
#include <pybind11/numpy.h>

#include <optional>

#include "roevo/camera/pinhole_camera.h"
#include "roevo/camera/rgbd_frame.h"

namespace roevo::python {

/// The arrays of one frame, copied, so that their owner may do with them as it likes.
/// @param colour       uint8, height x width x 3 (RGB, or BGR when told) or height x width (grey)
/// @param depth        height x width: uint16 with depth_scale units per metre, or float32 in metres; unknown
///                     where 0 or no number
/// @param mask         None, or bool or uint8, height x width: False or 0 where RgbdFrame::mask is to be 0
/// @throws py::type_error, std::invalid_argument in one line: which array, what it is and what was expected
RgbdFrame toFrame(const pybind11::object& colour, const pybind11::object& depth, double stamp,
                  std::optional<double> depth_scale, bool bgr, const pybind11::object& mask,
                  const PinholeCamera& camera);

}  // namespace roevo::python
