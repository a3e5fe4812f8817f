#include "roevo/options.h"

#include <sched.h>

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>

#include "input/edit_distance.h"
#include "input/excerpt.h"

namespace roevo {
namespace {

std::string numberToText(double value) {
    char buffer[64];  // shortest text that reads back as the same number
    const auto [end, error] = std::to_chars(buffer, buffer + sizeof buffer, value);
    return error == std::errc() ? std::string(buffer, end) : std::to_string(value);
}

template <class Number>
bool parseWhole(const std::string& text, Number& value) {
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    return error == std::errc() && end == text.data() + text.size();
}

std::string trimmed(const std::string& text) {
    const auto first = text.find_first_not_of(" \t\r");
    if (first == std::string::npos) return {};
    return text.substr(first, text.find_last_not_of(" \t\r") - first + 1);
}

/// How far a name is from meaning this option: typed wrong, cut short, without its section, or in another
/// section.
std::size_t distanceFrom(const OptionField& field, std::string name) {
    std::transform(name.begin(), name.end(), name.begin(),
                   [](unsigned char c) { return c == '-' ? '_' : static_cast<char>(std::tolower(c)); });
    const std::size_t dot = name.rfind('.');
    const bool has_section = dot != std::string::npos;
    const std::string section = has_section ? name.substr(0, dot) : "",
                      key = name.substr(has_section ? dot + 1 : 0);
    constexpr std::size_t kShortest = 3;  // of a beginning that stands for the whole
    const bool begun = key.size() >= kShortest && field.key.compare(0, key.size(), key) == 0;
    const std::size_t distance = editDistance(field.key, key);
    const std::size_t by_key = (begun ? std::min<std::size_t>(1, distance) : distance) +
                               (!has_section || section == field.section ? 0 : 1);
    return std::min(editDistance(field.name(), name), by_key);
}

/// "the closest is 'fine.chi2' (what it is)"; of several equally close ones the first three.
std::string closestText(const std::vector<OptionField>& fields, const std::string& name) {
    std::vector<const OptionField*> closest;
    std::size_t least = 0;
    for (const auto& field : fields) {
        const std::size_t distance = distanceFrom(field, name);
        if (closest.empty() || distance < least) closest.clear(), least = distance;
        if (distance == least && closest.size() < 3) closest.push_back(&field);
    }
    if (closest.size() == 1)
        return "the closest is '" + closest.front()->name() + "' (" + closest.front()->description + ")";
    std::string text = "the closest are";
    for (const OptionField* field : closest)
        text += (field == closest.front() ? " '" : ", '") + field->name() + "'";
    return text;
}

}  // namespace

const char* toString(Mode mode) {
    return mode == Mode::kCoarse ? "ct" : mode == Mode::kTracking ? "tr" : "ba";
}

int threadCount(int threads) {
    if (threads > 0) return threads;
    // Not std::thread::hardware_concurrency(): that counts what the process may not use, too
    cpu_set_t allowed;
    return sched_getaffinity(0, sizeof allowed, &allowed) == 0 ? std::max(1, CPU_COUNT(&allowed)) : 2;
}

std::string OptionField::toText() const {
    if (const auto* number = std::get_if<double*>(&value)) return numberToText(**number);
    if (const auto* whole = std::get_if<int*>(&value)) return std::to_string(**whole);
    if (const auto* flag = std::get_if<bool*>(&value)) return **flag ? "true" : "false";
    return toString(*std::get<Mode*>(value));
}

std::string OptionField::fromText(const std::string& text) const {
    const std::string word = trimmed(text);
    // An option that is refused keeps the value that it had
    const auto parseInto = [&](auto* target, const char* kind) -> std::string {
        const auto before = *target;
        if (!parseWhole(word, *target)) {
            *target = before;
            return "option " + name() + ": '" + excerpt(word) + "' is not " + kind;
        }
        std::string fault = check();
        if (!fault.empty()) *target = before;
        return fault;
    };
    if (const auto* number = std::get_if<double*>(&value)) return parseInto(*number, "a number");
    if (const auto* whole = std::get_if<int*>(&value)) return parseInto(*whole, "a whole number");
    if (const auto* flag = std::get_if<bool*>(&value)) {
        if (word != "true" && word != "false" && word != "1" && word != "0") {
            return "option " + name() + ": '" + excerpt(word) + "' is neither true nor false";
        }
        **flag = word == "true" || word == "1";
        return {};
    }
    auto* mode = std::get<Mode*>(value);
    for (const Mode known : {Mode::kCoarse, Mode::kTracking, Mode::kBundleAdjustment}) {
        if (word != toString(known)) continue;
        *mode = known;
        return {};
    }
    return "option " + name() + ": '" + excerpt(word) + "' is not one of ct, tr, ba";
}

std::string OptionField::check() const {
    if (const auto* mode = std::get_if<Mode*>(&value)) {
        const int number = static_cast<int>(**mode);
        if (number >= 0 && number <= static_cast<int>(Mode::kBundleAdjustment)) return {};
        return "option " + name() + " = " + std::to_string(number) + " is none of ct, tr, ba";
    }
    const auto* real = std::get_if<double*>(&value);
    const auto* whole = std::get_if<int*>(&value);
    if (real == nullptr && whole == nullptr) return {};
    const double number = real != nullptr ? **real : **whole;
    if (std::isfinite(number) && number >= min && number <= max) return {};
    return "option " + name() + " = " + toText() + " is outside " + numberToText(min) + " to " +
           numberToText(max) + (unit.empty() ? "" : " " + unit);
}

std::vector<OptionField> optionFields(OdometryOptions& o) {
    auto& s = o.sensor;
    auto& e = o.edges;
    auto& c = o.coarse;
    auto& f = o.fine;
    auto& k = o.keyframe;
    auto& v = o.motion;
    auto& m = o.mapping;
    return {
        {"odometry", "mode", "", "ct: coarse tracking only; tr: coarse and fine; ba: with local mapping", 0,
         0, &o.mode},
        {"odometry", "threads", "threads",
         "1: all in the caller's thread; 0: as many as there are processors; results are the same", 0, 256,
         &o.threads},
        {"sensor", "depth_weight_k", "1/m", "k of the depth weight, Eq. (20)", 0, 10, &s.depth_weight_k},
        {"sensor", "min_depth", "m", "d_min of Eq. (20); nearer depths are not used", 0.01, 10, &s.min_depth},
        {"sensor", "max_depth", "m", "d_max of Eq. (20)", 0.1, 100, &s.max_depth},
        {"sensor", "depth_limit", "m", "farther depths are not used", 0.1, 100, &s.depth_limit},
        {"sensor", "depth_noise", "1/m", "a in sigma_z^2 = s0^2 + (a z^2)^2", 1e-5, 0.1, &s.depth_noise},
        {"sensor", "depth_noise_floor", "m", "s0 of it: what does not grow with depth", 1e-5, 0.1,
         &s.depth_noise_floor},
        {"sensor", "depth_scale_sigma", "",
         "one sigma of a share by which all depths, and so all ways, may err; only told in covariances", 0,
         0.5, &s.depth_scale_sigma},
        {"sensor", "estimate_readout", "",
         "learn the read-out time of the rolling shutter; else it is readout_time", 0, 0,
         &s.estimate_readout},
        {"sensor", "readout_sigma", "s", "how far from 0 the learned read-out time may well be, one sigma",
         1e-4, 0.1, &s.readout_sigma},
        {"sensor", "readout_memory", "",
         "share of what was learned of the read-out time that is kept from frame to frame", 0.5, 1,
         &s.readout_memory},
        {"sensor", "readout_time", "s",
         "from the first to the last row of a rolling shutter (0: global shutter)", -0.1, 0.1,
         &s.readout_time},
        {"sensor", "blur_time", "s",
         "one sigma of when an edge was seen (exposure, stamps): edges that move across themselves count "
         "less",
         0, 0.1, &s.blur_time},
        {"sensor", "reference_row", "", "row whose time the stamp means, as a share of the height", 0, 1,
         &s.reference_row},
        {"edges", "blur_sigma", "px", "Gaussian blur before the Sobel filter (0: none)", 0, 5, &e.blur_sigma},
        {"edges", "canny_factor", "",
         "high threshold = factor x Otsu's, of the square roots of the gradient's magnitudes", 0.1, 10,
         &e.canny_factor},
        {"edges", "canny_low_ratio", "", "low threshold = ratio x high threshold", 0.1, 1,
         &e.canny_low_ratio},
        {"edges", "min_high_threshold", "Sobel units", "floor of the high threshold", 1, 1000,
         &e.min_high_threshold},
        {"edges", "angle_deg", "deg", "oriented BFS: largest angle between neighbouring gradients", 1, 90,
         &e.angle_deg},
        {"edges", "min_length", "px", "shortest organized edge", 3, 1000, &e.min_length},
        {"edges", "tangent_span", "points",
         "tangents run between the points this many places before and after", 1, 10, &e.tangent_span},
        {"edges", "depth_patch_radius", "px", "radius of the square in which foreground depth is looked for",
         1, 5, &e.depth_patch_radius},
        {"edges", "depth_jump", "", "relative depth step that separates foreground from background", 0.005,
         0.5, &e.depth_jump},
        {"edges", "two_sided_depth", "", "correct keyframe depths by the surfaces on both sides of each edge",
         0, 0, &e.two_sided_depth},
        {"coarse", "levels", "", "image pyramid levels", 1, 7, &c.levels},
        {"coarse", "max_points", "points", "sampled edge points", 50, 100000, &c.max_points},
        {"coarse", "min_points", "points", "fewer cannot carry a photometric pose", 6, 1000, &c.min_points},
        {"coarse", "max_iterations", "", "Gauss-Newton steps per level", 1, 100, &c.max_iterations},
        {"fine", "search_radius", "px", "radius of the first association", 1, 15, &f.search_radius},
        {"fine", "final_radius", "px", "radius of the last association", 1, 15, &f.final_radius},
        {"fine", "normal_angle_deg", "deg", "largest angle between associated edge normals", 0.5, 90,
         &f.normal_angle_deg},
        {"fine", "vote_ratio", "", "share of the shorter edge's points that must agree on a pair of edges", 0,
         1, &f.vote_ratio},
        {"fine", "min_votes", "points", "and at least this many", 1, 1000, &f.min_votes},
        {"fine", "max_points", "points", "keyframe edge points used", 100, 100000, &f.max_points},
        {"fine", "max_iterations", "", "Gauss-Newton steps", 1, 100, &f.max_iterations},
        {"fine", "chi2", "", "chi-square limit of a residual", 0.5, 100, &f.chi2},
        {"fine", "photometric_weight", "",
         "weight of the photometric residual, both normalised by their spread", 0, 100,
         &f.photometric_weight},
        {"fine", "depth_weight", "", "weight of the depth residual of associated points (0: as in the paper)",
         0, 100, &f.depth_weight},
        {"fine", "depth_chi2", "", "chi-square limit of a depth residual", 0.5, 100, &f.depth_chi2},
        {"fine", "min_inliers", "points", "with fewer inliers the frame is not tracked", 6, 10000,
         &f.min_inliers},
        {"fine", "min_matched_ratio", "",
         "share of the visible edges that must be associated in a tracked frame", 0, 1, &f.min_matched_ratio},
        {"keyframe", "min_overlap", "", "new keyframe below this share of associable edges", 0, 1,
         &k.min_overlap},
        {"keyframe", "max_rotation_deg", "deg", "new keyframe beyond this rotation", 0.1, 180,
         &k.max_rotation_deg},
        {"keyframe", "max_translation", "",
         "new keyframe beyond this translation relative to the median depth", 0.001, 10, &k.max_translation},
        {"motion", "acceleration", "m/s^2", "likely acceleration, one sigma", 0.01, 1e6, &v.acceleration},
        {"motion", "angular_acceleration_deg", "deg/s^2", "likely angular acceleration, one sigma", 1, 1e8,
         &v.angular_acceleration_deg},
        {"motion", "speed", "m/s", "likely speed where none is known, one sigma", 0.01, 1e6, &v.speed},
        {"motion", "angular_speed_deg", "deg/s", "likely turning speed where none is known, one sigma", 1,
         1e8, &v.angular_speed_deg},
        {"motion", "smooth", "", "smooth the final poses, by how steadily the camera moves", 0, 0, &v.smooth},
        {"mapping", "window", "keyframes", "newest keyframes that are refined together", 2, 100, &m.window},
        {"mapping", "max_points", "points", "edge points kept of a keyframe", 100, 100000, &m.max_points},
        {"mapping", "max_iterations", "", "steps of the bundle adjustment per keyframe", 1, 100,
         &m.max_iterations},
        {"mapping", "joint_refinement", "",
         "poses move together; else each is registered alone, as in the paper", 0, 0, &m.joint_refinement},
        {"mapping", "chi2", "", "chi-square limit of a point-to-tangent residual", 0.5, 100, &m.chi2},
        {"mapping", "depth_weight", "", "weight of the depth of an observation", 0, 100, &m.depth_weight},
        {"mapping", "depth_chi2", "", "chi-square limit of a depth", 0.5, 100, &m.depth_chi2},
        {"mapping", "prior_weight", "", "weight of the tracked motion between keyframes, against all points",
         0, 100, &m.prior_weight},
        {"mapping", "max_spread", "sigmas", "an edge whose observations differ by more is a pseudo-edge",
         0.01, 100, &m.max_spread},
        {"mapping", "min_seen", "", "share of the keyframes looking at an edge's place that must see it", 0,
         1, &m.min_seen},
        {"mapping", "min_looks", "keyframes",
         "fewer of them cannot judge; one that looks from the side counts less", 2, 100, &m.min_looks},
        {"mapping", "reuse_keyframes", "", "old keyframes that look at the same place take part again", 0, 0,
         &m.reuse_keyframes},
        {"mapping", "max_reused", "keyframes", "at most this many of them", 0, 100, &m.max_reused},
        {"mapping", "close_loops", "", "places that are recognised correct the whole path since", 0, 0,
         &m.close_loops},
        {"mapping", "final_rounds", "",
         "most rounds in which all keyframes are refined together at the end of a recording (0: none)", 0,
         100, &m.final_rounds},
        {"mapping", "deterministic", "", "the tracker waits for the map; else it takes what is ready", 0, 0,
         &m.deterministic},
        {"mapping", "latency", "frames", "frames after which the mapping of a keyframe takes effect", 1, 100,
         &m.latency},
        {"mapping", "pseudo_weight", "",
         "weight, in tracking, of its keyframe's pseudo-edges (1: as all others)", 0.01, 1, &m.pseudo_weight},
        {"mapping", "semi_dense_points", "points",
         "surface points kept of a keyframe, next to its edges, in all modes (0: none)", 0, 50000,
         &m.semi_dense_points},
        {"loss", "max_predicted", "frames", "frames bridged by constant velocity before re-anchoring", 0,
         1000, &o.loss.max_predicted},
        {"loss", "recognise", "", "a lost camera is looked for at all keyframes", 0, 0, &o.loss.recognise},
    };
}

std::string setOption(OdometryOptions& options, const std::string& name, const std::string& text) {
    const auto fields = optionFields(options);
    for (const auto& field : fields)
        if (field.name() == name) return field.fromText(text);
    const std::string shown = excerpt(name);
    return "unknown option '" + shown + "'; " + closestText(fields, shown);
}

std::string checkOptions(const OdometryOptions& options) {
    OdometryOptions copy = options;
    for (const auto& field : optionFields(copy)) {
        if (auto fault = field.check(); !fault.empty()) return fault;
    }
    const auto fault = [](const char* name, double value, const char* must, double limit) {
        return std::string("option ") + name + " = " + numberToText(value) + " must " + must + " = " +
               numberToText(limit);
    };
    const SensorOptions& sensor = options.sensor;
    if (sensor.max_depth <= sensor.min_depth)
        return fault("sensor.max_depth", sensor.max_depth, "exceed sensor.min_depth", sensor.min_depth);
    if (sensor.depth_limit <= sensor.min_depth)
        return fault("sensor.depth_limit", sensor.depth_limit, "exceed sensor.min_depth", sensor.min_depth);
    if (options.fine.final_radius > options.fine.search_radius)
        return fault("fine.final_radius", options.fine.final_radius, "not exceed fine.search_radius",
                     options.fine.search_radius);
    return {};
}

}  // namespace roevo
