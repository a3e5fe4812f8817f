#pragma once
/// For tests of roevo-render's 3-D view: reads a page again, with nothing of the code that wrote it.

#include <gtest/gtest.h>

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <cstring>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "support/run_program.h"

namespace roevo::test {

/// RFC 4648.
inline std::string decodeBase64(const std::string& text) {
    static const std::string digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string bytes;
    unsigned group = 0, bits = 0;
    for (const char c : text) {
        if (c == '=') break;
        group = group << 6 | static_cast<unsigned>(digits.find(c));
        if ((bits += 6) >= 8) bytes += static_cast<char>(group >> (bits -= 8) & 0xff);
    }
    return bytes;
}

template <class Value>
std::vector<Value> numbersOf(const nlohmann::json& base64) {
    const std::string bytes = decodeBase64(base64.get<std::string>());
    std::vector<Value> values(bytes.size() / sizeof(Value));
    if (!values.empty()) std::memcpy(values.data(), bytes.data(), values.size() * sizeof(Value));
    return values;
}

/// The data that a page holds.
inline nlohmann::json dataOf(const std::string& html) {
    const std::string begin = "<script type=\"application/json\" id=\"data\">";
    const std::size_t at = html.find(begin), end = html.find("</script>", at);
    if (at == std::string::npos || end == std::string::npos) return {};
    return nlohmann::json::parse(html.substr(at + begin.size(), end - at - begin.size()), nullptr, false);
}

struct PagePoint {
    Eigen::Vector3d position;
    std::array<int, 4> colour;
    double step = 0;  ///< of its block
};

inline std::vector<PagePoint> pointsOf(const nlohmann::json& layer) {
    const auto boxes = numbersOf<float>(layer["boxes"]);
    const auto steps = numbersOf<std::uint16_t>(layer["positions"]);
    const auto colours = numbersOf<std::uint8_t>(layer["colours"]);
    const auto count = layer["count"].get<std::size_t>(), block = layer["block"].get<std::size_t>();
    EXPECT_EQ(steps.size(), 3 * count);
    EXPECT_EQ(colours.size(), 4 * count);
    EXPECT_EQ(boxes.size(), (count + block - 1) / block * 4);
    std::vector<PagePoint> points(count);
    for (std::size_t i = 0; i < count; ++i) {
        const float* box = &boxes[i / block * 4];
        for (std::size_t axis = 0; axis < 3; ++axis)
            points[i].position[static_cast<int>(axis)] = box[axis] + double(steps[3 * i + axis]) * box[3];
        for (std::size_t c = 0; c < 4; ++c) points[i].colour[c] = colours[4 * i + c];
        points[i].step = box[3];
    }
    return points;
}

inline const nlohmann::json& layerOf(const nlohmann::json& data, const std::string& id) {
    for (const auto& layer : data["layers"])
        if (layer["id"] == id) return layer;
    throw std::runtime_error("no layer " + id);
}

/// Positions of a list of poses: 3 numbers each.
inline std::vector<Eigen::Vector3d> positionsOf(const nlohmann::json& poses) {
    const auto numbers = numbersOf<float>(poses["positions"]);
    std::vector<Eigen::Vector3d> positions;
    for (std::size_t i = 0; i + 2 < numbers.size(); i += 3)
        positions.emplace_back(numbers[i], numbers[i + 1], numbers[i + 2]);
    return positions;
}

}  // namespace roevo::test
