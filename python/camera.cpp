#include <pybind11/operators.h>
#include <pybind11/stl.h>

#include <sstream>

#include "bindings.h"
#include "roevo/camera/pinhole_camera.h"

namespace py = pybind11;

namespace roevo::python {
namespace {

/// What makes the same camera again: all digits that tell it from others.
std::string toText(const PinholeCamera& camera) {
    const auto exact = [](double value) { return std::string(py::repr(py::float_(value))); };
    std::ostringstream out;
    out << "roevo.Camera(" << camera.width << ", " << camera.height;
    for (const double value : {camera.fx, camera.fy, camera.cx, camera.cy}) out << ", " << exact(value);
    if (camera.isDistorted()) {
        const char* separator = ", distortion=[";
        for (const double value : camera.distortion) {
            out << separator << exact(value);
            separator = ", ";
        }
        out << ']';
    }
    out << ')';
    return out.str();
}

}  // namespace

void addCamera(py::module_& module) {
    py::class_<PinholeCamera>(module, "Camera", R"(Pinhole camera with OpenCV's lens of five numbers.

Pixel centres are at whole coordinates. Images may be distorted: they are undistorted inside.)")
        .def(py::init([](int width, int height, double fx, double fy, double cx, double cy,
                         const std::array<double, 5>& distortion) {
                 const PinholeCamera camera{width, height, fx, fy, cx, cy, distortion};
                 if (const std::string fault = camera.check(); !fault.empty())
                     throw std::invalid_argument(fault);
                 return camera;
             }),
             py::arg("width"), py::arg("height"), py::arg("fx"), py::arg("fy"), py::arg("cx"), py::arg("cy"),
             py::arg("distortion") = std::array<double, 5>{},
             "All in pixels; distortion is k1 k2 p1 p2 k3. Raises ValueError for what no camera is.")
        .def_readonly("width", &PinholeCamera::width, "pixels")
        .def_readonly("height", &PinholeCamera::height, "pixels")
        .def_readonly("fx", &PinholeCamera::fx, "pixels")
        .def_readonly("fy", &PinholeCamera::fy, "pixels")
        .def_readonly("cx", &PinholeCamera::cx, "pixels")
        .def_readonly("cy", &PinholeCamera::cy, "pixels")
        .def_readonly("distortion", &PinholeCamera::distortion, "k1 k2 p1 p2 k3")
        .def(py::self == py::self)
        .def("__repr__", &toText);
}

}  // namespace roevo::python
