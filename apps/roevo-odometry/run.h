#pragma once
#include <cstddef>
#include <string>
#include <vector>

#include "recordings/input_choice.h"
#include "roevo/options.h"
#include "run_report.h"

namespace roevo {

/// What to run, from the command line.
struct RunSettings {
    std::vector<std::string> command;  ///< the program and its arguments, for the record
    std::string input, output_dir;
    std::string config;  ///< file of options; empty: none
    InputChoice choice;
    std::string map_in, map_out;                ///< files; empty: none
    bool localise_only = false;                 ///< the map stays as it is
    std::string covariances;                    ///< file for the poses' covariances; empty: none
    std::string simple_map, rawlog_with_poses;  ///< files for MRPT's programs; empty: none
    bool simple_map_images = false;             ///< with the keyframes' images
    OdometryOptions options;
    std::size_t first = 0, skip = 0;  ///< process at most `first` frames (0: all) after leaving out `skip`
    bool realtime = false;            ///< frames arrive by the clock; those that come too early are dropped
    bool quiet = false;
};

/// Runs the odometry over the input and writes every file of the contract into output_dir, all of them
/// together, at its end. @throws std::runtime_error in one line; when no frame could be tracked, after
/// frames.csv, config_used.ini and summary.json, which says so
RunReport runOdometry(const RunSettings& settings);

}  // namespace roevo
