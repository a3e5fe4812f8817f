#include <algorithm>
#include <cctype>
#include <cerrno>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <iterator>
#include <stdexcept>
#include <string_view>

#include "evaluation/trajectory_io.h"
#include "input/excerpt.h"
#include "input/regular_file.h"
#include "programs/byte_order_mark.h"

namespace roevo {
namespace {

constexpr std::size_t kTumColumns = 8, kKittiColumns = 12, kEurocColumns = 8;
constexpr double kRotationTolerance = 0.05;  // files with two decimals still pass
constexpr std::string_view kBlank = " \t\r\f\v";
constexpr std::int64_t kNanoseconds = 1'000'000'000;  // of a second

constexpr struct {
    TrajectoryFormat format;
    const char *name, *row;
} kFormats[] = {{TrajectoryFormat::kTum, "tum", "8 numbers (timestamp tx ty tz qx qy qz qw)"},
                {TrajectoryFormat::kKitti, "kitti", "12 numbers (KITTI: rows r r r t of a 3 x 4 matrix)"},
                {TrajectoryFormat::kEuroc, "euroc",
                 "8 or more numbers with commas between (EuRoC: nanoseconds,x,y,z,qw,qx,qy,qz)"}};

/// Which of a quaternion's numbers is the first.
enum class Order { kWFirst, kXFirst };

const char* rowOf(TrajectoryFormat format) {
    return kFormats[static_cast<std::size_t>(format)].row;
}

std::string_view trimmed(std::string_view word) {
    const std::size_t begin = word.find_first_not_of(kBlank);
    if (begin == std::string_view::npos) return {};
    return word.substr(begin, word.find_last_not_of(kBlank) - begin + 1);
}

using Words = std::vector<std::string_view>;

Words split(std::string_view content, bool commas) {
    Words words;
    if (commas) {
        for (std::size_t end; (end = content.find(',')) != std::string_view::npos;
             content.remove_prefix(end + 1))
            words.push_back(trimmed(content.substr(0, end)));
        words.push_back(trimmed(content));
        return words;
    }
    for (content = trimmed(content); !content.empty();) {
        words.push_back(content.substr(0, content.find_first_of(kBlank)));
        content = trimmed(content.substr(words.back().size()));
    }
    return words;
}

std::string_view withoutPlus(std::string_view word) {
    return word.substr(word.size() > 1 && word[0] == '+' && word[1] != '-' ? 1 : 0);
}

bool isNumber(std::string_view word) {
    word = withoutPlus(word);
    double value = 0;
    const auto [rest, error] = std::from_chars(word.data(), word.data() + word.size(), value);
    return error != std::errc::invalid_argument && rest == word.data() + word.size();
}

/// Whether they name the columns of a pose.
bool areNames(const Words& words) {
    return words.size() >= kTumColumns && std::none_of(words.begin(), words.end(), [](std::string_view word) {
               return word.empty() || isNumber(word);
           });
}

/// What names ("q_RS_w []", "pose.orientation.x") say by their last letters, without a unit behind them.
std::optional<Order> orderNamed(const Words& names) {
    std::string letters;
    for (std::size_t k = 1; k < kTumColumns; ++k) {
        const std::string_view name = names[k].substr(0, names[k].find_first_of("[("));
        const auto last =
            std::find_if(name.rbegin(), name.rend(), [](unsigned char c) { return std::isalpha(c) != 0; });
        letters += last == name.rend() ? '?' : static_cast<char>(std::tolower(*last));
    }
    if (letters == "xyzwxyz") return Order::kWFirst;
    if (letters == "xyzxyzw") return Order::kXFirst;
    return std::nullopt;
}

/// Rows of a text file without comments, blank lines and a first line of names, one after the other. Whether
/// there are commas between the words the first row tells; in EuRoC's format there are.
class Rows {
  public:
    explicit Rows(const std::string& path, std::optional<TrajectoryFormat> format = {}) : path_(path) {
        if (format == TrajectoryFormat::kEuroc) has_commas_ = true;
        requireRegularInput(path);
        errno = 0;
        in_.open(path);
        if (!in_)
            throw std::runtime_error("cannot read " + path + ": " + std::strerror(errno ? errno : ENOENT));
        skipByteOrderMark(in_);
    }
    bool next() {
        while (std::getline(in_, text_)) {
            ++line_;
            const std::size_t hash = text_.find('#');
            const std::string_view content = trimmed(std::string_view(text_).substr(0, hash));
            if (content.empty()) {
                if (columns_ == 0 && hash != std::string::npos)
                    takeNames(std::string_view(text_).substr(hash + 1));
                continue;
            }
            if (columns_ == 0 && !has_head_ && takeNames(content)) {
                has_head_ = true;
                continue;
            }
            if (!has_commas_) has_commas_ = content.find(',') != std::string_view::npos;
            words_ = split(content, *has_commas_);
            if (columns_ == 0) columns_ = words_.size();
            return true;
        }
        return false;
    }
    bool hasCommas() const { return *has_commas_; }
    const Words& words() const { return words_; }
    std::size_t columns() const { return columns_; }       // of the first row
    std::optional<Order> named() const { return named_; }  // by a head, or a comment like one

    template <class Number>
    Number number(std::size_t column, const char* what = "number") const {
        const std::string_view word = withoutPlus(words_[column]);
        Number value{};
        const auto [rest, error] = std::from_chars(word.data(), word.data() + word.size(), value);
        if (error != std::errc() || rest != word.data() + word.size())
            fail("'" + excerpt(word) + "' is not a " + what);
        if (!std::isfinite(static_cast<double>(value))) fail("'" + excerpt(word) + "' is not finite");
        return value;
    }
    [[noreturn]] void fail(const std::string& what) const {
        throw std::runtime_error(path_ + ":" + std::to_string(line_) + ": " + what);
    }
    [[noreturn]] void failAsRow(const std::string& expected) const {
        const std::string what = "number; expected " + expected;
        for (std::size_t k = 0; k < words_.size(); ++k)
            (void)number<double>(k, what.c_str());  // a word says more than a count
        fail("expected " + expected + ", found " + std::to_string(words_.size()));
    }

  private:
    bool takeNames(std::string_view content) {
        const Words names = split(content, content.find(',') != std::string_view::npos);
        if (!areNames(names)) return false;
        if (const auto order = orderNamed(names)) named_ = order;
        return true;
    }

    std::string path_, text_;
    std::ifstream in_;
    std::size_t line_ = 0, columns_ = 0;
    std::optional<bool> has_commas_;
    bool has_head_ = false;
    std::optional<Order> named_;
    Words words_;
};

std::optional<TrajectoryFormat> recognise(const Rows& rows) {
    const bool whole = rows.words().front().find('.') == std::string_view::npos;
    if (rows.hasCommas() && (!rows.named() || (rows.named() == Order::kWFirst && whole)))
        return TrajectoryFormat::kEuroc;
    if (rows.words().size() == kTumColumns) return TrajectoryFormat::kTum;
    if (rows.words().size() == kKittiColumns) return TrajectoryFormat::kKitti;
    return std::nullopt;
}

std::string anyRow() {
    std::string all;
    for (const auto& each : kFormats)
        all += (all.empty() ? "" : &each + 1 == std::end(kFormats) ? " or " : ", ") + std::string(each.row);
    return all;
}

constexpr char kNameThem[] =
    "name the columns in a first line: timestamp,tx,ty,tz,qx,qy,qz,qw (or qw,qx,qy,qz)";

double eurocStamp(const Rows& rows) {
    static const std::string what =
        std::string("time stamp in whole nanoseconds (EuRoC has commas); ") + kNameThem;
    const auto ns = rows.number<std::int64_t>(0, what.c_str());
    return static_cast<double>(ns / kNanoseconds) + 1e-9 * static_cast<double>(ns % kNanoseconds);
}

Pose quaternionPose(const Rows& rows, Order usual) {
    const bool w_first = rows.named().value_or(usual) == Order::kWFirst;
    const std::size_t w = w_first ? 4 : 7, x = w_first ? 5 : 4;
    const auto at = [&](std::size_t column) { return rows.number<double>(column); };
    const Eigen::Vector3d position(at(1), at(2), at(3));
    const Eigen::Quaterniond q(at(w), at(x), at(x + 1), at(x + 2));
    if (!(std::abs(q.norm() - 1) <= kRotationTolerance))
        rows.fail("the quaternion has length " + std::to_string(q.norm()) + " instead of 1");
    return {q, position};
}

Pose matrixPose(const Rows& rows) {
    Eigen::Matrix<double, 3, 4> T;
    for (Eigen::Index i = 0; i < T.size(); ++i)
        T(i / 4, i % 4) = rows.number<double>(static_cast<std::size_t>(i));
    const Eigen::Matrix3d R = T.leftCols<3>();
    if (!((R * R.transpose() - Eigen::Matrix3d::Identity()).cwiseAbs().maxCoeff() <= kRotationTolerance) ||
        R.determinant() < 0)
        rows.fail("the first three of each four numbers are no rotation matrix");
    return {Eigen::Quaterniond(R), T.col(3)};
}

StampedPose poseOf(const Rows& rows, TrajectoryFormat format) {
    const std::size_t count = rows.words().size();
    if (format == TrajectoryFormat::kEuroc) {
        if (count < kEurocColumns) rows.failAsRow(rowOf(format));
        if (count != rows.columns())
            rows.failAsRow(std::to_string(rows.columns()) + " numbers, as in the first row");
        return {eurocStamp(rows), quaternionPose(rows, Order::kWFirst)};
    }
    if (count != (format == TrajectoryFormat::kTum ? kTumColumns : kKittiColumns))
        rows.failAsRow(rowOf(format));
    if (format == TrajectoryFormat::kKitti) return {0, matrixPose(rows)};
    return {rows.number<double>(0), quaternionPose(rows, Order::kXFirst)};
}

// Rows of whole ns with commas are EuRoC's by custom. But trajectories often begin unturned, and hardly ever
// turned by half about z: then the custom is likely to be wrong, and what the file means cannot be told.
void refuseDoubt(const Rows& rows) {
    if (rows.named() || rows.columns() != kTumColumns || std::abs(rows.number<double>(7)) < 1 - 1e-6) return;
    rows.fail(std::string("qw,qx,qy,qz (EuRoC) or qx,qy,qz,qw (TUM)? ") + kNameThem);
}

// Gives the rows of a file that has no times those of another one.
void setTimes(std::vector<StampedPose>& poses, const RowTimes& times, const Rows& at_end,
              const std::string& path) {
    if (times.stamps.empty()) {
        const bool other = !times.source.empty() && times.source != path;
        throw std::runtime_error(
            path + ": a KITTI file has no times" + (other ? ", and neither has " + times.source : "") +
            "; give roevo-eval one for each of its rows by --times FILE, or write it with times: "
            "timestamp tx ty tz qx qy qz qw");
    }
    if (poses.size() != times.stamps.size())
        at_end.fail("the last of " + std::to_string(poses.size()) +
                    " rows, which have no times (KITTI); expected " + std::to_string(times.stamps.size()) +
                    ", one for each in " + times.source);
    for (std::size_t i = 0; i < poses.size(); ++i) poses[i].timestamp = times.stamps[i];
}

// Published ground truth does repeat stamps (TUM fr2/desk); as in the benchmark's own script the last one
// counts.
void sortByTime(std::vector<StampedPose>& poses) {
    std::stable_sort(poses.begin(), poses.end(),
                     [](const auto& a, const auto& b) { return a.timestamp < b.timestamp; });
    const auto last = std::unique(poses.rbegin(), poses.rend(),
                                  [](const auto& a, const auto& b) { return a.timestamp == b.timestamp; });
    poses.erase(poses.begin(), last.base());
}

// With the stamps that the file has.
std::vector<StampedPose> readAsWritten(const std::string& path, std::optional<TrajectoryFormat> format,
                                       const RowTimes& times) {
    Rows rows(path, format);
    std::vector<StampedPose> poses;
    const std::string expected = format ? rowOf(*format) : anyRow();
    while (rows.next()) {
        const bool guessed = !format;
        if (!format) format = recognise(rows);
        if (!format) rows.failAsRow(expected);
        poses.push_back(poseOf(rows, *format));
        if (guessed && format == TrajectoryFormat::kEuroc) refuseDoubt(rows);
    }
    if (poses.empty()) throw std::runtime_error(path + ": no pose in it; expected lines of " + expected);
    if (*format == TrajectoryFormat::kKitti) setTimes(poses, times, rows, path);
    const std::size_t rows_read = poses.size();
    sortByTime(poses);
    if (2 * poses.size() < rows_read)
        throw std::runtime_error(path + ": " + std::to_string(rows_read - poses.size()) + " of " +
                                 std::to_string(rows_read) +
                                 " rows repeat a time stamp: was it written with too few digits?");
    return poses;
}

}  // namespace

const std::vector<std::string>& trajectoryFormatNames() {
    static const std::vector<std::string> names = [] {
        std::vector<std::string> all;
        for (const auto& each : kFormats) all.emplace_back(each.name);
        return all;
    }();
    return names;
}

std::optional<TrajectoryFormat> trajectoryFormat(const std::string& name) {
    for (const auto& each : kFormats)
        if (each.name == name) return each.format;
    return std::nullopt;
}

double unitOfThisCentury(double first, double last, std::size_t count) {
    constexpr double kYear2000 = 9.5e8, kYear2100 = 4.1e9;  // s; times from some other zero tell no unit
    constexpr double kLongestStep = 10;                     // s
    const double step = count > 1 ? (last - first) / static_cast<double>(count - 1) : 0;
    for (const double unit : {1e3, 1e6, 1e9})
        if (last / unit > kYear2000 && last / unit < kYear2100 && step / unit < kLongestStep) return unit;
    return 1;
}

std::vector<StampedPose> readTrajectory(const std::string& path, std::optional<TrajectoryFormat> format,
                                        const RowTimes& times) {
    std::vector<StampedPose> poses = readAsWritten(path, format, times);
    const double unit = unitOfThisCentury(poses.front().timestamp, poses.back().timestamp, poses.size());
    for (StampedPose& pose : poses) pose.timestamp /= unit;
    return poses;
}

std::vector<StampedPose> readTumTrajectory(const std::string& path) {
    return readAsWritten(path, TrajectoryFormat::kTum, {});
}

RowTimes readRowTimes(const std::string& path) {
    Rows rows(path);
    RowTimes times{{}, path};
    while (rows.next()) {
        const auto format = recognise(rows);
        if (format == TrajectoryFormat::kKitti) return {{}, path};
        times.stamps.push_back(format == TrajectoryFormat::kEuroc ? eurocStamp(rows)
                                                                  : rows.number<double>(0));
    }
    if (times.stamps.empty()) throw std::runtime_error(path + ": no time in it; expected one per line");
    const double unit = unitOfThisCentury(times.stamps.front(), times.stamps.back(), times.stamps.size());
    for (double& stamp : times.stamps) stamp /= unit;
    return times;
}

}  // namespace roevo
