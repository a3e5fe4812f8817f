#pragma once
/// The parts of the Python module, each of which adds its classes.

#include <pybind11/pybind11.h>

#include "roevo/options.h"

namespace roevo::python {

void addCamera(pybind11::module_& module);
void addOptions(pybind11::module_& module);
void addOdometry(pybind11::module_& module);

/// What a dict of "section.key" and values means, on top of the defaults.
/// @throws std::invalid_argument in one line, naming the option
OdometryOptions toOptions(const pybind11::dict& values);

}  // namespace roevo::python
