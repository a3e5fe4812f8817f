#include "recordings/sensor_files.h"

#include <algorithm>
#include <filesystem>
#include <stdexcept>

#include "evaluation/trajectory_io.h"
#include "programs/text.h"
#include "recordings/text_list.h"
#include "tracking/robust.h"

namespace fs = std::filesystem;

namespace roevo {
namespace {

struct Columns {
    std::vector<std::vector<double>> rows;  ///< ascending and unique in their first number, the stamp
    std::string fault;                      ///< first line that was left out, or why there is nothing
    std::size_t left_out = 0;
};

/// Lines of `count` numbers.
Columns readColumns(const std::string& file, std::size_t count) {
    Columns out;
    std::vector<TextLine> lines;
    try {
        lines = readTextLines(file);
    } catch (const std::runtime_error& error) {
        out.fault = error.what();
        return out;
    }
    for (const TextLine& line : lines) {
        const std::string where = file + ":" + std::to_string(line.number);
        try {
            if (line.words.size() != count)
                throw std::runtime_error(where + ": expected " + std::to_string(count) + " numbers, found " +
                                         std::to_string(line.words.size()));
            std::vector<double> row;
            for (const std::string& word : line.words) row.push_back(parseNumber(word, where));
            out.rows.push_back(std::move(row));
        } catch (const std::runtime_error& error) {
            if (out.left_out++ == 0) out.fault = error.what();
        }
    }
    std::stable_sort(out.rows.begin(), out.rows.end(),
                     [](const auto& a, const auto& b) { return a[0] < b[0]; });
    const auto last = std::unique(out.rows.begin(), out.rows.end(),
                                  [](const auto& a, const auto& b) { return a[0] == b[0]; });
    out.rows.erase(last, out.rows.end());
    return out;
}

std::string describe(const std::string& file, const Columns& columns) {
    std::string text = counted(columns.rows.size(), "sample") + " of " + fs::path(file).filename().string();
    if (columns.left_out > 0)
        text += ", " + std::to_string(columns.left_out) + " line(s) left out, first: " + columns.fault;
    else if (!columns.fault.empty())
        text = columns.fault;
    return text;
}

Eigen::Vector3d vectorAt(const std::vector<double>& row, std::size_t column) {
    return {row[column], row[column + 1], row[column + 2]};
}

double medianNorm(const std::vector<std::vector<double>>& rows, std::size_t column) {
    if (rows.empty()) return 0;
    std::vector<double> norms;
    for (const auto& row : rows) norms.push_back(vectorAt(row, column).norm());
    return medianOf(norms);
}

}  // namespace

std::string GroundTruth::toText() const {
    if (file.empty()) return {};
    return "ground truth: " + counted(poses.size(), "pose") + " from " + file +
           (note.empty() ? "" : ", " + note);
}

GroundTruth readGroundTruth(const std::string& file) {
    GroundTruth truth;
    if (!fs::exists(file)) return truth;
    truth.file = file;
    try {
        truth.poses = readTumTrajectory(file);
        truth.copyable = true;
    } catch (const std::runtime_error& error) {
        truth.note = std::string("not usable: ") + error.what();
    }
    return truth;
}

GroundTruth readNamedGroundTruth(const std::string& file) {
    return {readTrajectory(file), file, {}, false};
}

void readAccelerometer(const std::string& file, DatasetDescription& out) {
    if (!fs::exists(file)) return;
    const Columns columns = readColumns(file, 4);
    for (const auto& row : columns.rows) out.imu.push_back({row[0], vectorAt(row, 1), std::nullopt});
    out.imu_source = describe(file, columns);
}

void readImu(const std::string& file, DatasetDescription& out) {
    if (!fs::exists(file)) return;
    const Columns columns = readColumns(file, 7);
    // A hand-held sensor feels gravity, and does not turn at 9.8 rad/s most of the time
    const bool acceleration_first = medianNorm(columns.rows, 1) > medianNorm(columns.rows, 4);
    for (const auto& row : columns.rows) {
        const Eigen::Vector3d first = vectorAt(row, 1), second = vectorAt(row, 4);
        out.imu.push_back(acceleration_first ? ImuSample{row[0], first, second}
                                             : ImuSample{row[0], second, first});
    }
    out.imu_source = describe(file, columns);
    if (!columns.rows.empty())
        out.imu_source += acceleration_first ? " (acceleration, then angular velocity, told by gravity)"
                                             : " (angular velocity, then acceleration, told by gravity)";
}

}  // namespace roevo
