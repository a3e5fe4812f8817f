#pragma once
/// The parts of the Python module, each of which adds its classes.

#include <pybind11/pybind11.h>

#include <Eigen/Core>
#include <filesystem>
#include <functional>
#include <string>

#include "roevo/options.h"
#include "roevo/types.h"

namespace roevo::python {

void addCamera(pybind11::module_& module);
void addOptions(pybind11::module_& module);
void addOdometry(pybind11::module_& module);

/// @param values  None: the defaults; Options: a copy; a dict or another mapping of "section.key" and values:
/// the defaults, and those on top
/// @throws std::invalid_argument in one line, naming the option; py::type_error for anything else
OdometryOptions toOptions(const pybind11::object& values);

/// As errors call it.
std::string nameOfType(const pybind11::object& object);

/// @param name  as errors call it
/// @throws std::invalid_argument for what is no rigid motion
Pose toPose(const Eigen::MatrixXd& matrix, const std::string& name);

/// @throws OSError as Python's open() does: FileNotFoundError, PermissionError ...
void requireReadable(const std::filesystem::path& file);

/// Lets `save` write a file. @throws OSError for a file that cannot be written; what else `save` throws
void saveTo(const std::filesystem::path& file, const std::function<void(const std::string&)>& save);

}  // namespace roevo::python
