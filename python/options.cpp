#include <pybind11/stl/filesystem.h>
#include <unistd.h>

#include <cerrno>
#include <stdexcept>
#include <system_error>
#include <vector>

#include "bindings.h"
#include "input/regular_file.h"
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

py::object mapping() {
    return py::module_::import("collections.abc").attr("Mapping");
}

void set(OdometryOptions& options, const std::string& name, const py::handle& value) {
    std::string text = py::str(value);
    const bool is_whole = text.size() > 2 && text.compare(text.size() - 2, 2, ".0") == 0;
    if (is_whole && !py::isinstance<py::str>(value)) text.resize(text.size() - 2);    // a float for an int
    if (text == "True" || text == "False") text = text == "True" ? "true" : "false";  // NumPy's, too
    if (const std::string fault = setOption(options, name, text); !fault.empty())
        throw std::invalid_argument(fault);
}

std::string number(const OptionField& field, double value) {
    if (std::holds_alternative<int*>(field.value)) return std::to_string(static_cast<int>(value));
    return py::str(py::float_(value));
}

std::string describe(OdometryOptions& options, const std::string& name) {
    const OptionField field = fieldOf(options, name);
    std::string text = field.description + (field.unit.empty() ? "" : ", " + field.unit);
    if (std::holds_alternative<bool*>(field.value))
        text += ", True or False";
    else if (field.max > field.min)
        text += ", " + number(field, field.min) + " to " + number(field, field.max);
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

void update(OdometryOptions& options, const py::object& values) {
    if (!py::isinstance(values, mapping()))
        throw py::type_error("options must be roevo.Options or a dict, not " + nameOfType(values));
    OdometryOptions changed = options;
    for (const auto& [name, value] : py::dict(values)) set(changed, py::str(name), value);
    options = changed;
}

/// Those that are not as by default.
py::dict changed(OdometryOptions& options) {
    OdometryOptions defaults;
    const std::vector<OptionField> own = optionFields(options), usual = optionFields(defaults);
    py::dict out;
    for (std::size_t i = 0; i < own.size(); ++i)
        if (own[i].toText() != usual[i].toText()) out[py::str(own[i].name())] = valueOf(own[i]);
    return out;
}

[[noreturn]] void throwOsError(const std::filesystem::path& file, int error) {
    errno = error;
    PyErr_SetFromErrnoWithFilename(PyExc_OSError, file.c_str());
    throw py::error_already_set();
}

}  // namespace

OdometryOptions toOptions(const py::object& values) {
    if (py::isinstance<OdometryOptions>(values)) return values.cast<OdometryOptions>();
    OdometryOptions options;
    if (!values.is_none()) update(options, values);
    return options;
}

void requireReadable(const std::filesystem::path& file) {
    // Opening a pipe would wait for who writes to it
    if (access(file.c_str(), R_OK) != 0) throwOsError(file, errno);
    if (std::filesystem::is_directory(file)) throwOsError(file, EISDIR);
}

void saveTo(const std::filesystem::path& file, const std::function<void(const std::string&)>& save) {
    if (const std::string other = otherThanFile(file); !other.empty()) {
        PyErr_Format(PyExc_OSError, "cannot write %s: %s", file.c_str(), other.c_str());
        throw py::error_already_set();
    }
    try {
        save(file.string());
    } catch (const std::system_error& fault) {
        throwOsError(file, fault.code().value());
    }
}

void addOptions(py::module_& module) {
    py::class_<OdometryOptions> options(module, "Options",
                                        R"(Every option of the odometry, by "section.key" as in roevo.ini.

    options = roevo.Options({"odometry.mode": "tr"})
    options["keyframe.max_rotation_deg"] = 10
    for name in options:
        print(name, options[name], options.describe(name)))");
    options
        .def(py::init(&toOptions), py::arg("values") = py::none(),
             "The defaults, and on top what the dict says; or a copy. Raises ValueError naming the option.")
        .def_static(
            "read",
            [](const std::filesystem::path& file) {
                requireReadable(file);
                OdometryOptions options;
                try {
                    loadConfigFile(file.string(), options);
                } catch (const std::runtime_error& fault) {
                    throw std::invalid_argument(fault.what());
                }
                return options;
            },
            py::arg("file"), "The defaults, and on top what an .ini file says, such as config_used.ini.")
        .def(
            "save",
            [](const OdometryOptions& self, const std::filesystem::path& file) {
                saveTo(file, [&](const std::string& name) { saveConfigFile(name, self); });
            },
            py::arg("file"), "Writes all options as an .ini file with comments. Raises OSError.")
        .def(
            "__getitem__",
            [](OdometryOptions& self, const std::string& name) { return valueOf(fieldOf(self, name)); },
            py::arg("name"))
        .def("__setitem__", &set, py::arg("name"), py::arg("value"))
        .def("__contains__", &has, py::arg("name"))
        .def("__len__", [](OdometryOptions& self) { return optionFields(self).size(); })
        .def("__iter__", [](OdometryOptions& self) { return py::iter(names(self)); })
        .def("update", &update, py::arg("values"),
             "Sets those that a dict or another mapping names, all or none.")
        .def("__repr__",
             [](OdometryOptions& self) {
                 const py::dict own = changed(self);
                 return "roevo.Options(" + (own.empty() ? "" : std::string(py::repr(own))) + ")";
             })
        .def(py::pickle([](OdometryOptions& self) { return py::make_tuple(changed(self)); },
                        [](const py::tuple& state) { return toOptions(py::object(state[0])); }))
        .def("describe", &describe, py::arg("name"), "What the option is, its unit and its range.");
    // The rest of what a mapping can
    mapping().attr("register")(options);
    for (const char* name : {"keys", "values", "items", "get", "__eq__"})
        options.attr(name) = mapping().attr(name);
    options.attr("__hash__") = py::none();  // it can be changed
}

}  // namespace roevo::python
