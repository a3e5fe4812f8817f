#include "recordings/calibration_file.h"

#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <stdexcept>
#include <vector>

#include "input/excerpt.h"
#include "input/regular_file.h"
#include "recordings/depth_scale.h"
#include "recordings/lens.h"

namespace fs = std::filesystem;

namespace roevo {
namespace {

using KeyNames = std::initializer_list<const char*>;

constexpr std::uintmax_t kLargestFile = 16 << 20;  // bytes: Record3D's has all poses, too

std::string lowerName(const fs::path& path) {
    std::string name = path.string();
    std::transform(name.begin(), name.end(), name.begin(),
                   [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    return name;
}

bool hasOneOf(const std::string& text, KeyNames words) {
    return std::any_of(words.begin(), words.end(),
                       [&](const char* word) { return text.find(word) != std::string::npos; });
}

/// A map's first entry under one of these names. ORB-SLAM's have "Camera." or "Camera1." before them.
YAML::Node entryOf(const YAML::Node& map, KeyNames names) {
    for (const std::string prefix : {"", "Camera.", "Camera1.", "RGBD."})
        for (const char* name : names)
            if (const YAML::Node found = map[prefix + name]; found.IsDefined() && !found.IsNull())
                return found;
    return YAML::Node(YAML::NodeType::Undefined);
}

double numberOf(const YAML::Node& node) {
    const double value = node.as<double>();
    if (!std::isfinite(value)) throw std::runtime_error("'" + excerpt(node.Scalar()) + "' is no number");
    return value;
}

double numberIn(const YAML::Node& map, KeyNames names, double otherwise) {
    const YAML::Node found = entryOf(map, names);
    return found.IsDefined() && found.IsScalar() ? numberOf(found) : otherwise;
}

/// Numbers of a list, of a list of lists, or of a map's "data". A part may refer to one around it: there is a
/// limit.
void append(const YAML::Node& node, int levels, std::vector<double>& out) {
    constexpr std::size_t kMost = 16;
    if (node.IsScalar()) return out.push_back(numberOf(node));
    if (!node.IsSequence() || levels == 0 || node.size() > kMost || out.size() > kMost)
        throw std::runtime_error("a list of numbers is expected");
    for (const YAML::Node& part : node) append(part, levels - 1, out);
}

std::vector<double> numbersOf(const YAML::Node& node) {
    std::vector<double> out;
    if (node.IsDefined()) append(node.IsMap() ? node["data"] : node, 2, out);
    return out;
}

/// A 3x3 matrix by rows or (Open3D, Record3D) by columns, or fx fy cx cy alone (Kalibr).
void setMatrix(const std::vector<double>& m, PinholeCamera& camera) {
    if (m.size() == 4) {
        camera.fx = m[0], camera.fy = m[1], camera.cx = m[2], camera.cy = m[3];
        return;
    }
    if (m.size() != 9) throw std::runtime_error("a 3x3 camera matrix is expected");
    const bool by_columns = m[2] == 0 && m[5] == 0;
    camera.fx = m[0], camera.fy = m[4];
    camera.cx = by_columns ? m[6] : m[2], camera.cy = by_columns ? m[7] : m[5];
}

/// ORB-SLAM's terms, which have names of their own.
std::vector<double> namedTerms(const YAML::Node& map, bool fisheye) {
    const char* const brown[] = {"k1", "k2", "p1", "p2", "k3", "k4", "k5", "k6"};
    const char* const kannala[] = {"k1", "k2", "k3", "k4"};
    std::vector<double> out;
    for (std::size_t i = 0; i < (fisheye ? 4 : 8); i++)
        out.push_back(numberIn(map, {fisheye ? kannala[i] : brown[i]}, 0));
    return out;
}

/// RealSense tells metres per unit, others units per metre.
double unitsOf(double scale) {
    if (scale < 0) throw std::runtime_error("the depth scale is below 0");
    if (scale == 0 || scale >= 1) return scale;
    return unitsPerMetre(scale);
}

/// The camera that a part of a file describes, or nothing.
std::optional<CameraDescription> cameraIn(const YAML::Node& map) {
    if (!map.IsMap()) return std::nullopt;
    CameraDescription out;
    PinholeCamera& camera = out.camera;
    const YAML::Node matrix = entryOf(map, {"camera_matrix", "intrinsic_matrix", "K", "k", "intrinsics"});
    const bool has_matrix = matrix.IsSequence() || (matrix.IsMap() && matrix["data"].IsDefined());
    if (has_matrix)
        setMatrix(numbersOf(matrix), camera);
    else if (entryOf(map, {"fx"}).IsDefined() && entryOf(map, {"fy"}).IsDefined())
        camera.fx = numberIn(map, {"fx"}, 0), camera.fy = numberIn(map, {"fy"}, 0),
        camera.cx = numberIn(map, {"cx", "ppx"}, 0), camera.cy = numberIn(map, {"cy", "ppy"}, 0);
    else
        return std::nullopt;
    std::vector<double> size = numbersOf(entryOf(map, {"resolution"}));
    size.resize(2);
    camera.width =
        static_cast<int>(std::clamp(numberIn(map, {"width", "image_width", "w", "cols"}, size[0]), 0., 1e6));
    camera.height = static_cast<int>(
        std::clamp(numberIn(map, {"height", "image_height", "h", "rows"}, size[1]), 0., 1e6));
    if (camera.width == 0 || camera.height == 0) camera.width = camera.height = 0;

    const YAML::Node model_node = entryOf(map, {"distortion_model", "model", "type"});
    const std::string model = model_node.IsDefined() && model_node.IsScalar() ? model_node.Scalar() : "";
    const YAML::Node list = entryOf(map, {"distortion_coefficients", "distortion_coeffs", "dist_coeffs", "D",
                                          "d", "coeffs", "distortion"});
    const bool fisheye = model.rfind("Kannala", 0) == 0 && !list.IsDefined();
    setLens(model, list.IsDefined() ? numbersOf(list) : namedTerms(map, fisheye), camera);

    out.depth_scale =
        unitsOf(numberIn(map, {"DepthMapFactor", "depth_scale", "png_depth_scale", "scale"}, 0));
    if (const double rate = numberIn(map, {"fps", "frame_rate"}, 0); rate > 0) out.frame_rate = rate;
    return out;
}

/// At the top of the file, or in a part that is named after the camera.
std::optional<CameraDescription> findCamera(const YAML::Node& root, int levels) {
    if (auto found = cameraIn(root)) return found;
    if (!root.IsMap() || levels == 0) return std::nullopt;
    for (const char* part : {"color", "colour", "rgb", "camera", "cam", "cam0", "camera_params", "intrinsics",
                             "color_intrinsics", "intrinsic"})
        if (const YAML::Node inner = root[part]; inner.IsDefined() && inner.IsMap())
            if (auto found = findCamera(inner, levels - 1)) {
                if (!(found->depth_scale > 0))
                    found->depth_scale = unitsOf(numberIn(root, {"depth_scale", "png_depth_scale"}, 0));
                for (const char* other : {"depth", "depth_intrinsics"})
                    if (const YAML::Node beside = root[other]; beside.IsDefined() && beside.IsMap())
                        if (const auto depth = findCamera(beside, levels - 1);
                            depth && std::abs(depth->camera.fx - found->camera.fx) > 1)
                            found->notes.push_back(
                                "the calibration also has a depth camera of another focal length: depth is "
                                "taken as "
                                "registered to colour already (camera.txt can say otherwise)");
                return found;
            }
    return std::nullopt;
}

std::string readText(const std::string& file) {
    requireRegularInput(file);
    if (fs::file_size(file) > kLargestFile) throw std::runtime_error("it is larger than any calibration");
    std::ifstream in(file, std::ios::binary);
    if (!in) throw std::runtime_error("it cannot be read");
    std::string text{std::istreambuf_iterator<char>(in), {}};
    // OpenCV's "%YAML:1.0" is none of YAML's own words
    if (text.rfind("%YAML", 0) == 0) text.erase(0, std::min(text.find('\n'), text.size()));
    return text;
}

}  // namespace

bool mayBeCalibration(const std::string& file) {
    const std::string name = lowerName(fs::path(file).filename()),
                      ending = fs::path(name).extension().string();
    if (name == "metadata") return true;
    if (ending != ".yaml" && ending != ".yml" && ending != ".json") return false;
    return !hasOneOf(name, {"depth", "infra", "ir_", "_ir"}) || hasOneOf(name, {"color", "colour", "rgb"});
}

PinholeCamera asIfCentred(PinholeCamera camera) {
    const auto size = [](double centre) {  // not a number becomes the least one
        return static_cast<int>(std::ceil(std::max(32.0, std::min(2 * centre, 8192.0))));
    };
    if (camera.width == 0) {
        camera.width = size(camera.cx);
        camera.height = size(camera.cy);
    }
    return camera;
}

std::optional<CameraDescription> readCalibrationFile(const std::string& file) {
    const bool must_be = hasOneOf(lowerName(fs::path(file).filename()), {"camera", "intrinsic", "calib"});
    std::optional<CameraDescription> found;
    std::string fault;
    try {
        found = findCamera(YAML::Load(readText(file)), 2);
        if (found) {
            fault = asIfCentred(found->camera).check();
        }
    } catch (const YAML::Exception& error) {
        fault = error.msg;
        if (!error.mark.is_null()) fault += " in line " + std::to_string(error.mark.line + 1);
        if (!must_be) return std::nullopt;
    } catch (const std::runtime_error& error) {
        fault = error.what();
        if (!must_be) return std::nullopt;
    }
    if (!fault.empty())
        throw std::runtime_error(file + ": no camera can be read from it: " + excerpt(fault, 200));
    if (found) found->source = fs::path(file).filename().string();
    return found;
}

}  // namespace roevo
