#include "recordings/lens.h"

#include <algorithm>
#include <cctype>
#include <stdexcept>

#include "camera/lens_terms.h"
#include "input/excerpt.h"

namespace roevo {
namespace {

/// Letters and digits only, small: "Kannala Brandt4" and "KANNALA_BRANDT4" are one name.
std::string plainName(const std::string& name) {
    std::string out;
    for (const unsigned char c : name)
        if (std::isalnum(c)) out += static_cast<char>(std::tolower(c));
    return out;
}

bool isOneOf(const std::string& name, std::initializer_list<const char*> names) {
    return std::any_of(names.begin(), names.end(), [&](const char* known) { return name == known; });
}

}  // namespace

void setLens(const std::string& model, const std::vector<double>& terms, PinholeCamera& camera) {
    std::string name = plainName(model);
    if (name.rfind("distortion", 0) == 0) name.erase(0, 10);  // pyrealsense2's "distortion.brown_conrady"
    const bool fisheye =
        isOneOf(name, {"equidistant", "fisheye", "kannalabrandt", "kannalabrandt4", "kannalabrandt8"});
    std::size_t used = terms.size();
    while (used > 0 && terms[used - 1] == 0) used--;
    if (terms.empty() || (used == 0 && !fisheye)) return;
    const bool brown = isOneOf(name, {"", "plumbbob", "rationalpolynomial", "brownconrady", "radtan",
                                      "radialtangential", "pinhole", "opencv"});
    if (!fisheye && !brown)
        throw std::runtime_error("lens model '" + excerpt(model) +
                                 "' is not supported, only plumb_bob, rational_polynomial and equidistant: "
                                 "undistort the images first");
    const std::size_t most = fisheye ? 4 : 8;
    if (used > most)
        throw std::runtime_error("lens model '" + excerpt(model) + "' with " + std::to_string(terms.size()) +
                                 " coefficients is not supported, only with up to " + std::to_string(most) +
                                 ": undistort the images first");
    camera.lens = fisheye ? LensModel::kKannalaBrandt : LensModel::kBrownConrady;
    for (std::size_t i = 0; i < used; i++) lensTerm(camera, i) = terms[i];
}

std::string lensText(const PinholeCamera& camera) {
    if (!camera.isDistorted()) return "no lens distortion";
    if (camera.lens == LensModel::kKannalaBrandt) return "fish-eye lens";
    return camera.isRational() ? "lens distortion of 8 terms" : "lens distortion";
}

}  // namespace roevo
