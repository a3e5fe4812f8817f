#include "recordings/folder_choice.h"

#include <CLI/CLI.hpp>
#include <cmath>

#include "programs/program.h"
#include "programs/text.h"

namespace roevo {
namespace {

constexpr char kAssociations[] = "--associations", kIntrinsics[] = "--intrinsics",
               kDistortion[] = "--distortion", kFisheye[] = "--fisheye", kDepthScale[] = "--depth-scale",
               kFrameRate[] = "--frame-rate";

std::string joined(const std::vector<double>& values) {
    std::string text;
    for (const double value : values) text += (text.empty() ? "" : ",") + plainNumber(value);
    return text;
}

void requireFour(const char* option, const std::vector<double>& values, const char* names) {
    if (!values.empty() && values.size() != 4)
        throw UsageError(std::string(option) + ": 4 numbers (" + names + "), not " +
                         std::to_string(values.size()));
}

void requirePositive(const char* option, double value) {
    if (!(value >= 0 && std::isfinite(value)))  // 0: not said
        throw UsageError(std::string(option) + ": a number above 0, not " + plainNumber(value));
}

}  // namespace

std::vector<std::pair<std::string, std::string>> FolderChoice::options() const {
    std::vector<std::pair<std::string, std::string>> out;
    if (!associations.empty()) out.emplace_back(kAssociations, associations);
    if (!intrinsics.empty()) out.emplace_back(kIntrinsics, joined(intrinsics));
    if (!distortion.empty()) out.emplace_back(kDistortion, joined(distortion));
    if (!fisheye.empty()) out.emplace_back(kFisheye, joined(fisheye));
    if (depth_scale != 0) out.emplace_back(kDepthScale, plainNumber(depth_scale));
    if (frame_rate != 0) out.emplace_back(kFrameRate, plainNumber(frame_rate));
    return out;
}

void FolderChoice::check() const {
    requireFour(kIntrinsics, intrinsics, "fx fy cx cy");
    requireFour(kFisheye, fisheye, "k1 k2 k3 k4");
    requirePositive(kDepthScale, depth_scale);
    requirePositive(kFrameRate, frame_rate);
    const std::size_t terms = distortion.size();
    if (terms != 0 && terms != 4 && terms != 5 && terms != 8)
        throw UsageError(std::string(kDistortion) +
                         ": 4, 5 or 8 numbers (k1 k2 p1 p2 [k3 [k4 k5 k6]]), not " + std::to_string(terms));
    if (terms != 0 && !fisheye.empty())
        throw UsageError(std::string(kDistortion) + " and " + kFisheye + ": one lens at a time");
    if (intrinsics.empty() && (terms != 0 || !fisheye.empty()))
        throw UsageError(std::string(terms != 0 ? kDistortion : kFisheye) + " needs " + kIntrinsics);
    if (!intrinsics.empty() && !(depth_scale > 0))
        throw UsageError(std::string(kIntrinsics) + " needs " + kDepthScale +
                         " (units per metre; of images in mm 1000)");
}

void addFolderOptions(CLI::App& app, FolderChoice& choice) {
    app.add_option(kAssociations, choice.associations,
                   "Folders: file of pairs, 'time colour_image time depth_image' a line")
        ->type_name("FILE");
    app.add_option(kIntrinsics, choice.intrinsics,
                   "Folders: camera fx fy cx cy in pixels, instead of what the folder says")
        ->expected(4)
        ->delimiter(',');
    app.add_option(kDistortion, choice.distortion,
                   "With --intrinsics: lens k1 k2 p1 p2 [k3 [k4 k5 k6]] as OpenCV has it")
        ->expected(4, 8)
        ->option_text("FLOAT x 4, 5 or 8")
        ->delimiter(',');
    app.add_option(kFisheye, choice.fisheye, "With --intrinsics: fish-eye lens k1 k2 k3 k4 (Kannala-Brandt)")
        ->expected(4)
        ->delimiter(',');
    app.add_option(kDepthScale, choice.depth_scale, "Folders: units per metre of the depth images")
        ->check(CLI::Range(1e-3, 1e6));
    app.add_option(kFrameRate, choice.frame_rate, "Folders: images per second, where images are numbered")
        ->check(CLI::Range(0.01, 10000.0));
}

}  // namespace roevo
