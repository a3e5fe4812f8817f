#include "recordings/camera_file.h"

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <map>
#include <sstream>
#include <stdexcept>
#include <utility>

#include "input/regular_file.h"
#include "programs/byte_order_mark.h"
#include "recordings/text_list.h"

namespace roevo {
namespace {

constexpr char kDistortion[] = "distortion_k1_k2_p1_p2_k3";

struct Value {
    std::string where;
    std::vector<std::string> words;
};

std::map<std::string, Value> readKeyValues(const std::string& file) {
    requireRegularInput(file);
    errno = 0;
    std::ifstream in(file);
    if (!in) throw std::runtime_error("cannot read " + file + ": " + std::strerror(errno ? errno : ENOENT));
    skipByteOrderMark(in);
    std::map<std::string, Value> values;
    std::string text;
    for (int number = 1; std::getline(in, text); number++) {
        text = text.substr(0, text.find('#'));
        const auto colon = text.find(':');
        if (colon == std::string::npos) continue;
        std::istringstream key_words(text.substr(0, colon)), value_words(text.substr(colon + 1));
        std::string key;
        key_words >> key;
        Value value;
        value.where = file + ":" + std::to_string(number);
        for (std::string word; value_words >> word;) value.words.push_back(word);
        values[key] = value;
    }
    return values;
}

std::vector<double> numbers(const Value& value, const std::string& key, std::size_t count) {
    if (value.words.size() != count)
        throw std::runtime_error(value.where + ": " + key + " needs " + std::to_string(count) +
                                 " number(s), found " + std::to_string(value.words.size()));
    std::vector<double> result;
    for (const std::string& word : value.words) result.push_back(parseNumber(word, value.where));
    return result;
}

}  // namespace

CameraDescription readCameraFile(const std::string& file) {
    const auto values = readKeyValues(file);
    std::string missing;
    const auto number = [&](const char* key) {
        const auto found = values.find(key);
        if (found != values.end()) return numbers(found->second, key, 1)[0];
        missing += std::string(missing.empty() ? "" : ", ") + key;
        return 0.0;
    };
    CameraDescription out;
    PinholeCamera& camera = out.camera;
    camera.width = static_cast<int>(number("width"));
    camera.height = static_cast<int>(number("height"));
    camera.fx = number("fx");
    camera.fy = number("fy");
    camera.cx = number("cx");
    camera.cy = number("cy");
    out.depth_scale = number("depth_scale");
    if (!missing.empty()) throw std::runtime_error("no intrinsics: " + file + " lacks " + missing);

    if (const auto found = values.find(kDistortion); found != values.end()) {
        const auto terms = numbers(found->second, kDistortion, camera.distortion.size());
        std::copy(terms.begin(), terms.end(), camera.distortion.begin());
    }
    if (const std::string fault = camera.check(); !fault.empty())
        throw std::runtime_error(file + ": " + fault);
    if (const auto found = values.find("frame_rate"); found != values.end()) {
        out.frame_rate = number("frame_rate");
        if (!(*out.frame_rate > 0)) throw std::runtime_error(file + ": frame_rate must be above 0");
    }
    if (!(out.depth_scale > 0)) throw std::runtime_error(file + ": depth_scale must be above 0");
    out.source = "camera.txt";
    return out;
}

std::string cameraFileText(const PinholeCamera& camera, double depth_scale,
                           const std::vector<std::string>& notes, std::string (*number)(double)) {
    std::string text =
        "width: " + std::to_string(camera.width) + "\nheight: " + std::to_string(camera.height) + "\n";
    const std::pair<const char*, double> values[] = {
        {"fx", camera.fx}, {"fy", camera.fy}, {"cx", camera.cx}, {"cy", camera.cy}};
    for (const auto& [key, value] : values) text += std::string(key) + ": " + number(value) + "\n";
    text += std::string(kDistortion) + ":";
    for (const double term : camera.distortion) text += " " + number(term);
    text += "\ndepth_scale: " + number(depth_scale) + "   # PNG value / depth_scale = metres\n";
    for (const std::string& note : notes) text += note + "\n";
    return text;
}

void setCamera(const CameraDescription& camera, DatasetDescription& out) {
    out.camera = camera.camera;
    out.depth_scale = camera.depth_scale;
    out.camera_source = camera.source;
}

std::optional<CameraDescription> cameraFileIn(const std::string& folder) {
    const std::filesystem::path file = std::filesystem::path(folder) / "camera.txt";
    if (!std::filesystem::exists(file)) return std::nullopt;
    return readCameraFile(file.string());
}

std::optional<CameraDescription> tumCameraNamedIn(const std::string& text) {
    // From the TUM RGB-D benchmark's own calibration page; fr3 is published undistorted.
    struct Published {
        const char* name;
        PinholeCamera camera;
    };
    static const Published kPublished[] = {
        {"freiburg1", {640, 480, 517.3, 516.5, 318.6, 255.3, {0.2624, -0.9531, -0.0054, 0.0026, 1.1633}}},
        {"freiburg2", {640, 480, 520.9, 521.0, 325.1, 249.7, {0.2312, -0.7849, -0.0033, -0.0001, 0.9172}}},
        {"freiburg3", {640, 480, 535.4, 539.2, 320.1, 247.6, {}}},
    };
    for (const Published& published : kPublished) {
        if (text.find(published.name) == std::string::npos) continue;
        CameraDescription out;
        out.camera = published.camera;
        out.source = std::string("the published ") + published.name + " camera of the TUM benchmark";
        return out;
    }
    return std::nullopt;
}

}  // namespace roevo
