#include "recordings/camera_file.h"

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <map>
#include <sstream>
#include <stdexcept>
#include <utility>

#include "camera/lens_terms.h"
#include "input/edit_distance.h"
#include "input/excerpt.h"
#include "input/regular_file.h"
#include "programs/byte_order_mark.h"
#include "recordings/text_list.h"

namespace roevo {
namespace {

constexpr char kDepthPose[] = "depth_to_colour";

struct LensKey {
    const char* key;
    std::size_t terms;
    LensModel model;
};
constexpr LensKey kFiveTerms{"distortion_k1_k2_p1_p2_k3", 5, LensModel::kBrownConrady};
constexpr LensKey kEightTerms{"distortion_k1_k2_p1_p2_k3_k4_k5_k6", 8, LensModel::kBrownConrady};
constexpr LensKey kFisheyeTerms{"fisheye_k1_k2_k3_k4", 4, LensModel::kKannalaBrandt};

struct Value {
    std::string where;
    std::vector<std::string> words;
};

using Values = std::map<std::string, Value>;

std::vector<std::string> knownKeys() {
    std::vector<std::string> keys{"depth_scale", "frame_rate", kDepthPose};
    for (const char* prefix : {"", "depth_"})
        for (const char* key :
             {"width", "height", "fx", "fy", "cx", "cy", kFiveTerms.key, kEightTerms.key, kFisheyeTerms.key})
            keys.push_back(std::string(prefix) + key);
    return keys;
}

bool isKnown(const std::string& key) {
    const std::vector<std::string> known = knownKeys();
    return std::find(known.begin(), known.end(), key) != known.end();
}

Values readKeyValues(const std::string& file) {
    requireRegularInput(file);
    errno = 0;
    std::ifstream in(file);
    if (!in) throw std::runtime_error("cannot read " + file + ": " + std::strerror(errno ? errno : ENOENT));
    skipByteOrderMark(in);
    Values values;
    std::string text;
    for (int number = 1; std::getline(in, text); number++) {
        text = text.substr(0, text.find('#'));
        const std::string where = file + ":" + std::to_string(number);
        const auto colon = text.find(':');
        if (colon == std::string::npos) {
            if (text.find_first_not_of(" \t\r") == std::string::npos) continue;
            throw std::runtime_error(where + ": expected 'key: value', found '" + excerpt(text) + "'");
        }
        std::istringstream key_words(text.substr(0, colon)), value_words(text.substr(colon + 1));
        std::string key;
        key_words >> key;
        Value value;
        value.where = where;
        for (std::string word; value_words >> word;) value.words.push_back(word);
        if (const auto before = values.find(key); before != values.end() && isKnown(key))
            throw std::runtime_error(where + ": " + key + " stands here again, first in " +
                                     before->second.where);
        values[key] = value;
    }
    return values;
}

/// An unknown key that is nearly one of those that are absent; else "". Others are the user's own.
/// @param share  one in so many characters of a key may differ, and one of a short key
std::string misspelt(const Values& values, const std::vector<std::string>& absent, std::size_t share) {
    for (const auto& [key, value] : values) {
        if (isKnown(key)) continue;
        const auto distance = [&name = key](const std::string& other) { return editDistance(name, other); };
        const auto closest = std::min_element(
            absent.begin(), absent.end(),
            [&](const std::string& a, const std::string& b) { return distance(a) < distance(b); });
        if (closest != absent.end() &&
            distance(*closest) <= std::max<std::size_t>(1, closest->size() / share))
            return value.where + ": unknown key '" + excerpt(key) + "', the closest is '" + *closest + "'";
    }
    return {};
}

std::vector<double> numbers(const Value& value, const std::string& key, std::size_t count) {
    if (value.words.size() != count)
        throw std::runtime_error(value.where + ": " + key + " needs " + std::to_string(count) +
                                 " number(s), found " + std::to_string(value.words.size()));
    std::vector<double> result;
    for (const std::string& word : value.words) result.push_back(parseNumber(word, value.where));
    return result;
}

/// @param missing  of the keys that every camera has
void requireAll(const Values& values, const std::vector<std::string>& missing, const std::string& file) {
    if (!missing.empty()) {
        std::string text;
        for (const std::string& key : missing) text += (text.empty() ? " lacks " : ", ") + key;
        const std::string likely = misspelt(values, missing, 2);
        throw std::runtime_error(file + text + (likely.empty() ? "" : "; " + likely));
    }
    std::vector<std::string> absent;
    for (const std::string& key : knownKeys())
        if (values.count(key) == 0) absent.push_back(key);
    if (const std::string likely = misspelt(values, absent, 5); !likely.empty())
        throw std::runtime_error(likely);
}

/// @param prefix  of the keys: "" or "depth_"
void readLens(const Values& values, const std::string& prefix, PinholeCamera& camera) {
    std::string known;
    for (const LensKey& lens : {kFiveTerms, kEightTerms, kFisheyeTerms}) {
        const std::string key = prefix + lens.key;
        const auto found = values.find(key);
        if (found == values.end()) continue;
        if (!known.empty())
            throw std::runtime_error(found->second.where + ": " + key + " and " + known +
                                     ": one lens at a time");
        known = key;
        const auto terms = numbers(found->second, key, lens.terms);
        for (std::size_t i = 0; i < terms.size(); i++) lensTerm(camera, i) = terms[i];
        camera.lens = lens.model;
    }
}

/// The keys that begin with "depth_", which are there together or not at all.
void readDepthCamera(const Values& values, CameraDescription& out) {
    const char* const names[] = {"depth_width", "depth_height", "depth_fx",
                                 "depth_fy",    "depth_cx",     "depth_cy"};
    std::string missing, there;
    std::vector<double> read;
    for (const char* name : names) {
        const auto found = values.find(name);
        if (found == values.end()) {
            missing += std::string(missing.empty() ? "" : ", ") + name;
            continue;
        }
        there = found->second.where;
        read.push_back(numbers(found->second, name, 1)[0]);
    }
    const auto placed = values.find(kDepthPose);
    if (read.empty()) {
        if (placed == values.end()) return;
        throw std::runtime_error(placed->second.where + ": " + kDepthPose +
                                 " is there, but no depth camera (" + missing + ")");
    }
    if (!missing.empty()) throw std::runtime_error(there + ": the depth camera lacks " + missing);
    DepthRegistration registration;
    registration.depth_camera = {static_cast<int>(std::clamp(read[0], 0., 1e6)),
                                 static_cast<int>(std::clamp(read[1], 0., 1e6)),
                                 read[2],
                                 read[3],
                                 read[4],
                                 read[5],
                                 {}};
    readLens(values, "depth_", registration.depth_camera);
    if (const std::string fault = registration.depth_camera.check(); !fault.empty())
        throw std::runtime_error(there + ": depth " + fault);
    if (placed != values.end()) {
        const auto v = numbers(placed->second, kDepthPose, 7);
        const Eigen::Quaterniond rotation(v[6], v[3], v[4], v[5]);
        constexpr double kTolerance = 0.01;  // of a quaternion's length
        if (!(std::abs(rotation.norm() - 1) < kTolerance))
            throw std::runtime_error(placed->second.where + ": " + kDepthPose +
                                     " is 'x y z qx qy qz qw', and the quaternion's length is not 1");
        registration.T_colour_depth = Pose(rotation.normalized(), Eigen::Vector3d(v[0], v[1], v[2]));
    }
    out.registration = registration;
}

}  // namespace

CameraDescription readCameraFile(const std::string& file) {
    const auto values = readKeyValues(file);
    std::vector<std::string> missing;
    const auto number = [&](const char* key) {
        const auto found = values.find(key);
        if (found != values.end()) return numbers(found->second, key, 1)[0];
        missing.emplace_back(key);
        return 0.0;
    };
    CameraDescription out;
    PinholeCamera& camera = out.camera;
    camera.width = static_cast<int>(std::clamp(number("width"), 0., 1e6));
    camera.height = static_cast<int>(std::clamp(number("height"), 0., 1e6));
    camera.fx = number("fx");
    camera.fy = number("fy");
    camera.cx = number("cx");
    camera.cy = number("cy");
    out.depth_scale = number("depth_scale");
    requireAll(values, missing, file);

    readLens(values, "", camera);
    if (const std::string fault = camera.check(); !fault.empty())
        throw std::runtime_error(file + ": " + fault);
    if (const auto found = values.find("frame_rate"); found != values.end()) {
        out.frame_rate = number("frame_rate");
        if (!(*out.frame_rate > 0)) throw std::runtime_error(file + ": frame_rate must be above 0");
    }
    if (!(out.depth_scale > 0)) throw std::runtime_error(file + ": depth_scale must be above 0");
    readDepthCamera(values, out);
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
    const LensKey& lens = camera.lens == LensModel::kKannalaBrandt ? kFisheyeTerms
                          : camera.isRational()                    ? kEightTerms
                                                                   : kFiveTerms;
    text += std::string(lens.key) + ":";
    for (std::size_t i = 0; i < lens.terms; i++) text += " " + number(lensTerm(camera, i));
    text += "\ndepth_scale: " + number(depth_scale) + "   # PNG value / depth_scale = metres\n";
    for (const std::string& note : notes) text += note + "\n";
    return text;
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
