#include <pybind11/stl/filesystem.h>

#include "bindings.h"
#include "roevo_mrpt/config_file.h"

namespace py = pybind11;

namespace roevo::python {
namespace {

py::object valueOf(const OptionField& field) {
    if (const auto* number = std::get_if<double*>(&field.value)) return py::float_(**number);
    if (const auto* whole = std::get_if<int*>(&field.value)) return py::int_(**whole);
    if (const auto* flag = std::get_if<bool*>(&field.value)) return py::bool_(**flag);
    return py::str(field.toText());
}

OptionField fieldOf(OdometryOptions& options, const std::string& name) {
    for (OptionField& field : optionFields(options))
        if (field.name() == name) return field;
    throw py::key_error(setOption(options, name, ""));  // which is the closest one
}

void set(OdometryOptions& options, const std::string& name, const py::handle& value) {
    std::string text = py::str(value);
    if (text == "True" || text == "False") text = text == "True" ? "true" : "false";  // NumPy's, too
    if (const std::string fault = setOption(options, name, text); !fault.empty())
        throw std::invalid_argument(fault);
}

std::string describe(OdometryOptions& options, const std::string& name) {
    const OptionField field = fieldOf(options, name);
    std::string text = field.description + (field.unit.empty() ? "" : ", " + field.unit);
    if (std::holds_alternative<bool*>(field.value))
        text += ", True or False";
    else if (field.max > field.min)
        text += ", " + std::string(py::str(py::float_(field.min))) + " to " +
                std::string(py::str(py::float_(field.max)));
    return text;
}

py::list names(OdometryOptions& options) {
    py::list out;
    for (const OptionField& field : optionFields(options)) out.append(field.name());
    return out;
}

bool has(OdometryOptions& options, const std::string& name) {
    for (const OptionField& field : optionFields(options))
        if (field.name() == name) return true;
    return false;
}

}  // namespace

OdometryOptions toOptions(const py::dict& values) {
    OdometryOptions options;
    for (const auto& [name, value] : values) set(options, py::str(name), value);
    return options;
}

void addOptions(py::module_& module) {
    py::class_<OdometryOptions>(module, "Options",
                                R"(Every option of the odometry, by "section.key" as in roevo.ini.

    options = roevo.Options({"odometry.mode": "tr"})
    options["keyframe.max_rotation_deg"] = 10
    for name in options:
        print(name, options[name], options.describe(name)))")
        .def(py::init(&toOptions), py::arg("values") = py::dict(),
             "The defaults, and on top what the dict says. Raises ValueError naming the option.")
        .def_static(
            "read",
            [](const std::filesystem::path& file) {
                OdometryOptions options;
                loadConfigFile(file.string(), options);
                return options;
            },
            py::arg("file"), "The defaults, and on top what an .ini file says, such as config_used.ini.")
        .def(
            "save",
            [](const OdometryOptions& self, const std::filesystem::path& file) {
                saveConfigFile(file.string(), self);
            },
            py::arg("file"), "Writes all options as an .ini file with comments.")
        .def(
            "__getitem__",
            [](OdometryOptions& self, const std::string& name) { return valueOf(fieldOf(self, name)); },
            py::arg("name"))
        .def("__setitem__", &set, py::arg("name"), py::arg("value"))
        .def("__contains__", &has, py::arg("name"))
        .def("__len__", [](OdometryOptions& self) { return optionFields(self).size(); })
        .def("__iter__", [](OdometryOptions& self) { return py::iter(names(self)); })
        .def("keys", &names)
        .def("describe", &describe, py::arg("name"), "What the option is, its unit and its range.");
}

}  // namespace roevo::python
