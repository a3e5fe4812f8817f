#include <pybind11/numpy.h>
#include <pybind11/operators.h>
#include <pybind11/stl.h>

#include <sstream>
#include <vector>

#include "bindings.h"
#include "camera/lens_terms.h"
#include "roevo/camera/pinhole_camera.h"

namespace py = pybind11;

namespace roevo::python {
namespace {

using Terms = std::vector<double>;

/// The first ones, if the lens is such a one; else none.
Terms termsOf(const PinholeCamera& camera, LensModel lens, std::size_t count) {
    Terms terms;
    for (std::size_t i = 0; camera.lens == lens && i < count; ++i) terms.push_back(lensTerm(camera, i));
    return terms;
}
Terms distortionOf(const PinholeCamera& camera) {
    return termsOf(camera, LensModel::kBrownConrady, camera.isRational() ? 8 : 5);
}
Terms fisheyeOf(const PinholeCamera& camera) {
    return termsOf(camera, LensModel::kKannalaBrandt, 4);
}

/// What makes the same camera again: all digits that tell it from others.
std::string toText(const PinholeCamera& camera) {
    const auto exact = [](double value) { return std::string(py::repr(py::float_(value))); };
    std::ostringstream out;
    out << "roevo.Camera(" << camera.width << ", " << camera.height;
    for (const double value : {camera.fx, camera.fy, camera.cx, camera.cy}) out << ", " << exact(value);
    const auto add = [&](const char* name, const Terms& terms) {
        const char* separator = "=[";
        out << ", " << name;
        for (const double value : terms) {
            out << separator << exact(value);
            separator = ", ";
        }
        out << ']';
    };
    if (camera.lens == LensModel::kKannalaBrandt)
        add("fisheye", fisheyeOf(camera));
    else if (camera.isDistorted())
        add("distortion", distortionOf(camera));
    out << ')';
    return out.str();
}

/// @param values  any sequence or array of numbers, of any shape; None: none
Terms toTerms(const py::object& values, const char* name) {
    if (values.is_none()) return {};
    const auto numbers = py::array_t<double, py::array::c_style | py::array::forcecast>::ensure(values);
    if (!numbers) throw py::type_error(std::string(name) + " must be numbers");
    return {numbers.data(), numbers.data() + numbers.size()};
}

PinholeCamera makeCamera(int width, int height, double fx, double fy, double cx, double cy,
                         const py::object& distortion, const py::object& fisheye) {
    PinholeCamera camera{width, height, fx, fy, cx, cy};
    const Terms terms = toTerms(distortion, "distortion"), of_fisheye = toTerms(fisheye, "fisheye");
    if (!terms.empty() && !of_fisheye.empty())
        throw std::invalid_argument("a lens has distortion or fisheye, not both");
    const auto count = terms.size();
    if (count != 0 && count != 4 && count != 5 && count != 8)
        throw std::invalid_argument("distortion must be 4, 5 or 8 numbers (k1 k2 p1 p2 k3 k4 k5 k6), not " +
                                    std::to_string(count));
    for (std::size_t i = 0; i < count; ++i) lensTerm(camera, i) = terms[i];
    if (!of_fisheye.empty()) {
        if (of_fisheye.size() != 4)
            throw std::invalid_argument("fisheye must be 4 numbers (k1 k2 k3 k4), not " +
                                        std::to_string(of_fisheye.size()));
        camera.lens = LensModel::kKannalaBrandt;
        for (std::size_t i = 0; i < 4; ++i) lensTerm(camera, i) = of_fisheye[i];
    }
    if (const std::string fault = camera.check(); !fault.empty()) throw std::invalid_argument(fault);
    return camera;
}

py::tuple stateOf(const PinholeCamera& c) {
    return py::make_tuple(c.width, c.height, c.fx, c.fy, c.cx, c.cy, distortionOf(c), fisheyeOf(c));
}

}  // namespace

void addCamera(py::module_& module) {
    py::class_<PinholeCamera>(module, "Camera", R"(Pinhole camera with a lens as OpenCV has it.

Pixel centres are at whole coordinates. Images may be distorted: they are undistorted inside.)")
        .def(py::init(&makeCamera), py::arg("width"), py::arg("height"), py::arg("fx"), py::arg("fy"),
             py::arg("cx"), py::arg("cy"), py::arg("distortion") = py::none(),
             py::arg("fisheye") = py::none(),
             R"(width height fx fy cx cy are in pixels.

distortion   4, 5 or 8 numbers in OpenCV's order: k1 k2 p1 p2 k3, and k4 k5 k6 of a rational model
fisheye      instead of it k1 k2 k3 k4 of a fish-eye (cv2.fisheye, "equidistant", Kannala-Brandt)
Raises ValueError for what no camera is.)")
        .def_readonly("width", &PinholeCamera::width, "pixels")
        .def_readonly("height", &PinholeCamera::height, "pixels")
        .def_readonly("fx", &PinholeCamera::fx, "pixels")
        .def_readonly("fy", &PinholeCamera::fy, "pixels")
        .def_readonly("cx", &PinholeCamera::cx, "pixels")
        .def_readonly("cy", &PinholeCamera::cy, "pixels")
        .def_property_readonly("distortion", &distortionOf,
                               "k1 k2 p1 p2 k3, and k4 k5 k6 of a rational model; empty for a fish-eye")
        .def_property_readonly("fisheye", &fisheyeOf, "k1 k2 k3 k4 of a fish-eye, else empty")
        .def(py::self == py::self)
        .def("__hash__",
             [](const PinholeCamera& self) {
                 return py::hash(py::make_tuple(self.width, self.height, self.fx, self.fy, self.cx, self.cy));
             })
        .def("__repr__", &toText)
        .def(py::pickle(&stateOf, [](const py::tuple& state) {
            const auto at = [&](std::size_t i) { return state[i].cast<double>(); };
            return makeCamera(state[0].cast<int>(), state[1].cast<int>(), at(2), at(3), at(4), at(5),
                              py::object(state[6]), py::object(state[7]));
        }));
}

}  // namespace roevo::python
