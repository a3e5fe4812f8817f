#pragma once
#include <optional>
#include <string>
#include <vector>

#include "roevo/types.h"

namespace roevo {

/// How files hold trajectories, a pose per line; `#` starts a comment. A first line may name the columns, as
/// a comment or not; where its names tell whether qw is first or last of the quaternion, they count.
enum class TrajectoryFormat {
    kTum,    ///< `timestamp tx ty tz qx qy qz qw`, s and m
    kKitti,  ///< twelve numbers, the rows of the 3 x 4 matrix [R t], m; no times
    kEuroc   ///< `timestamp,x,y,z,qw,qx,qy,qz` and maybe more, ns (a whole number) and m
};

/// "tum", "kitti", "euroc".
const std::vector<std::string>& trajectoryFormatNames();
std::optional<TrajectoryFormat> trajectoryFormat(const std::string& name);

/// Times for the rows of files that have none.
struct RowTimes {
    std::vector<double> stamps;  ///< s, in the order of the rows; empty when the source has none, either
    std::string source;          ///< where they are from, for messages
};

/// Of `count` ascending stamps that can only be ms, us or ns of this century: 1e3, 1e6 or 1e9; else 1.
double unitOfThisCentury(double first, double last, std::size_t count);

/// Reads a trajectory, sorted by time on return; of poses with one stamp the last counts.
/// @param format  none: as its head and its first row look. @param times  for KITTI. Stamps that can only be
/// ms, us or ns of this century become s.
/// @throws std::runtime_error with file and line: not the numbers that the format has, a value that is not
/// finite, a quaternion whose length is not one, a matrix that is no rotation, another number of rows than
/// times; a file with no pose at all; or rows of which nothing tells where qw is
std::vector<StampedPose> readTrajectory(const std::string& path, std::optional<TrajectoryFormat> format = {},
                                        const RowTimes& times = {});

/// The same, nothing but TUM's format, with the stamps that the file has.
std::vector<StampedPose> readTumTrajectory(const std::string& path);

/// Times of a file's rows, in their order: a trajectory's (none: KITTI), or a list whose lines begin with
/// seconds, as KITTI's times.txt. @throws as readTrajectory()
RowTimes readRowTimes(const std::string& path);

/// A trajectory as programs take it on their command line.
struct NamedFile {
    std::string name;  ///< may be empty
    std::string file;
};

/// "NAME=FILE", or a file alone, which may have a '=' in its own name if it is there.
/// @throws UsageError when there is no name before the '='
NamedFile splitNamedFile(const std::string& argument);

/// Writes a TUM trajectory, the stamp with 6 decimals and the pose with 9; the file appears when whole.
/// @throws std::runtime_error
void writeTumTrajectory(const std::string& path, const std::vector<StampedPose>& poses);

/// One line of such a file, without the end of line.
std::string toTumLine(const StampedPose& pose);

}  // namespace roevo
