// As MRPT's applications go: a configuration file and a rawlog in; the robot's path, a simple map and a 3-D
// scene out.
//   mrpt_rawlog CONFIG.ini [RAWLOG]          config_ini/mrpt_application.ini says what the configuration is
#include <mrpt/config/CConfigFile.h>
#include <mrpt/system/filesystem.h>
#include <roevo_mrpt/rawlog_reader.h>
#include <roevo_mrpt/roevo_odometry.h>

#include <cstdio>

namespace {

int run(const std::string& config_file, const std::string& rawlog) {
    if (!mrpt::system::fileExists(config_file)) throw std::runtime_error("there is no file " + config_file);
    const mrpt::config::CConfigFile config(config_file);
    const std::string section = "MappingApplication";
    // MRPT would tell of a value that is not there with its stack of calls
    const auto required = [&](const std::string& key) {
        const std::string value = config.read_string(section, key, "");
        if (value.empty()) throw std::runtime_error(config_file + ": no " + key + " in [" + section + "]");
        return value;
    };
    const std::string input = rawlog.empty() ? required("rawlog_file") : rawlog;
    const std::string out = required("logOutput_dir");
    const std::string label = config.read_string(section, "sensor_label", "");

    roevo::CRoevoOdometry odometry;
    odometry.options.loadFromConfigFile(config, "CRoevoOdometry");
    roevo::RawlogReader reader(input, label);
    while (const auto scan = reader.next()) odometry.processObservation(*scan);
    odometry.refineAll();

    if (!mrpt::system::createDirectory(out)) throw std::runtime_error("cannot make the folder " + out);
    odometry.saveCurrentMapToFile(out + "/map.simplemap");
    odometry.getScene()->saveToFile(out + "/map.3Dscene");
    const auto path = odometry.getTrajectory();
    path.saveToTextFile(out + "/path.txt");  // time x y z yaw pitch roll of the robot
    std::printf("%zu poses, %u keyframes in %s\n", path.size(), odometry.getCurrentlyBuiltMapSize(),
                out.c_str());
    return 0;
}

}  // namespace

int main(int count, char** arguments) try {
    if (count == 2 || count == 3) return run(arguments[1], count == 3 ? arguments[2] : "");
    std::fprintf(stderr, "usage: mrpt_rawlog CONFIG.ini [RAWLOG]\n");
    return 2;
} catch (const std::exception& error) {
    std::fprintf(stderr, "mrpt_rawlog: error: %s\n", error.what());
    return 1;
}
