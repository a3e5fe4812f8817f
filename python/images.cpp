#include "images.h"

#include <cmath>
#include <cstring>
#include <opencv2/imgproc.hpp>

#include "bindings.h"
#include "roevo/camera/depth_registration.h"

namespace py = pybind11;

namespace roevo::python {
namespace {

std::string shapeOf(const py::array& array) {
    std::string text;
    for (py::ssize_t i = 0; i < array.ndim(); ++i)
        text += (i > 0 ? " x " : "") + std::to_string(array.shape(i));
    return text.empty() ? "a single value" : text;
}

std::string typeOf(const py::array& array) {
    return py::str(static_cast<py::object>(array.dtype()));
}

template <class Value>
bool holds(const py::array& array) {
    return array.dtype().equal(py::dtype::of<Value>());
}

py::array toArray(const py::object& object, const std::string& name) {
    if (!py::isinstance<py::array>(object))
        throw py::type_error(name + " must be a numpy array, not " + nameOfType(object));
    if (py::hasattr(object, "filled"))  // its mask would be lost
        throw py::type_error(name + " is a masked array: give " + name + ".filled(0)");
    return py::reinterpret_borrow<py::array>(object);
}

void checkSize(const py::array& array, const std::string& name, const PinholeCamera& camera) {
    if (array.shape(0) == camera.height && array.shape(1) == camera.width) return;
    throw std::invalid_argument(name + " is " + shapeOf(array) + ", but the camera has " +
                                std::to_string(camera.height) + " rows and " + std::to_string(camera.width) +
                                " columns");
}

/// A copy, whatever the strides are.
template <class Value>
cv::Mat copy(const py::array& array, int type) {
    const auto rows = py::array_t<Value, py::array::c_style>::ensure(array);
    cv::Mat image(static_cast<int>(array.shape(0)), static_cast<int>(array.shape(1)), type);
    std::memcpy(image.data, rows.data(), static_cast<std::size_t>(rows.nbytes()));
    return image;
}

cv::Mat toColour(const py::array& array, const PinholeCamera& camera) {
    const bool grey = array.ndim() == 2, colour = array.ndim() == 3 && array.shape(2) == 3;
    if (!grey && !colour)
        throw std::invalid_argument("colour must be height x width x 3 or height x width, not " +
                                    shapeOf(array));
    if (!holds<std::uint8_t>(array))
        throw py::type_error("colour must be of type uint8, not " + typeOf(array));
    checkSize(array, "colour", camera);
    return copy<std::uint8_t>(array, grey ? CV_8UC1 : CV_8UC3);
}

cv::Mat toMetres(const cv::Mat& units, double units_per_metre) {
    const float unit = 1.f / static_cast<float>(units_per_metre);  // as the readers of recordings do
    cv::Mat metres(units.size(), CV_32FC1);
    for (int v = 0; v < units.rows; ++v)
        for (int u = 0; u < units.cols; ++u)
            metres.at<float>(v, u) = static_cast<float>(units.at<std::uint16_t>(v, u)) * unit;
    return metres;
}

cv::Mat toDepth(const py::array& array, const py::object& depth_scale, const PinholeCamera& camera) {
    if (array.ndim() != 2) throw std::invalid_argument("depth must be height x width, not " + shapeOf(array));
    const bool is_float = holds<float>(array);
    if (!is_float && !holds<std::uint16_t>(array))
        throw py::type_error("depth must be of type uint16 or float32, not " + typeOf(array) +
                             " (see numpy's astype())");
    checkSize(array, "depth", camera);
    if (is_float) {
        if (!depth_scale.is_none())
            throw std::invalid_argument("depth_scale is for uint16 depth; float32 depth is in metres");
        cv::Mat depth = copy<float>(array, CV_32FC1);
        for (int v = 0; v < depth.rows; ++v)
            for (int u = 0; u < depth.cols; ++u)
                if (!std::isfinite(depth.at<float>(v, u))) depth.at<float>(v, u) = 0;
        return depth;
    }
    if (depth_scale.is_none())
        throw std::invalid_argument(
            "depth is uint16: give depth_scale, its units per metre (1000 for millimetres, 5000 for TUM's)");
    const double scale = toNumber(depth_scale, "depth_scale");
    if (!(scale > 0 && std::isfinite(scale)))
        throw std::invalid_argument("depth_scale must be above 0 units per metre, not " +
                                    std::string(py::str(py::float_(scale))));
    return toMetres(copy<std::uint16_t>(array, CV_16UC1), scale);
}

cv::Mat toMask(const py::array& array, const PinholeCamera& camera) {
    if (array.ndim() != 2) throw std::invalid_argument("mask must be height x width, not " + shapeOf(array));
    const bool is_bool = holds<bool>(array);
    if (!is_bool && !holds<std::uint8_t>(array))
        throw py::type_error("mask must be of type bool or uint8, not " + typeOf(array));
    checkSize(array, "mask", camera);
    return is_bool ? copy<bool>(array, CV_8UC1) : copy<std::uint8_t>(array, CV_8UC1);
}

}  // namespace

std::string nameOfType(const py::object& object) {
    return py::str(py::type::of(object).attr("__name__"));
}

double toNumber(const py::object& value, const std::string& name) {
    const double number = PyFloat_AsDouble(value.ptr());
    if (number != -1 || PyErr_Occurred() == nullptr) return number;
    PyErr_Clear();
    throw py::type_error(name + " must be a number, not " + nameOfType(value));
}

py::array_t<float> registerDepth(const py::object& depth, const PinholeCamera& depth_camera,
                                 const PinholeCamera& colour_camera, const Pose& T_colour_depth,
                                 const py::object& depth_scale) {
    const cv::Mat metres = toDepth(toArray(depth, "depth"), depth_scale, depth_camera);
    const cv::Mat registered = roevo::registerDepth(metres, depth_camera, colour_camera, T_colour_depth);
    py::array_t<float> out({registered.rows, registered.cols});
    for (int v = 0; v < registered.rows; ++v)
        std::memcpy(out.mutable_data(v, 0), registered.ptr<float>(v),
                    static_cast<std::size_t>(registered.cols) * sizeof(float));
    return out;
}

RgbdFrame toFrame(const py::object& colour, const py::object& depth, const py::object& stamp,
                  const py::object& depth_scale, bool bgr, const py::object& mask,
                  const PinholeCamera& camera) {
    RgbdFrame frame;
    frame.timestamp = toNumber(stamp, "stamp");
    if (!mask.is_none()) frame.mask = toMask(toArray(mask, "mask"), camera);
    const cv::Mat image = toColour(toArray(colour, "colour"), camera);
    frame.depth = toDepth(toArray(depth, "depth"), depth_scale, camera);
    if (image.channels() == 1) {
        frame.grey = image;
        return frame;
    }
    frame.colour = image;
    if (!bgr) cv::cvtColor(image, frame.colour, cv::COLOR_RGB2BGR);
    cv::cvtColor(frame.colour, frame.grey, cv::COLOR_BGR2GRAY);
    return frame;
}

}  // namespace roevo::python
