#include "evaluation/trajectory_io.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <stdexcept>
#include <string_view>

#include "input/excerpt.h"
#include "input/regular_file.h"
#include "programs/atomic_file.h"
#include "programs/byte_order_mark.h"
#include "programs/program.h"

namespace roevo {
namespace {

constexpr std::size_t kNumColumns = 8;
constexpr double kQuaternionTolerance = 0.05;  // files with two decimals still pass
constexpr std::string_view kBlank = " \t\r\f\v";

[[noreturn]] void fail(const std::string& path, std::size_t line, const std::string& what) {
    throw std::runtime_error(path + ":" + std::to_string(line) + ": " + what);
}

// The line as eight numbers.
std::array<double, kNumColumns> parseLine(std::string_view text, const std::string& path, std::size_t line) {
    std::array<double, kNumColumns> values{};
    std::size_t count = 0;
    for (std::size_t begin = text.find_first_not_of(kBlank); begin != std::string_view::npos;) {
        const std::size_t end = std::min(text.find_first_of(kBlank, begin), text.size());
        const std::string_view word = text.substr(begin, end - begin);
        if (count < kNumColumns) {
            double& value = values[count];
            const auto [rest, error] = std::from_chars(word.data(), word.data() + word.size(), value);
            if (error != std::errc() || rest != word.data() + word.size())
                fail(path, line, "'" + excerpt(word) + "' is not a number");
            if (!std::isfinite(value)) fail(path, line, "'" + excerpt(word) + "' is not finite");
        }
        ++count;
        begin = text.find_first_not_of(kBlank, end);
    }
    if (count != kNumColumns)
        fail(path, line,
             "expected 8 numbers (timestamp tx ty tz qx qy qz qw), found " + std::to_string(count));
    return values;
}

StampedPose toPose(const std::array<double, kNumColumns>& v, const std::string& path, std::size_t line) {
    const Eigen::Quaterniond q(v[7], v[4], v[5], v[6]);
    if (std::abs(q.norm() - 1) > kQuaternionTolerance)
        fail(path, line, "the quaternion has length " + std::to_string(q.norm()) + " instead of 1");
    StampedPose pose;
    pose.timestamp = v[0];
    pose.T_world_camera.setRotation(q.normalized().toRotationMatrix());
    pose.T_world_camera.translation() = Eigen::Vector3d(v[1], v[2], v[3]);
    return pose;
}

bool byTime(const StampedPose& a, const StampedPose& b) {
    return a.timestamp < b.timestamp;
}
bool sameTime(const StampedPose& a, const StampedPose& b) {
    return a.timestamp == b.timestamp;
}

}  // namespace

std::vector<StampedPose> readTumTrajectory(const std::string& path) {
    requireRegularInput(path);
    errno = 0;
    std::ifstream in(path);
    if (!in) throw std::runtime_error("cannot read " + path + ": " + std::strerror(errno ? errno : ENOENT));

    skipByteOrderMark(in);
    std::vector<StampedPose> poses;
    std::string text;
    for (std::size_t line = 1; std::getline(in, text); ++line) {
        const std::string_view content = std::string_view(text).substr(0, text.find('#'));
        if (content.find_first_not_of(kBlank) == std::string_view::npos) continue;
        poses.push_back(toPose(parseLine(content, path, line), path, line));
    }
    if (poses.empty())
        throw std::runtime_error(path + ": no pose in it; expected lines 'timestamp tx ty tz qx qy qz qw'");

    std::stable_sort(poses.begin(), poses.end(), byTime);
    // Published ground truth does repeat stamps (TUM fr2/desk); as in the benchmark's own script the last one
    // counts.
    std::reverse(poses.begin(), poses.end());
    poses.erase(std::unique(poses.begin(), poses.end(), sameTime), poses.end());
    std::reverse(poses.begin(), poses.end());
    return poses;
}

std::string toTumLine(const StampedPose& pose) {
    const Eigen::Vector3d t = pose.T_world_camera.translation();
    Eigen::Quaterniond q(pose.T_world_camera.linear());
    if (q.w() < 0) q.coeffs() *= -1;  // q and -q are one rotation: write one of them always
    char line[320];
    std::snprintf(line, sizeof line, "%.6f %.9f %.9f %.9f %.9f %.9f %.9f %.9f", pose.timestamp, t.x(), t.y(),
                  t.z(), q.x(), q.y(), q.z(), q.w());
    return line;
}

NamedFile splitNamedFile(const std::string& argument) {
    const std::size_t equals = argument.find('=');
    std::error_code unseen;
    if (equals == std::string::npos || std::filesystem::exists(argument, unseen)) return {"", argument};
    if (equals == 0) throw UsageError("'" + argument + "' has no name before the '='");
    return {argument.substr(0, equals), argument.substr(equals + 1)};
}

void writeTumTrajectory(const std::string& path, const std::vector<StampedPose>& poses) {
    AtomicFile file(path);
    std::ostream& out = file.stream();
    out << "# timestamp tx ty tz qx qy qz qw\n";
    for (const StampedPose& pose : poses) out << toTumLine(pose) << '\n';
    file.commit();
}

}  // namespace roevo
